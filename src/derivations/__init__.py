"""Where every equation comes from: SymPy only, exact numbers only."""
