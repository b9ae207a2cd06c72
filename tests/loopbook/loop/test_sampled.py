"""Sampling, simulation step by step, and sampled loops against the continuous process between the samples."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loopbook.controllers.rst import Rst, with_zeros
from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.sensitivity_peaks import Circle
from loopbook.loop.transfer import LoopError
from loopbook.loop.unit_circle import CircleTransfer
from loopbook.pole_placement.numeric import place_numerically
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process, ProcessError
from loopbook.response.simulation import SimulationError, simulate

TANK = Process([1 / 8360], [35, 12, 1], 2)


class P:
    def __init__(self, gain):
        self.gain = gain

    def step(self, y, reference):
        return self.gain * (reference - y)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.floats(0.3, 10), min_size=1, max_size=3),
    st.lists(st.floats(-2, 2), min_size=1, max_size=2),
    st.floats(0, 4),
    st.floats(0.2, 2),
)
@pytest.mark.long
def test_any_dead_time_held_inputs_give_the_sum_of_step_responses(lags, num, delay, h):
    """Between the samples and at them, against superposed exact step responses."""
    den = [1.0]
    for lag in lags:
        den = np.polymul(den, [lag, 1])
    if len(num) > len(lags):
        num = num[:1]
    process = Process(num, den, delay)
    run = simulate(process, P(0.3), h, 12, reference=lambda t: np.cos(t), load=0.2)
    t = np.linspace(0, 12 * h, 97)
    changes = np.diff(run.u + run.load, prepend=0.0)
    expected = sum(c * process.step(t - at) for at, c in zip(run.t, changes, strict=True))
    assert np.abs(run.between(t) - expected).max() < 1e-11 * max(1, np.abs(expected).max())
    assert np.abs(run.between(run.t[:-1]) - run.y[:-1]).max() < 1e-12 * max(1, np.abs(run.y).max())


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 5), st.floats(0.2, 2))
def test_the_polynomials_are_the_recursion_of_the_states(delay, h):
    process = Process([2, 1], [1, 0.3, 0.5], delay)
    B, A = sample(process, h).polynomials
    run = simulate(process, P(0.1), h, 20, reference=1.0)
    y = np.zeros(21)
    for k in range(21):
        y[k] = sum(B[i] * run.u[k - i] for i in range(len(B)) if k >= i)
        y[k] -= sum(A[i] * y[k - i] for i in range(1, len(A)) if k >= i)
    assert np.abs(y - run.y).max() < 1e-11 * max(1, np.abs(y).max())


@pytest.mark.long
def test_python_control_samples_the_same_without_fraction():
    B, A = sample(TANK, 1.0).polynomials
    import control

    reference = control.sample_system(TANK.rational.to_control(), 1.0)
    assert list(A) == pytest.approx(list(reference.den[0][0]), rel=1e-12)
    assert B[3:5] == pytest.approx(reference.num[0][0], rel=1e-10)
    assert not B[:3].any()


def test_double_tank_prints_this_pulse_transfer_function():
    """double-tank, discretisation with one sample per second."""
    B, A = sample(TANK, 1.0).polynomials
    assert [float(f"{c:.4g}") for c in (*A, *B[3:])] == [1, -1.686, 0.7097, 1.526e-06, 1.361e-06]


def test_a_process_that_acts_at_once_but_late():
    process = Process([2, 1], [1, 0.1], 1.0)
    run = simulate(process, P(0.2), 1.0, 8, reference=1.0)
    t = np.linspace(0, 7.9, 80)
    changes = np.diff(run.u, prepend=0.0)
    expected = sum(c * process.step(t - at) for at, c in zip(run.t, changes, strict=True))
    assert np.abs(run.between(t) - expected).max() < 1e-12


def test_start_at_rest_with_an_input():
    run = simulate(Process([2], [5, 1], 1.3), P(0.0), 0.5, 60, u_before=3.0)
    assert run.y[0] == pytest.approx(6)
    assert run.y[2] == pytest.approx(6)
    assert run.y[-1] == pytest.approx(6 * np.exp(-(30 - 1.3) / 5))


def test_fast_sampling_tends_to_the_continuous_loop():
    """P control held over h acts like the continuous one with h/2 more dead time: the difference shrinks with h."""
    process = Process([1], [3, 1], 0.7)
    t = np.linspace(0, 10, 41)
    continuous = Loop(process, 1.5).step(horizon=11).y(t)
    errors = [
        np.abs(simulate(process, P(1.5), h, round(11 / h), reference=1.0).between(t) - continuous).max()
        for h in (0.1, 0.05, 0.025)
    ]
    assert errors[0] > 1.8 * errors[1] > 3.2 * errors[2]


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda: simulate(TANK, P(1), 1.0, 0), "steps"),
        (lambda: simulate(TANK, P(1), 1.0, 5, limits=(1, 1)), "limits"),
        (lambda: simulate(TANK, P(1), 1.0, 5, reference=[1, 2]), "reference has 2 values, the simulation 6"),
        (lambda: simulate(TANK, P(1), 1.0, 5, noise=np.nan), "noise is not finite"),
        (lambda: simulate(TANK, P(np.nan), 1.0, 5), "finite number is expected"),
        (lambda: simulate(TANK, P(np.nan), 1.0, 5), "at t = 0 s"),
        (lambda: simulate(Process([1, 1], [1, 2]), P(1), 1.0, 5), "algebraic loop"),
        (lambda: simulate(Process([1], [1, 0]), P(1), 1.0, 5, u_before=1.0), "no rest"),
        (lambda: sample(TANK, 0.0), "positive sampling interval"),
    ],
)
def test_simulation_errors(ask, says):
    with pytest.raises((SimulationError, ProcessError), match=says):
        ask()


def double_tank(q):
    B, A = sample(TANK, 1.0).polynomials
    return SampledLoop(TANK, place_numerically(B, A, with_zeros([q] * 3), 1.0).regulator)


@pytest.mark.parametrize("q", [0.3, 0.5, 0.7])
def test_margins_are_where_the_loop_gives_way(q):
    """The loop is stable just inside each limit and unstable just outside."""
    loop = double_tank(q)
    m = loop.margins()
    assert loop.with_gain(0.9999 * m.gain).is_stable
    assert not loop.with_gain(1.0001 * m.gain).is_stable
    assert loop.with_delay(0.999 * m.delay).is_stable
    assert not loop.with_delay(1.001 * m.delay).is_stable
    if m.gain_low:
        assert loop.with_gain(1.0001 * m.gain_low).is_stable
        assert not loop.with_gain(0.9999 * m.gain_low).is_stable


@pytest.mark.parametrize("q", [0.3, 0.5, 0.7])
def test_peaks_and_crossovers_against_a_grid(q):
    loop = double_tank(q)
    m, angle = loop.margins(), np.linspace(1e-4, np.pi, 400_001)
    value = loop.at(angle)
    assert m.Ms.value == pytest.approx((1 / abs(1 + value)).max(), rel=1e-8)
    assert m.Mt.value == pytest.approx((abs(value) / abs(1 + value)).max(), rel=1e-8)
    assert len(loop.gain_crossovers) == (np.diff(np.sign(abs(value) - 1)) != 0).sum()
    turns = (value.imag[:-1] * value.imag[1:] < 0) & (value.real[:-1] < 0) & (abs(value[1:]) < 1e3)
    assert len(loop.phase_crossovers[loop.phase_crossovers < 3.14]) == turns.sum()


def test_poles_of_the_design_and_errors():
    assert np.abs(double_tank(0.5).poles[abs(double_tank(0.5).poles) > 0.1] - 0.5).max() < 1e-4
    with pytest.raises(LoopError, match=r"unstable .a pole at"):
        double_tank(0.3).with_delay(1.0).margins()
    with pytest.raises(LoopError, match="one of reference, load, noise, output"):
        double_tank(0.3).step("sideways", 5)


def test_a_loop_of_first_order_by_hand():
    """y = 1/(z - 1) u, u = k (r - y): pole 1 - k, gain margin 2/k at the Nyquist frequency."""
    loop = SampledLoop(Process([1], [1, 0]), Rst((1,), (0.5,), (0.5,), 1.0))
    assert loop.poles == pytest.approx([0.5])
    assert loop.margins().gain == pytest.approx(4)
    assert loop.step("reference", 3).y == pytest.approx([0, 0.5, 0.75, 0.875])


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.floats(0, 2), st.floats(-np.pi, np.pi)), min_size=1, max_size=4),
    st.floats(0, 3.1),
    st.floats(1e-3, 1),
)
def test_distances_of_roots_to_an_arc(polar, start, share):
    """Nearest and farthest point, also of roots below the axis, against many points of the arc."""
    roots = np.array([r * np.exp(1j * angle) for r, angle in polar])
    a, b = np.array([start]), np.array([start + share * (np.pi - start)])
    points = np.exp(1j * np.linspace(a[0], b[0], 2001))
    seen = abs(points - roots[:, None])
    near, far = CircleTransfer(np.ones(1), np.ones(1), roots[:0], roots[:0]).distances(roots, a, b)
    assert (near[:, 0] <= seen.min(axis=1) + 1e-12).all() and near[:, 0] == pytest.approx(seen.min(axis=1), abs=2e-3)
    assert (far[:, 0] >= seen.max(axis=1) - 1e-12).all() and far[:, 0] == pytest.approx(seen.max(axis=1), abs=2e-3)


@pytest.mark.parametrize("q", [0.3, 0.7])
def test_what_a_survey_says_of_an_arc_holds_on_all_of_it(survey_holds, q):
    transfer = double_tank(q).on_circle
    for curve in (Circle(transfer), Circle(transfer.inverse())):
        survey_holds(curve, np.geomspace(1e-3, np.pi, 60))
