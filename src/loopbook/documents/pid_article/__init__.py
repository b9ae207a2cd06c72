"""pid-article: the Polish web article on the PID regulator."""
