"""A regulator for one's own process: every rule that applies, side by side, judged by the same exact numbers."""
