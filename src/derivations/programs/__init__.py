"""Programs as data: what runs in a controller, statement by statement, built from the derived equations."""
