"""Pole placement in symbols: the Diophantine equation, degrees, the RST law."""
