"""Algebra: rational functions, equality, differences, delay polynomials, final values."""
