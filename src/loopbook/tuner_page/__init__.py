"""An interactive page on which the knobs of a loop are turned, with exact dead time, that needs nothing."""
