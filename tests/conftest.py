"""What all tests share."""

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # many small matrices: threads cost more than they bring

import numpy as np  # noqa: E402
import pytest  # noqa: E402
from hypothesis import settings  # noqa: E402

# The same examples on every run, so that a failure repeats itself; no deadline, so that a slow machine is no failure.
settings.register_profile("loopbook", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("loopbook")


@pytest.fixture(scope="session")
def survey_holds():
    """A check of what the branch and bound says of intervals between edges against many points of each."""

    def check(curve, edges) -> None:
        share = np.linspace(0, 1, 101)[1:-1, None]
        for width in (1.0, 1e-2):
            a, b = edges[:-1], edges[:-1] + width * np.diff(edges)
            values, bound = curve.survey(a, b)
            seen = curve.distance(a + share * (b - a))
            assert (seen >= bound - 1e-9 * (1 + abs(bound))).all()
            assert values == pytest.approx(seen[49], rel=1e-9)

    return check
