"""The room beside the first touch is the clearance divided by the squared distance, exact where both vanish."""

import mpmath
import numpy as np
import pytest

from loopbook.process.transfer_function import Process
from loopbook.tuning.migo_branch import circle, clearance, smooth_branch
from loopbook.tuning.second_touch import room_beside

M = 1.4
PROCESSES = [
    Process([1], [1, 3, 3, 1]),
    Process([2, 1], [1, 3, 3, 1], 0.4),
    Process([1], [5, 1], 2),
    Process([1], [1, 1, 0], 1),
]


@pytest.mark.parametrize("process", PROCESSES, ids=str)
@pytest.mark.parametrize("w", [0.3, 1.1])
def test_far_from_the_touch_it_is_the_clearance(process, w):
    x = w * np.array([0.2, 0.7, 1.4, 3.0, 20.0])
    _, R = circle(M)
    room = clearance(process, smooth_branch(process, np.array(w), M), x, M)
    assert room_beside(process, w, x, M) == pytest.approx(w**2 * ((room + R) ** 2 - R**2) / (x - w) ** 2, rel=1e-9)


@pytest.mark.parametrize("process", PROCESSES, ids=str)
@pytest.mark.parametrize("beside", [1e-12, 1e-6, -1e-3, 0.02])
def test_close_to_the_touch_no_digit_is_lost(process, beside):
    w, (C, _) = 0.8, circle(M)
    k, ki, kd = smooth_branch(process, np.array(w), M).tolist()
    x = w * (1 + beside)
    with mpmath.workdps(60):

        def loop(at):
            s = mpmath.mpc(0, at)
            g = mpmath.polyval([*process.num], s) / mpmath.polyval([*process.den], s) * mpmath.exp(-process.delay * s)
            return g * (k + ki / s + kd * s)

        slope = mpmath.diff(lambda at: abs(C + loop(at)) ** 2, w)  # zero but for the rounding of the gains
        change = abs(C + loop(mpmath.mpf(x))) ** 2 - abs(C + loop(mpmath.mpf(w))) ** 2 - slope * (mpmath.mpf(x) - w)
        expected = float(w**2 * change / (mpmath.mpf(x) - w) ** 2)
    assert room_beside(process, w, np.array([x]), M)[0] == pytest.approx(expected, rel=1e-9)
