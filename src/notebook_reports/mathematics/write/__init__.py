"""Formulas as Typst, as MathML, as text."""
