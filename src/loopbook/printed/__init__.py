"""What is derived in symbols, printed once for all: NumPy and plain Python run it without SymPy.

`store` has the decorators, ``forms.json`` the texts, ``python -m loopbook.printed`` writes them anew. A text counts
only as long as the sources that it came from are what they were; otherwise it is derived again on the spot.
"""
