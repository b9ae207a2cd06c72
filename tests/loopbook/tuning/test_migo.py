"""MIGO: the printed optimum, the defining properties on the whole batch, and an optimum found without the branch."""

import math

import numpy as np
import pytest

from loopbook.documents.pid_report.batch.processes import batch, four_lags
from loopbook.process.transfer_function import Process
from loopbook.tuning import migo
from loopbook.tuning.result import RuleDoesNotApply
from notebook_reports.ledger.verdicts import rounds_to

EXAMPLE = four_lags(0.1)
SAMPLE = batch()[::6]


def frequencies(process, settings):
    """A grid that the computation does not use."""
    w = settings.touches[0] * np.geomspace(1e-3, 1e3, 20011)
    more = np.arange(0.013, 200, 0.013) / process.delay if process.delay else []
    return np.union1d(np.union1d(w, more), [x for x in settings.touches if math.isfinite(x)])


def test_the_batch_holds_133_processes_in_nine_families():
    sizes = [sum(m.family == f for m in batch()) for f in range(1, 10)]
    assert sizes == [21, 21, 10, 6, 9, 9, 36, 11, 10]
    assert len({m.name for m in batch()}) == sum(sizes) == 133


def test_printed_optima():
    pi, pid = migo.pi(EXAMPLE), migo.pid(EXAMPLE)
    assert rounds_to(pi.K, "3.56") and rounds_to(pi.Ti, "0.660")
    assert rounds_to(pid.K, "56.9") and rounds_to(pid.Ti, "0.115") and rounds_to(pid.Td, "0.0605")


@pytest.mark.parametrize("member", SAMPLE, ids=lambda m: m.name)
@pytest.mark.parametrize("design", [migo.pi, migo.pid])
def test_the_curve_touches_the_circle_and_never_enters(design, member):
    settings = design(member.process)
    gains = settings.K, settings.ki, settings.kd
    room = migo.clearance(member.process, gains, frequencies(member.process, settings))
    assert room.min() > -1e-6
    for w in settings.touches:
        if math.isfinite(w):
            assert abs(migo.clearance(member.process, gains, np.array(w))) < 1e-7
    assert settings.stable


@pytest.mark.parametrize("member", SAMPLE[::3], ids=lambda m: m.name)
@pytest.mark.long
def test_no_neighbour_of_the_pi_optimum_is_better(member):
    """The largest feasible ki over a fan of gains K, found by bisection on a grid, is at the optimum."""
    best = migo.pi(member.process)
    w = frequencies(member.process, best)

    def largest(K):
        low, high = 0.0, 3 * best.ki
        for _ in range(50):
            middle = (low + high) / 2
            clear = migo.clearance(member.process, (K, middle, 0.0), w).min() >= -1e-9
            low, high = (middle, high) if clear else (low, middle)
        return low

    around = [largest(best.K * x) for x in (0.7, 0.9, 0.98, 1.02, 1.1, 1.3)]
    assert max(around) <= best.ki * (1 + 1e-6)
    assert largest(best.K) == pytest.approx(best.ki, rel=1e-5)


def test_pid_is_the_last_feasible_point_of_the_branch():
    best = migo.pid(EXAMPLE)
    w = frequencies(EXAMPLE, best)
    for factor, inside in ((0.999, False), (1.001, True)):
        gains = migo.smooth_branch(EXAMPLE, np.array(best.touches[0] * factor))
        assert (migo.clearance(EXAMPLE, gains, w).min() < -1e-7) == inside


def test_dead_time_bounds_the_derivative_of_a_first_order_process():
    """kd/T <= (M-1)/M for e^-s/(1+sT): the loop gain at high frequency must pass the circle at every phase."""
    settings = migo.pid(Process.fopdt(1, 0.1, 1))
    assert math.isinf(settings.touches[1])
    assert settings.kd / 0.1 == pytest.approx(0.4 / 1.4, rel=1e-9)


@pytest.mark.parametrize("stretch", [1e-3, 1e4])
def test_time_scale_does_not_matter(stretch):
    process = Process((1.0,), (1.0, 3.0, 3.0, 1.0), 0.5)
    den = [c * stretch ** (3 - i) for i, c in enumerate(process.den)]
    slow = Process((2.0,), tuple(den), 0.5 * stretch)
    for design in (migo.pi, migo.pid):
        one, two = design(process), design(slow)
        assert pytest.approx(one.K / 2, rel=1e-7) == two.K
        assert two.Ti == pytest.approx(one.Ti * stretch, rel=1e-7)
        assert two.Td == pytest.approx(one.Td * stretch, rel=1e-7, abs=1e-12)


def test_more_robustness_costs_integral_gain():
    gains = [migo.pi(EXAMPLE, M).ki for M in (1.2, 1.4, 1.7, 2.0)]
    assert gains == sorted(gains)


REFUSED = {
    "first order": (Process((1.0,), (1.0, 1.0)), "no finite optimum"),
    "negative gain": (Process((-1.0,), (1.0, 3.0, 3.0, 1.0)), "change the sign of u"),
    "unstable": (Process((1.0,), (1.0, 1.0, 1.0, -1.0)), "unstable by itself|not positive"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    process, words = REFUSED[case]
    with pytest.raises(RuleDoesNotApply, match=words):
        migo.pi(process)


def test_second_order_without_dead_time_has_no_pid_optimum():
    with pytest.raises(RuleDoesNotApply, match="without bound"):
        migo.pid(Process((1.0,), (1.0, 2.0, 1.0)))


def test_M_of_one_or_less_is_refused():
    with pytest.raises(ValueError, match="M must"):
        migo.pi(EXAMPLE, 1.0)


LAST = {
    "the loop gain tends to a constant": (
        [-0.8584758497724649, 11.085369234321844],
        [1, 0.16376192455, 0.00670196950],
        0,
    ),
    "a flat valley": (
        [6.995253152338087],
        [1, 58.11119336806214, 0.47957382321966013, 0.006585129969787825],
        0.02726084,
    ),
}


@pytest.mark.parametrize("k", [1.0, 7.3e5, 3.1e-8])
@pytest.mark.parametrize("num, den, delay", LAST.values(), ids=LAST)
def test_the_last_feasible_point_does_not_depend_on_the_unit_of_time(num, den, delay, k):
    process = Process(num, den, delay)
    scaled = [np.array(p) * k ** np.arange(len(p) - 1, -1, -1.0) for p in (num, den)]
    one, other = migo.pid(process), migo.pid(Process(*scaled, delay * k))
    assert [other.K, other.Ti / k, other.Td / k] == pytest.approx([one.K, one.Ti, one.Td], rel=1e-9)
    w = one.touches[0] * np.geomspace(1e-4, 1e5, 40_011)
    for factor, inside in ((1.0, False), (1.001, True)):
        gains = migo.smooth_branch(process, np.array(one.touches[0] * factor))
        assert (migo.clearance(process, gains, w).min() < -1e-9) == inside
