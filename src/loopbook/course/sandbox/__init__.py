"""A student's notebook run where it can do no harm: a process of its own, as another user, without network, with limits."""
