"""What all tests share."""

from hypothesis import settings

# The same examples on every run, so that a failure repeats itself; no deadline, so that a slow machine is no failure.
settings.register_profile("loopbook", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("loopbook")
