"""The nbconvert exporters and their templates."""
