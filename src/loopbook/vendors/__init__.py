"""What to type into a controller: a setting in the form of its PID block, with the manual that says so."""
