"""What a job of ours needs on every machine that does it."""

PACKAGES = ("derivations", "notebook_reports", "loopbook")
"""Whose sources results depend on, the one that is installed last; see `notebook_reports.executors`."""
NUMBERS = ("numpy", "scipy.signal", "sympy", "matplotlib.pyplot")
PRINTING = ("notebook_reports.export.exporters.pdf", "notebook_reports.export.exporters.html")
