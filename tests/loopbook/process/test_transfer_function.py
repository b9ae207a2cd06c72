"""A process: what it refuses, its arithmetic, its exact step response, and python-control beside it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopbook.process.transfer_function import DelayedSum, Process, ProcessError


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda: Process([1, 0, 0], [1, 1]), "improper"),
        (lambda: Process([1], [1, 1], -0.5), "negative"),
        (lambda: Process([1], [1, 1], math.nan), "finite number of seconds"),
        (lambda: Process([1], [0, 0]), "den is zero"),
        (lambda: Process([math.inf], [1, 1]), "must be finite"),
        (lambda: Process([1j], [1, 1]), "real numbers"),
        (lambda: Process(["a"], [1, 1]), "real numbers|could not convert"),
        (lambda: Process([], [1, 1]), "descending powers"),
        (lambda: Process.fopdt(1, 0, 1), "must be positive"),
        (lambda: Process.integrating(1, 1, -1), "must not be negative"),
        (lambda: Process([1], [1, 1], 1).to_control(), "pade"),
    ],
)
def test_what_is_no_process_is_refused_by_name(build, says):
    with pytest.raises(ValueError, match=says):
        build()


def test_leading_zeros_do_not_count():
    assert Process([0, 0, 2], [0, 1, 1]) == Process([2], [1, 1])


def test_series_connection_multiplies_and_adds_dead_times():
    a, b = Process([1], [5, 1], 2), Process([3], [7, 1], 0.5)
    s = np.array([0.3j, 0.1 + 1j])
    assert np.allclose((a * b)(s), a(s) * b(s), rtol=1e-14)
    assert (a * b).delay == 2.5
    assert (2 * a)(0.0) == 2.0
    assert (a + b + a)(0.0) == 5.0
    assert DelayedSum((a,)) + DelayedSum((b,)) == a + b


@pytest.mark.parametrize(
    ("process", "gain"),
    [
        (Process([2], [5, 4]), 0.5),
        (Process([2], [5, 4, 0]), math.inf),
        (Process([-2], [5, 4, 0]), -math.inf),
        (Process([2, 0], [5, 4, 0]), 0.5),
    ],
)
def test_static_gain(process, gain):
    assert process.static_gain == gain


def test_step_of_a_first_order_process_is_the_formula():
    t = np.linspace(0, 30, 301)
    expected = np.where(t < 1.7, 0.0, 2.5 * (1 - np.exp(-np.maximum(t - 1.7, 0) / 3)))
    assert np.abs(Process.fopdt(2.5, 3, 1.7).step(t) - expected).max() < 1e-14


def test_step_of_an_integrator_with_lag_is_the_formula():
    t = np.linspace(0, 30, 301)
    later = np.maximum(t - 2, 0)
    expected = 0.5 * (later - 4 * (1 - np.exp(-later / 4)))
    assert np.abs(Process.integrating(0.5, 2, 4).step(t) - expected).max() < 1e-13


@pytest.mark.parametrize("slow", [1.0, 1e3, 1e6])
def test_a_stiff_process_is_resolved(slow):
    """Two time constants up to twelve decades apart."""
    fast = 1e-6
    process = Process([1], np.polymul([slow, 1], [fast, 1]))
    t = np.concatenate([np.geomspace(1e-8, 1e-3, 50), np.linspace(0.1, 5 * slow, 50)])
    expected = 1 - (slow * np.exp(-t / slow) - fast * np.exp(-t / fast)) / (slow - fast)
    assert np.abs(process.step(t) - expected).max() < 1e-13


def test_a_high_order_process_is_exact():
    """1/(s+1)^20 against the incomplete gamma function."""
    from scipy.special import gammainc

    t = np.linspace(0, 60, 121)
    assert np.abs(Process([1], np.poly(-np.ones(20))).step(t) - gammainc(20, t)).max() < 1e-11


def test_a_pure_delay_steps_at_once():
    assert Process([3], [1], 2).step([1.9999, 2.0, 5.0]) == pytest.approx([0, 3, 3], abs=1e-14)


@given(
    st.lists(st.floats(0.05, 20), min_size=1, max_size=4),
    st.lists(st.floats(0.1, 3), min_size=1, max_size=2),
)
@pytest.mark.long
def test_python_control_agrees_and_round_trips(lags, num):
    import control

    den = [1.0]
    for lag in lags:
        den = np.polymul(den, [lag, 1])
    process = Process(num[: len(den)], den)
    t = np.linspace(0, 5 * sum(lags), 50)
    assert Process.from_control(process.to_control()) == process
    expected = control.step_response(process.to_control(), t).outputs
    assert np.abs(process.step(t) - expected).max() <= 1e-9 * max(1, np.abs(expected).max())


def test_pade_converges_to_the_dead_time():
    process = Process([1], [1, 1], 1)
    errors = [abs(process.to_control(pade=n)(0.8j) - process(0.8j)) for n in (1, 2, 4)]
    assert errors[0] > 10 * errors[1] > 100 * errors[2]


@pytest.mark.long
def test_from_control_refuses_sampled_and_multivariable_systems():
    import control

    with pytest.raises(ProcessError, match=r"dt = 0\.1"):
        Process.from_control(control.tf([1], [1, 0.5], 0.1))
    with pytest.raises(ProcessError, match="one input and one output"):
        Process.from_control(control.ss(-np.eye(2), np.eye(2), np.eye(2), np.zeros((2, 2))))
