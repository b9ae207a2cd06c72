"""A report's model written as Typst or HTML."""
