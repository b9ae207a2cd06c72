"""Printed values, their verdicts, and the files that keep them."""
