"""Tuning rules: a file each."""
