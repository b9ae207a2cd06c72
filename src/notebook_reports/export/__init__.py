"""Executed notebooks to reports: read, write, exporters."""
