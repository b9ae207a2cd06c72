"""Programs that wait at the end of each pass: when they sample, and what the derivative makes of it."""

import pytest

from loopbook.controllers import PidSettings
from loopbook.documents.pid_report import waiting

ON_A_RAMP = PidSettings(K=2.0, Ti=5.0, Td=0.5, h=0.1)


@pytest.mark.parametrize(("spent", "stretched"), [(0.0, 1.0), (0.01, 1.1), (0.1, 2.0)])
def test_the_interval_is_the_wait_and_the_pass_and_the_slope_is_off_by_it(spent, stretched):
    found = waiting.run_passes(ON_A_RAMP, wait=0.1, spent=spent)
    assert found.interval == pytest.approx(0.1 * stretched)
    assert found.slope == pytest.approx(stretched)
