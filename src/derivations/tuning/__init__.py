"""Tuning rules in symbols."""
