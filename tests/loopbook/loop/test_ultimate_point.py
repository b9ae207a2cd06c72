"""The ultimate point of any process: what a proportional regulator does there, by Mikhailov's criterion on a grid."""

import numpy as np
import pytest

from loopbook.loop.process_phase import NoSuchFrequency, frequency_at, phase
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.frequency_response import response
from loopbook.process.transfer_function import Process

pytestmark = pytest.mark.long


def mikhailov(process, K):
    """Roots on the right of d + K n exp(-L s) by the turning of its curve on a dense grid: n/2 - turning/pi."""
    unit = np.median([abs(r) for r in process.poles if r] or [1.0])
    w = np.geomspace(1e-6, 1e6, 1_500_001) * unit
    s = 1j * w
    curve = np.polyval(process.den, s) + K * np.polyval(process.num, s) * np.exp(-process.delay * s)
    curve = np.append(np.polyval(process.den, 0) + K * np.polyval(process.num, 0), curve)
    turned = np.unwrap(np.angle(curve))
    return round(process.order / 2 - (turned[-1] - turned[0]) / np.pi)


def assert_a_border(process):
    point = ultimate(process)
    Ku = 1 / point.K180
    sign = next(s for s in (1, -1) if abs(1 + s * Ku * process(1j * point.w180)) < 1e-9)
    counts = [mikhailov(process, sign * Ku * factor) for factor in (1 - 1e-3, 1 + 1e-3)]
    assert sorted(counts) == [0, 2]
    return Ku, point.w180


@pytest.mark.parametrize("unit", [1e-6, 1.0, 3e5])
def test_an_unstable_process_with_dead_time(unit):
    """1/(s - 1) exp(-0.2 s): K = sqrt(1 + w^2) with atan w = 0.2 w."""
    from scipy.optimize import brentq

    Ku, w = assert_a_border(Process([1], [unit, -1], 0.2 * unit))
    exact = brentq(lambda x: np.arctan(x) - 0.2 * x, 3, 10, xtol=1e-14)
    assert w * unit == pytest.approx(exact, rel=1e-12)
    assert Ku == pytest.approx(np.hypot(1, exact), rel=1e-12)
    assert round(Ku, 3) == 7.230


def test_a_phase_that_passes_upwards():
    """(s + 1)^2/(s^3 (0.01 s + 1)) starts at -270 degrees: only a large gain holds it."""
    process = Process([1, 2, 1], np.polymul([1, 0, 0, 0], [0.01, 1]))
    Ku, w = assert_a_border(process)
    assert (round(w, 5), round(Ku, 4)) == (1.01015, 0.5102)
    assert frequency_at(process, -np.pi) == pytest.approx(w, rel=1e-13)
    assert mikhailov(process, 2 * Ku) == 0 and mikhailov(process, 0.5 * Ku) == 2


@pytest.mark.parametrize(
    "process",
    [
        Process([1], [1, 0.5, -0.2], 0.3),  # one unstable pole and a lag
        Process([2, 1], [1, -0.4, 0.5], 0.1),  # an unstable pair
        Process([-3, 1], [1, 3, 3, 1]),  # a zero on the right
        Process([-4], [1, 6, 11, 6]),  # a negative gain
        Process([1], np.polymul([1, 1], [1, 0.02, 9]), 1.0),  # a resonance that decides, not the lowest -180 degrees
        Process([1, 0.4, 4], np.polymul([1, 1, 0], [1, 0.1, 9]), 0.05),
        Process([5, 5], [1, -1, 0], 0.05),
    ],
)
def test_the_proportional_loop_is_at_its_border(process):
    assert_a_border(process)


def test_a_resonance_decides_before_the_lowest_crossing():
    process = Process([1], np.polymul([1, 1], [1, 0.02, 9]), 1.0)
    lowest = frequency_at(process, -np.pi)
    Ku, _ = assert_a_border(process)
    assert Ku <= 1 / abs(process(1j * lowest)) * (1 + 1e-12)


def test_no_proportional_gain_holds_it():
    with pytest.raises(NoSuchFrequency, match="no proportional gain"):
        ultimate(Process([1], [1, -1, 1], 0.1))
    with pytest.raises(NoSuchFrequency, match="from -90 to -180 degrees and does not pass -180"):
        ultimate(Process([1], [1, 1, 0]))


@pytest.mark.seeds(10, 40)
def test_frequency_at_is_the_first_passage_on_a_dense_grid(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))
    roots = -np.exp(rng.uniform(-2, 2, n)) * rng.choice([1, -1], n, p=[0.85, 0.15])
    zeros = -np.exp(rng.uniform(-2, 2, int(rng.integers(0, n)))) * rng.choice([1, -1])
    delay = float(rng.choice([0.0, rng.uniform(0.05, 1)]))
    process = Process(np.atleast_1d(np.poly(zeros)), np.poly(roots), delay)
    w = np.geomspace(1e-5, 1e4, 400_001)
    turned = phase(process, w)
    step = np.diff(np.unwrap(np.angle(response(process, w)[0])))
    assert np.abs(np.diff(turned) - step).max() < 1e-6 + 1e-3 * delay
    angle = float(rng.uniform(-4, 0.5))
    passed = np.flatnonzero((turned[:-1] - angle) * (turned[1:] - angle) < 0)
    if passed.size:
        assert frequency_at(process, angle) == pytest.approx(w[passed[0]], rel=1e-4)
    elif abs(turned[-1] - angle) > 0.01:
        with pytest.raises(NoSuchFrequency):
            frequency_at(process, angle)
