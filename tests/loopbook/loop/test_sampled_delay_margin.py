"""The delay margin of sampled loops: solved, whatever the sampling; checked by the loop's poles on both sides of it."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.rst import Rst
from loopbook.loop import sampled_delay_margin
from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.process.transfer_function import Process

pytestmark = pytest.mark.long

SERVO = Process([2], [1, 3, 2, 0])


def gain(K, h):
    return Rst((1,), (K,), (K,), h)


def delay_margin(process, regulator):
    loop = SampledLoop(process, regulator)
    return sampled_delay_margin.delay_margin(process, regulator, lambda more: loop.with_delay(more).is_stable)


def poles_outside(loop):
    return int((abs(loop.poles) > 1).sum())


@pytest.mark.parametrize("h", [1.0, 0.3, 0.05, 0.01])
@pytest.mark.parametrize("K", [0.3, 1.0])
def test_the_loop_turns_unstable_there_and_not_before(K, h):
    loop = SampledLoop(SERVO, gain(K, h))
    margin = loop.margins().delay
    assert SampledLoop(SERVO.delayed(margin * (1 - 1e-7)), loop.regulator).is_stable
    assert not SampledLoop(SERVO.delayed(margin * (1 + 1e-7)), loop.regulator).is_stable
    for share in np.linspace(0, 0.999, 12):
        assert poles_outside(loop.with_delay(share * margin)) == 0
    assert poles_outside(loop.with_delay(margin * 1.001)) == 2


def test_the_published_case():
    """A hundredth of a second: 0.76 s more makes it unstable, which is what the continuous loop says, less h/2."""
    loop = SampledLoop(SERVO, gain(1.0, 0.01))
    assert loop.margins().delay == pytest.approx(Loop(SERVO, 1.0).margins().delay - 0.005, rel=1e-4)
    assert not loop.with_delay(0.76).is_stable and loop.with_delay(0.75).is_stable


@pytest.mark.parametrize("h", [1e-2, 1e-3, 1e-4, 1e-5])
def test_fast_sampling_tends_to_the_continuous_margin(h):
    expected = Loop(SERVO, 0.5).margins().delay
    assert delay_margin(SERVO, gain(0.5, h)) == pytest.approx(expected - h / 2, rel=h)


def test_no_dead_time_harms_a_loop_whose_gain_stays_below_one():
    assert SampledLoop(Process([0.9], [1, 1], 0.3), gain(1.0, 0.5)).margins().delay == np.inf
    assert SampledLoop(Process([1.1], [1, 1], 0.3), gain(1.0, 0.5)).margins().delay < np.inf


@pytest.mark.parametrize("unit", [1e-6, 1.0, 3e5])
def test_any_unit_of_time(unit):
    process = Process([2], [unit**3, 3 * unit**2, 2 * unit, 0], 0.37 * unit)
    assert delay_margin(process, gain(0.6, 0.3 * unit)) / unit == pytest.approx(
        delay_margin(Process([2], [1, 3, 2, 0], 0.37), gain(0.6, 0.3)), rel=1e-10
    )


@pytest.mark.seeds(12, 60)
def test_random_loops_against_their_poles_on_a_fine_grid_of_dead_times(seed):
    """Unstable, oscillating, integrating processes, any fraction of dead time, regulators with a zero and a pole."""
    rng = np.random.default_rng(seed)
    while True:
        poles = -np.exp(rng.uniform(-2, 1, int(rng.integers(1, 4))))
        if rng.random() < 0.3:
            poles[0] = 0.0
        elif rng.random() < 0.2:
            poles[0] *= -0.2
        roots = [*poles]
        if rng.random() < 0.3:
            w, zeta = rng.uniform(0.3, 3), rng.uniform(0.02, 0.5)
            roots += [w * complex(-zeta, np.sqrt(1 - zeta**2)), w * complex(-zeta, -np.sqrt(1 - zeta**2))]
        process = Process(
            [np.exp(rng.uniform(-2, 1))], np.real(np.poly(roots)), float(rng.choice([0, rng.uniform(0, 2)]))
        )
        R = (1.0, -1.0) if rng.random() < 0.4 else (1.0, -float(rng.uniform(-0.9, 0.9)))
        S = np.exp(rng.uniform(-3, 1)) * np.array([1.0, -rng.uniform(-0.5, 1.0)])
        loop = SampledLoop(process, Rst(R, tuple(S), tuple(S), float(np.exp(rng.uniform(-1.5, 1)))))
        if abs(loop.poles).max() < 0.999:
            break
    margin, h = delay_margin(process, loop.regulator), loop.regulator.h
    grid = np.arange(0, min(margin, 25 * h), h / 23)
    inside = grid[grid < margin * (1 - 1e-6)]
    assert all(abs(loop.with_delay(float(d)).poles).max() < 1 for d in inside)
    if np.isfinite(margin) and margin < 200 * h:
        at = abs(loop.with_delay(margin).poles)
        assert abs(at - 1).min() < 1e-7 and at.max() < 1 + 1e-7
        after = loop.with_delay(margin + 1e-4 * h).poles
        assert abs(after).max() > 1 - 1e-9


def test_the_count_around_the_circle_is_that_of_the_roots():
    rng = np.random.default_rng(5)
    for _ in range(200):
        poles = -np.exp(rng.uniform(-2, 1, 2)) * [1, rng.choice([-0.3, 0, 1])]
        process = Process([np.exp(rng.uniform(-2, 2))], np.poly(poles), float(rng.choice([0, rng.uniform(0, 2)])))
        S = np.exp(rng.uniform(-2, 1)) * np.poly(rng.uniform(-0.5, 1.2, 2))
        loop = SampledLoop(process, Rst((1.0, -1.0), tuple(S), tuple(S), float(rng.uniform(0.1, 1))))
        if abs(abs(loop.poles) - 1).min() > 1e-6:
            assert loop.on_circle.roots_outside() == poles_outside(loop)


@pytest.mark.parametrize("h", [1e-1, 1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize(
    "process",
    [
        Process([1], np.poly([-1.0] * 4), 0.3),
        Process([1, 0.5], np.poly([-1.0, -2.0, -3.0, -0.2, -5.0]), 0.1),
        Process([1], np.poly([-1.0] * 6)),
    ],
    ids=["four lags", "five lags and a zero", "six lags"],
)
def test_all_margins_of_a_fast_sampled_pi_tend_to_the_continuous_ones(process, h):
    """Hundreds of samples per time constant put every root near z = 1; a thousand of them hold the dead time."""
    K, Ti = 0.4 / process.static_gain, 3.0
    limit = Loop(process, PidStandard(K, Ti)).margins()
    S = (K * (1 + h / Ti), -K)
    found = SampledLoop(process, Rst((1, -1), S, S, h)).margins()
    for mine, theirs in ((found.gain, limit.gain), (found.phase, limit.phase), (found.Ms.value, limit.Ms.value)):
        assert mine == pytest.approx(theirs, rel=1.2 * h)
    assert found.delay == pytest.approx(limit.delay, rel=h)


@pytest.mark.parametrize("seed", range(6))
def test_a_process_that_acts_at_once_jumps_with_the_whole_samples(seed):
    """The loop may turn unstable where a dead time of whole samples grows by nothing: no root passes the circle."""
    rng = np.random.default_rng(seed)
    order = int(rng.integers(0, 4))
    num, den = (np.poly(-np.exp(rng.uniform(-2, 2, order))) for _ in range(2))
    process = Process(
        np.atleast_1d(num) * np.exp(rng.uniform(-2, 1)), np.atleast_1d(den), float(rng.choice([0.0, 0.1, 0.37]))
    )
    g = float(np.exp(rng.uniform(-3, 0)))
    loop = SampledLoop(process, Rst((1, -1), (g,), (g,), 0.1) if seed % 2 else gain(g, 0.1))
    if not loop.is_stable:
        return
    margin = loop.margins().delay
    just_after = np.arange(16) * 0.1 - process.delay % 0.1 + 1e-7
    tried = np.concatenate([np.arange(0, 1.5, 0.05), just_after[just_after > 0]])
    unstable = [more for more in tried if not loop.with_delay(more).is_stable]
    if unstable:
        assert min(unstable) - 0.0501 < margin <= min(unstable) + 1e-9
    else:
        assert margin > tried.max() - 0.0501


def test_the_jump_by_value():
    """(s + 2)/(s + 1) with a dead time of one sample under an integrator: unstable just beyond six samples."""
    loop = SampledLoop(Process([1, 2], [1, 1], 0.05), Rst((1, -1), (0.2,), (0.2,), 0.05))
    assert loop.margins().delay == pytest.approx(0.25, abs=1e-12)
    assert loop.with_delay(0.25).is_stable and not loop.with_delay(0.25 + 1e-6).is_stable


@pytest.mark.parametrize("whole", range(1, 30, 4))
@pytest.mark.parametrize("past", [-1e-3, -1e-6, 1e-6, 1e-3])
def test_a_margin_just_past_a_whole_interval_is_found(whole, past):
    """Where the zero of a PI cancels the process's lag, all that is left is g/(z - 1); its margin is put beside l h."""
    w = np.pi / (2 * (whole + past) + 1)  # the crossover for which the phase allows so many intervals
    g, pole = 2 * np.sin(w / 2), np.exp(-0.1)
    K = g / (2 * (1 - pole))
    loop = SampledLoop(
        Process([2.0], [10.0, 1.0], 0.0), Rst(R=(1.0, -1.0), S=(K, -K * pole), T=(K * (1 - pole),), h=1.0)
    )
    margin = loop.margins().delay
    assert margin == pytest.approx(whole + past, abs=0.05)
    assert loop.with_delay(margin * (1 - 1e-7)).is_stable and not loop.with_delay(margin * (1 + 1e-7)).is_stable
