"""Where a project keeps things; its notebooks, their parameters; files, failures, the console."""
