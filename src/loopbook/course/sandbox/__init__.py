"""A student's notebook run where it can do no harm: another user, no network, limits."""
