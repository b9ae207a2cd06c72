"""Figures that take more than a few lines; a notebook says what to draw, not how."""
