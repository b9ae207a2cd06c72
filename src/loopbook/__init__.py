"""Control design with exact dead time, and a ledger of what three documents print about it."""

__version__ = "0.1.0"
