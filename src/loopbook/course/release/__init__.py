"""From a sheet and a roster to what each student and the teacher get."""
