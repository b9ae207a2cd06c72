"""Formulas written as text, read as mathematics; what is read is never run."""
