"""Pole placement: in numbers, exact, and for a sampled plant."""
