"""Responses with several dead times: against closed forms, and against the solver for one dead time."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.loop.continuous import Loop
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.several_delays import step_response
from loopbook.process.transfer_function import Process

of = ExponentialPolynomial.of
TANK = Process([1 / 8360], [35, 12, 1], delay=2)
LOOPS = {
    "lag": Loop(Process([2], [10, 1], 3), PidStandard(0.8, 10)),
    "tank": Loop(TANK, PidParallel(25194.1165104731, 1956.14979824376, 68803.105267141, 28.6213074510803)),
    "acts at once": Loop(Process([2, 1], [1, 2], 1), PidStandard(0.2, 3)),
    "milliseconds": Loop(Process([2], [10e-3, 1], 3e-3), PidStandard(0.8, 10e-3)),
    "hours": Loop(Process([2], [36e3, 1], 11e3), PidStandard(0.8, 36e3)),
}


@pytest.mark.parametrize("source", ["reference", "load"])
@pytest.mark.parametrize("name", LOOPS)
def test_one_dead_time_as_by_the_method_of_steps(name, source):
    loop = LOOPS[name]
    y = loop.step(source).y
    again = loop.closed(source, "y").step_signal(y.end)
    t = np.linspace(0, y.end, 1500)
    assert np.abs(again(t) - y(t)).max() < 3e-13 * np.abs(y(t)).max()
    u = loop.closed(source, "u").step_signal(y.end)
    assert np.abs(u(t) - loop.step(source).u(t)).max() < 3e-13 * np.abs(u(t)).max()


def test_two_dead_times_as_a_series():
    """y + a y(t - 1) + b y(t - sqrt 2) = u: each pair of numbers of delays leaves a step (binomial coefficients)."""
    from math import comb

    a, b, second, horizon = 0.4, -0.3, 2**0.5, 12.0
    y = step_response(of([1.0]), of([1.0]) + of([a], 1.0) + of([b], second), horizon)
    t = np.linspace(0, 11.97, 1000)
    expected = sum(comb(i + j, i) * (-a) ** i * (-b) ** j * (t >= i + j * second) for i in range(13) for j in range(10))
    assert np.abs(y(t) - expected).max() < 1e-13


def test_two_dead_times_and_a_lag_as_a_series():
    """1/(s + 1 + a e^(-s) + b e^(-1.3 s)): powers of a lag, delayed."""
    from math import comb, factorial

    a, b, second, horizon = 0.5, 0.25, 1.3, 10.0
    y = step_response(of([1.0]), of([1.0, 1.0]) + of([a], 1.0) + of([b], second), horizon)
    t = np.linspace(0, 10, 801)

    def lags(n, t):  # the step response of 1/(s + 1)^n
        x = np.maximum(t, 0)
        return np.where(t > 0, 1 - np.exp(-x) * sum(x**k / factorial(k) for k in range(n)), 0.0)

    expected = sum(
        comb(i + j, i) * (-a) ** i * (-b) ** j * lags(i + j + 1, t - i - j * second)
        for i in range(11)
        for j in range(9)
        if i + j * second < horizon
    )
    assert np.abs(y(t) - expected).max() < 2e-13


def test_a_short_dead_time_and_a_long_horizon():
    """Cells longer than the dead time, once the corners have worn off: y tends to 1/(1 + 0.5) with the known root."""
    y = step_response(of([1.0]), of([1.0, 0.5]) + of([1.0], 0.01), 60.0)
    assert len(y.edges) < 400
    assert float(y(60.0)) == pytest.approx(1 / 1.5, rel=1e-12)
    fine = step_response(of([1.0]), of([1.0, 0.5]) + of([1.0], 0.01), 2.0)
    t = np.linspace(0, 2, 100)
    assert np.abs(fine(t) - y(t)).max() < 1e-13


@pytest.mark.parametrize(
    ("num", "den", "says"),
    [
        (of([1.0], -1.0), of([1.0, 1.0]), "precedes"),
        (of([1.0, 0.0, 0.0]), of([1.0, 1.0]), "more zeros than poles"),
        (of([1.0]), of([1.0]) + of([1.0, 1.0], 1.0), "higher derivative"),
        (of([1.0]), of([1.0, -900.0]) + of([1.0], 1.0), "grows beyond all numbers"),
    ],
)
def test_what_has_no_response_is_said(num, den, says):
    with pytest.raises(ValueError, match=says):
        step_response(num, den, 5.0)
