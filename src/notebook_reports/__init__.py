"""From notebooks to reports: run, check, export, remember. Knows nothing of control."""
