"""Running a notebook: kernels, the warm one they are forked from, a record that is canonical."""
