"""Cells and outputs of a notebook, read into a report's model."""
