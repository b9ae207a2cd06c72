"""A logged file: its cells, how it is read, the steps in it."""
