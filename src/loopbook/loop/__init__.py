"""Closed loops: continuous and sampled, with stability, margins and sensitivity peaks."""
