"""What all tests share."""

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # many small matrices: threads cost more than they bring

from hypothesis import settings  # noqa: E402

# The same examples on every run, so that a failure repeats itself; no deadline, so that a slow machine is no failure.
settings.register_profile("loopbook", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("loopbook")
