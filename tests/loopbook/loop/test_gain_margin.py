"""Gain margins without dead time, at any relative degree, by Routh's limits and by the roots at the margin itself."""

import mpmath
import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.regulator import Regulator
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process


def largest_real_part(loop):
    """Of the closed loop's roots, with 50 digits: the second route."""
    num, den = loop.transfer.num, loop.transfer.den
    total = [mpmath.mpf(c) for c in den]
    for i, c in enumerate(num):
        total[len(den) - len(num) + i] += mpmath.mpf(c)
    with mpmath.workdps(50):
        roots = mpmath.polyroots(total, maxsteps=500, extraprec=400)
    return max(float(mpmath.re(r)) for r in roots), max(float(abs(r)) for r in roots)


def assert_margin(loop):
    gain = loop.margins().gain
    for factor, side in ((1 - 1e-6, -1), (1 + 1e-6, 1)):
        real, _ = largest_real_part(loop.with_gain(gain * factor))
        assert np.sign(real) == side
    return gain


def test_a_zero_on_the_right_and_integral_action():
    """(1 - s)(10 s + 1)/(10 s (s + 1)^2): s^3 + (2 - K) s^2 + (1 + 0.9 K) s + 0.1 K; (2 - K)(1 + 0.9 K) = 0.1 K."""
    gain = assert_margin(Loop(Process([-1, 1], [1, 2, 1]), PidStandard(1, 10)))
    assert gain == pytest.approx(np.roots([-0.9, 0.7, 2]).max(), rel=1e-13)
    assert round(gain, 3) == 1.929


@pytest.mark.parametrize("T", [1e-6, 1.0, 4e5])
@pytest.mark.parametrize("Ti", [0.3, 3.0, 300.0, 1e5])
def test_relative_degree_one_at_every_time_scale(T, Ti):
    loop = Loop(Process([-T, 1], [T**2, 2 * T, 1]), PidStandard(1e-2, Ti * T))
    assert assert_margin(loop) == pytest.approx(1e2 * _by_routh(Ti), rel=1e-10)


def _by_routh(Ti):
    """s^3 + (2 - K) s^2 + (1 + K (1 - 1/Ti)) s + K/Ti: (2 - K)(1 + K (1 - 1/Ti)) = K/Ti, the first K > 0."""
    roots = np.roots([-(1 - 1 / Ti), 2 * (1 - 1 / Ti) - 1 - 1 / Ti, 2])
    return min(r for r in roots if r > 0)


@pytest.mark.parametrize("seed", range(25))
def test_random_rational_loops_are_at_the_border_at_their_margin(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 5))
    den = np.poly(-np.exp(rng.uniform(-3, 3, n)))
    num = np.atleast_1d(np.poly(np.exp(rng.uniform(-3, 3, int(rng.integers(0, n + 1)))) * rng.choice([-1, 1])))
    loop = Loop(Process(num / num[-1], den / den[-1]), Regulator.one_dof([1, 1], [1, 0]))
    while not loop.is_stable:
        loop = loop.with_gain(0.3)
    if np.isfinite(loop.margins().gain):
        assert_margin(loop)
    else:
        assert largest_real_part(loop.with_gain(1e9))[0] < 0


def test_a_negative_static_gain_does_not_hide_an_earlier_oscillation():
    """The gain at w = 0 bears a factor of 23, but the loop oscillates from 9.4 on."""
    num = [1.3418981200544977, -2.7402704252657197, -4.401805676649418, -0.23093813635743216]
    den = [1.0, 12.177311979957796, 44.46129535569, 70.07018684433704, 49.50997636583107, 12.8774168416, 1.66140519686]
    loop = Loop(Process(num, den, 1.3), 0.3)
    gain = loop.margins().gain
    assert gain < 10 and loop.with_gain(gain * (1 - 1e-7)).is_stable
    assert loop.with_gain(gain * (1 + 1e-7)).unstable_roots == 2
