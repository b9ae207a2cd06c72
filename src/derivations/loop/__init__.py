"""Closed loops in symbols: Routh, robustness."""
