"""The same loop in microseconds and in years: every answer is the same, counted in the loop's own time."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.stability import BorderError, unstable_roots
from loopbook.process.transfer_function import Process

TIMES = [5e-4, 1e-3, 1.0, 3500.0, 1e7, 1e9, 3.7e-9]


def triple_lag(T, delay=0.0):
    return Process([1], [T**3, 3 * T**2, 3 * T, 1], delay * T)


def turns_of_nyquist(loop, T):
    """Clockwise turns of 1 + G around the origin on a dense grid: the second route to the count, integrators dented."""
    w = np.geomspace(1e-7, 1e7, 400_001) / T
    angle = np.unwrap(np.angle(1 + loop.transfer(1j * w)))
    start = -np.pi / 2  # one integrator: 1 + G begins at -90 degrees, the detour around s = 0 adds a quarter turn
    return round(-(angle[-1] - start) / np.pi + 0.5)


@pytest.mark.parametrize("T", TIMES)
def test_three_lags_under_too_much_gain_are_unstable_in_any_unit(T):
    """(s + 1)^2 s + 9: Routh's array has 2 - 9 < 0, two roots on the right."""
    loop = Loop(triple_lag(T), PidStandard(9, T))
    assert not loop.is_stable
    assert loop.unstable_roots == 2 == turns_of_nyquist(loop, T)


@pytest.mark.parametrize("T", TIMES)
@pytest.mark.parametrize(("delay", "Ms"), [(0.0, 3.3671304184874), (0.3, 7.5234054085717)])
def test_three_lags_under_little_gain_are_stable_in_any_unit(T, delay, Ms):
    loop = Loop(triple_lag(T, delay), PidStandard(1, T))
    assert loop.is_stable and loop.unstable_roots == 0 == turns_of_nyquist(loop, T)
    margins = loop.margins()
    assert margins.Ms.value == pytest.approx(Ms, rel=1e-11)
    w = np.geomspace(0.1, 10, 200_001) / T
    assert margins.Ms.value == pytest.approx(abs(loop.sensitivity(1j * w)).max(), rel=1e-8)


def test_roots_far_apart_are_no_border():
    """A loop of nanoseconds with an integral action of months: Re of the slow root is 1e-16 of the fast one's."""
    loop = Loop(Process([1], [1e-9, 1]), PidStandard(0.5, 1e7))
    assert loop.is_stable
    slow = 0.5 / 1.5 / 1e7
    assert loop.decay_rate == pytest.approx(slow, rel=1e-6)


def test_coefficients_that_cancel_are_a_border_and_small_ones_are_not():
    assert not Loop(Process([1], [1, -1]), 1).is_stable
    with pytest.raises(BorderError, match="border"):
        unstable_roots(Loop(Process([3e-14], [1e-20, -3e-14]), 1).transfer)
    assert Loop(Process([1], [1e-20, 1e-9, 1]), 1e-3).is_stable


@pytest.mark.parametrize("n", [8, 20])
def test_many_equal_lags_are_counted_rightly(n):
    """(s + 1)^n + K: the roots are -1 + K^(1/n) exp(j pi (2 i + 1)/n), whatever a companion matrix makes of them."""
    den = np.poly([-1.0] * n)
    limit = 1 / np.cos(np.pi / n) ** n
    assert Loop(Process([1], den), 0.99 * limit).unstable_roots == 0
    assert Loop(Process([1], den), 1.01 * limit).unstable_roots == 2
    assert (
        Loop(Process([1], den), limit * 1.01 / np.cos(3 * np.pi / n) ** n * np.cos(np.pi / n) ** n).unstable_roots == 4
    )
