"""Closed-loop responses with exact dead time against formulas, a second method, and python-control."""

from math import factorial

import control
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.controllers.regulator import Regulator
from loopbook.loop.continuous import Loop
from loopbook.loop.transfer import LoopError
from loopbook.numerics.method_of_steps import ResponseError
from loopbook.numerics.signals import HorizonError
from loopbook.process.transfer_function import Process
from loopbook.response.closed_loop import loop_equation
from loopbook.response.step_metrics import NotSettled

pytestmark = pytest.mark.long

TANK = Process([1 / 8360], [35, 12, 1], 2)
TUNED = PidParallel(25194.1165104731, 1956.14979824376, 68803.105267141, 28.6213074510803)


def integrator_error(t, gain, delay):
    """1 - y of an integrator with dead time under P control, segment by segment: sum (-k)^j (t - jL)^j/j!."""
    return sum(
        (-gain) ** j * np.maximum(t - j * delay, 0) ** j / factorial(j) * (t >= j * delay)
        for j in range(int(t.max() / delay) + 2)
    )


@pytest.mark.parametrize("gain", [0.2, 1 / np.e, 0.9, 1.4])
def test_integrator_with_dead_time_segment_by_segment(gain):
    delay = 1.3
    t = np.linspace(0, 8 * delay, 161)
    response = Loop(Process.integrating(1, delay), gain / delay).step(horizon=8 * delay)
    assert np.abs(1 - response.y(t) - integrator_error(t, gain / delay, delay)).max() < 1e-13


def test_nothing_happens_before_the_dead_time():
    t = np.linspace(0, 2, 201)[:-1]
    response = Loop(TANK, TUNED).step(horizon=10)
    assert (response.y(t) == 0).all()
    assert response.y(2.001) > 0
    assert response.y(-3.0) == 0


def stacked(equation, segments):
    """The same loop by matrix exponentials of all segments stacked: (time) -> outputs."""
    n, size = len(equation.A), len(equation.A) * segments + 1
    M, rows = np.zeros((size, size)), [np.zeros(size)]
    for k in range(segments):
        part = slice(k * n, (k + 1) * n)
        M[part, part] = equation.A
        M[part] += np.outer(equation.b, rows[k])
        M[part, -1] += equation.e
        row = equation.D[0] * rows[k]
        row[part] += equation.C[0]
        row[-1] += equation.f[0]
        rows.append(row)
    X = np.zeros(size)
    X[-1] = 1
    over = expm(M * equation.delay)
    for k in range(segments - 1):
        X[(k + 1) * n : (k + 2) * n] = (over @ X)[k * n : (k + 1) * n]

    def outputs(t):
        k = int(t // equation.delay)
        state = expm(M * (t - k * equation.delay)) @ X
        return equation.C @ state[k * n : (k + 1) * n] + equation.D * (rows[k] @ state) + equation.f

    return outputs


@pytest.mark.parametrize("source", ["reference", "load", "noise"])
def test_stacked_matrix_exponentials_agree(source):
    """A second method without polynomials: one matrix exponential for all segments at once.

    That of SciPy is good to some 2e-13 of the largest value here, by forty digits of mpmath.
    """
    equation = loop_equation(TANK, TUNED.regulator(), source, None)
    second = stacked(equation, 10)
    response = Loop(TANK, TUNED).step(source, horizon=20)
    size_y, size_u = (abs(signal.peak()[1]) for signal in (response.y, response.u))
    for t in (0.3, 1.99, 2.7, 5.0, 7.77, 13.1, 19.9):
        _, u, y = second(t)
        assert abs(response.y(t) - y) < 1e-12 * size_y
        assert abs(response.u(t) - u) < 1e-12 * size_u


tenth = st.integers(-20, 20).map(lambda k: k / 10)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.integers(-15, 3).map(lambda k: k / 10), min_size=1, max_size=3),
    st.lists(tenth, min_size=1, max_size=2),
    st.integers(1, 30).map(lambda k: k / 10),
    st.integers(1, 8).map(lambda k: k / 10),
    st.integers(1, 5).map(lambda k: k / 10),
    st.sampled_from(["reference", "load", "noise"]),
)
def test_stacked_matrix_exponentials_agree_on_random_loops(poles, num, delay, P, I, source):
    """Stable, unstable and integrating processes, also such that act at once, over six dead times."""
    process = Process(num[: len(poles) + 1], np.poly(poles), delay)
    pid = PidParallel(P, I, 0.3 * P, 8.0)
    response = Loop(process, pid).step(source, horizon=6 * delay)
    second = stacked(loop_equation(process, pid.regulator(), source, None), 6)
    size_y, size_u = (max(1e-300, abs(signal.peak()[1])) for signal in (response.y, response.u))
    for t in np.array([0.1, 0.95, 1.5, 2.3, 3.7, 4.6, 5.9]) * delay:
        _, u, y = second(t)
        assert abs(response.y(t) - y) <= 1e-11 * size_y
        assert abs(response.u(t) - u) <= 1e-11 * size_u


def test_pade_of_rising_order_converges_to_ours():
    """Away from the corner that the derivative makes at t = L; near it Padé converges slowly, with rising order."""
    t = np.linspace(0, 40, 81)
    exact = Loop(TANK, TUNED).step(horizon=40).y(t)
    regulator = control.ss(control.tf(*map(list, TUNED.transfer())))
    errors, near = [], []
    for order in (1, 2, 4, 8):
        closed = control.feedback(regulator * control.ss(TANK.to_control(pade=order)), 1)
        error = np.abs(np.asarray(control.step_response(closed, t).outputs) - exact)
        errors.append(error[t > 5].max())
        near.append(error.max())
    assert errors[0] > 10 * errors[1] > 20 * errors[2] > 80 * errors[3]
    assert near[0] > 2 * near[1] > 3 * near[2] > 6 * near[3]


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.floats(0.2, 10), min_size=1, max_size=4),
    st.floats(0.1, 3),
    st.floats(0.5, 20),
    st.floats(0, 1),
    st.sampled_from(["reference", "load", "noise"]),
)
def test_rational_loops_agree_with_python_control(lags, gain, Ti, b, source):
    process = Process([1], np.poly([-1 / lag for lag in lags]) * np.prod(lags))
    pid = PidStandard(gain, Ti, 0.5, b=b, c=0, N=8)
    P = control.ss(process.to_control())
    regulator = pid.regulator()
    R = control.ss(control.tf(list(regulator.S), list(regulator.R)))
    F = control.ss(control.tf(list(regulator.T), list(regulator.S)))
    closed = {
        "reference": F * control.feedback(P * R, 1),
        "load": control.feedback(P, R),
        "noise": -control.feedback(P * R, 1),
    }
    assume((np.real(closed["load"].poles()) < -0.02).all())
    assume((np.real(closed["reference"].poles()) < -0.02).all())
    t = np.linspace(0, 8 * sum(lags), 60)
    expected = control.step_response(closed[source], t).outputs
    response = Loop(process, pid).step(source, horizon=t[-1])
    assert np.abs(response.y(t) - expected).max() < 1e-9 * max(1, np.abs(expected).max())


def test_the_horizon_does_not_change_the_answer():
    t = np.linspace(0, 9, 50)
    short, long = (Loop(TANK, TUNED).step(horizon=h).y(t) for h in (9, 200))
    assert np.abs(short - long).max() < 1e-13


@pytest.mark.parametrize("factor", [1e-9, 1e-3, 1e6])
def test_units_do_not_matter(factor):
    """Another unit of u scales the process up and the regulator down: the same y."""
    t = np.linspace(0, 30, 61)
    scaled = PidParallel(*(p / factor for p in (TUNED.P, TUNED.I, TUNED.D)), TUNED.N)
    same = Loop(TANK * factor, scaled).step(horizon=30).y(t)
    assert np.abs(same - Loop(TANK, TUNED).step(horizon=30).y(t)).max() < 1e-12


def test_a_fast_filter_is_resolved():
    """Derivative filter at 1e5 rad/s against none, the dead time 2 s: the difference is of the order of 1/N."""
    t = np.linspace(0, 30, 61)
    ideal, fast = (
        Loop(TANK, PidParallel(TUNED.P, TUNED.I, TUNED.D, N, c=0)).step(horizon=30).y(t) for N in (np.inf, 1e5)
    )
    assert 1e-7 < np.abs(ideal - fast).max() < 1e-4


def test_ideal_derivative_on_the_measurement_against_python_control():
    """PI on the error and D on y of 1/(s+1)^3: y = (K s + Ki) P/(s + P (K s + Ki + D s^2)) r."""
    t = np.linspace(0, 20, 81)
    K, Ki, D = 1.2, 0.6, 0.8
    response = Loop(Process([1], [1, 3, 3, 1]), PidParallel(K, Ki, D, c=0)).step(horizon=20)
    closed = control.tf([K, Ki], np.polyadd(np.polymul([1, 0], [1, 3, 3, 1]), [D, K, Ki]))
    assert np.abs(response.y(t) - control.step_response(closed, t).outputs).max() < 1e-10


def test_short_dead_time_many_segments():
    """3000 dead times in the horizon; the loop is nearly rational and 1 + O(L) close to it."""
    t = np.linspace(0, 30, 31)
    short = Loop(Process([1], [3, 1], 0.01), 2.0).step(horizon=30).y(t)
    rational = Loop(Process([1], [3, 1]), 2.0).step(horizon=30).y(t)
    expected = 2 / 3 * (1 - np.exp(-t))
    assert np.abs(rational - expected).max() < 1e-13
    assert 1e-5 < np.abs(short - rational).max() < 2e-2


def test_pure_delay_with_integral_control_and_with_p():
    """y = u(t - L): with P control a staircase of a geometric sum, exactly."""
    stairs = Loop(Process([1], [1], 1.0), 0.5).step(horizon=6).y(np.arange(6) + 0.5)
    assert stairs == pytest.approx([0, 0.5, 0.25, 0.375, 0.3125, 0.34375], abs=1e-14)
    integral = Loop(Process([1], [1], 1.0), PidParallel(0, 0.3)).step(horizon=10)
    t = np.linspace(0, 9, 91)
    assert np.abs(integral.y(t) - (1 - integrator_error(t, 0.3, 1.0))).max() < 1e-13


def test_unstable_process_is_held_and_the_regulator_checked():
    process = Process([1], [1, -1], 0.2)
    response = Loop(process, PidParallel(3, 1)).step()
    assert response.y(response.horizon) == pytest.approx(1, abs=1e-9)
    assert response.final == (1.0, -1.0)


def test_disturbance_where_it_enters():
    """At the inlet of the double tank it passes everything, before the second tank it misses the pipe."""
    inlet = Loop(TANK, TUNED, Process([1], [35, 12, 1], 2))
    response, load = inlet.step("disturbance", 60), Loop(TANK, TUNED).step("load", 60)
    t = np.linspace(0, 60, 61)
    assert np.abs(response.y(t) - 8360 * load.y(t)).max() < 1e-11
    late = Loop(TANK, TUNED, Process([1], [7, 1])).step("disturbance", 60)
    early = t[t < 2]
    assert late.y(early) == pytest.approx(1 - np.exp(-early / 7), abs=1e-13)


def test_sum_of_delayed_paths_is_the_sum_of_the_responses():
    one, two = Process([1], [35, 12, 1], 2.0), Process([0.5], [3, 1], 0.7)
    t = np.linspace(0, 50, 101)
    parts = [Loop(TANK, TUNED, path).step("disturbance", 60).y(t) for path in (one, two)]
    both = Loop(TANK, TUNED, one + two).step("disturbance", 60)
    assert np.abs(both.y(t) - sum(parts)).max() < 1e-13
    assert both.final == pytest.approx((0, -8360 * 1.5))


def test_final_values():
    loop = Loop(TANK, TUNED, Process([1], [35, 12, 1], 2))
    assert loop.final_values("reference") == pytest.approx((1, 8360))
    assert loop.final_values("load") == pytest.approx((0, -1))
    assert loop.final_values("noise") == pytest.approx((-1, -8360))
    assert loop.final_values("disturbance") == pytest.approx((0, -8360))
    proportional = Loop(TANK, 8360.0)
    assert proportional.final_values("reference") == pytest.approx((0.5, 4180))


def test_integrals_of_the_error():
    """IE = 1/(ki) for a load step; IAE equals it where the error keeps its sign, and ISE from the frequency domain."""
    process, pid = Process([1], [1, 2, 1], 0.0), PidParallel(2.0, 0.4)
    response = Loop(process, pid).step("load")
    assert response.iae() == pytest.approx(1 / 0.4, rel=1e-9)
    w = np.geomspace(1e-6, 1e4, 2_000_001)
    y = process(1j * w) / (1 + process(1j * w) * pid(1j * w)) / (1j * w)
    assert response.ise() == pytest.approx(np.trapezoid(np.abs(y) ** 2, w) / np.pi, rel=1e-5)


def test_iae_counts_both_signs():
    response = Loop(TANK, TUNED).step("reference")
    t = np.linspace(0, response.horizon, 400_001)
    assert response.iae() == pytest.approx(np.trapezoid(np.abs(1 - response.y(t)), t), rel=1e-6)
    assert response.iae() > abs(response.error.integral())


def test_a_staircase_of_inputs_is_a_sum_of_steps():
    response = Loop(TANK, TUNED).step("noise", horizon=30)
    t = np.linspace(0, 20, 41)
    y, u = response.after([(0.0, 0.1), (3.3, -0.2), (8.0, 0.1)], t)
    assert np.abs(y - (0.1 * response.y(t) - 0.2 * response.y(t - 3.3) + 0.1 * response.y(t - 8))).max() == 0
    assert u.shape == t.shape


def test_two_degrees_of_freedom_change_the_reference_response_only():
    plain = Loop(TANK, PidParallel(TUNED.P, TUNED.I, TUNED.D, TUNED.N, b=0.3, c=0))
    t = np.linspace(0, 30, 31)
    assert np.abs(plain.step("load", 30).y(t) - Loop(TANK, TUNED).step("load", 30).y(t)).max() < 1e-16
    assert plain.step("reference", 30).u(0.0) == pytest.approx(0.3 * TUNED.P)


UNSTABLE = Loop(TANK, PidParallel(8 * TUNED.P, TUNED.I, TUNED.D, TUNED.N))


@pytest.mark.parametrize(
    ("ask", "error", "says"),
    [
        (lambda: UNSTABLE.step(), LoopError, "not stable .2 roots in the right half plane.* no settling time"),
        (lambda: UNSTABLE.step(horizon=20).metrics(), LoopError, "no final values"),
        (lambda: UNSTABLE.step(horizon=20).iae(), LoopError, "not stable"),
        (lambda: UNSTABLE.margins(), LoopError, "has no margins"),
        (lambda: Loop(TANK, TUNED).step(horizon=5).metrics(), NotSettled, "longer horizon"),
        (lambda: Loop(TANK, TUNED).step(horizon=20).iae(), HorizonError, "not settled at t = 20"),
        (lambda: Loop(TANK, TUNED).step(horizon=20).y(33.0), HorizonError, "beyond the horizon"),
        (lambda: Loop(TANK, TUNED).step(horizon=0), ResponseError, "positive number"),
        (lambda: Loop(TANK, TUNED).step(horizon=np.nan), ResponseError, "positive number"),
        (lambda: Loop(TANK, TUNED).step("sideways", 10), ResponseError, "one of reference, load"),
        (lambda: Loop(TANK, TUNED).step("disturbance", 10), ResponseError, "path"),
        (lambda: Loop(TANK, 8360.0).step("reference").iae(), LoopError, "integral is infinite"),
        (lambda: Loop(Process([-1], [1]), 1.0).step(horizon=1), ResponseError, "algebraic loop"),
        (lambda: Loop(TANK, PidParallel(1, 1, 1)).step(horizon=5), ResponseError, "impulse"),
        (lambda: Loop(TANK, PidParallel(1, 1, 1, c=0)).step("noise", 5), ResponseError, "impulse"),
        (lambda: Loop(TANK, Regulator([1], [1, 0, 0], [1])).step(horizon=5), ResponseError, "once at most"),
        (lambda: Loop(Process([1, 0], [1, 1], 1), PidParallel(1, 1, 1, c=0)).step(horizon=5), ResponseError, "at once"),
        (
            lambda: Loop(TANK, TUNED, Process([1], [1, 0])).step("disturbance", 9),
            ResponseError,
            "not the process's own",
        ),
        (lambda: Loop(Process([1, 1], [1, 2], 1e-9), 1 - 1e-9).step(horizon=1e3), ResponseError, "shorten the horizon"),
        (lambda: Loop(Process([1], [1, -9], 1), 1.0).step(horizon=1e4), ResponseError, "grows beyond all numbers"),
        (lambda: Loop(Process([1], [1, 0], 1), np.pi / 2).step(), LoopError, "root on the imaginary axis"),
    ],
)
def test_clear_answers_to_bad_questions(ask, error, says):
    with pytest.raises(error, match=says):
        ask()


def test_an_unstable_loop_can_be_watched():
    y = UNSTABLE.step(horizon=40).y
    assert np.isfinite(y(np.linspace(0, 40, 50))).all()
    assert y.peak()[1] ** 2 > 4


def test_waiting_for_rest_ends_where_rounding_is_left():
    """Poles up to 2,500 rad/s with a dead time of 6 s: a rest of 1e-11 does not make the horizon grow for ever."""
    den = np.polymul(np.polymul([1, 2490.0], [1, 58.0]), np.polymul(np.polymul([1, 24.0], [1, 4.0]), [1, 4.2, 0.0]))
    loop = Loop(Process([9.3, 11.1], den, 5.8), PidStandard(181000.0, 7.8, 0.39, 0.13, 0.0, N=13))
    response = loop.step()
    assert response.horizon <= 2 * loop.settling_horizon()
    assert response.iae() == pytest.approx(
        response.error.until(0.9 * response.horizon).integral_of_magnitude(), rel=1e-8
    )
