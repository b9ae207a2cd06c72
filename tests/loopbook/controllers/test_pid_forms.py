"""PID forms: conversions change the name, never the controller."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from loopbook.controllers.pid_forms import PidParallel, PidSeries, PidStandard
from loopbook.controllers.regulator import Regulator

S = 1j * np.geomspace(1e-3, 1e3, 25)
positive = st.floats(0.01, 100)
weight = st.floats(0, 2)


def written_out(K, Ti, Td, Tf, b, c, s):
    """The definition, without a polynomial: (u/r, -u/y)."""
    integral, derivative = 1 / (s * Ti), s * Td / (1 + s * Tf)
    return K * (b + integral + c * derivative), K * (1 + integral + derivative)


@given(positive, positive, positive, positive, weight, weight)
def test_standard_form_is_its_definition(K, Ti, Td, N, b, c):
    pid = PidStandard(K, Ti, Td, b, c, N=N)
    regulator = pid.regulator()
    reference, feedback = written_out(K, Ti, Td, Td / N, b, c, S)
    assert np.allclose(regulator.feedforward(S), reference, rtol=1e-11)
    assert np.allclose(regulator.feedback(S), feedback, rtol=1e-11)


@given(positive, positive, positive, positive, weight, weight)
def test_standard_to_parallel_and_back(K, Ti, Td, N, b, c):
    pid = PidStandard(K, Ti, Td, b, c, N=N)
    back = pid.parallel().standard()
    for name in ("K", "Ti", "Td", "b", "c", "N", "Tf"):
        assert math.isclose(getattr(back, name), getattr(pid, name), rel_tol=1e-12)
    assert np.allclose(pid.parallel()(S), pid(S), rtol=1e-11)


@given(positive, positive, positive, positive)
def test_series_to_standard_keeps_the_controller(K, Ti, Td, N):
    series = PidSeries(K, Ti, Td, N=N)
    assume(series.Tf <= Ti)
    product = K * (1 + 1 / (S * Ti)) * (1 + S * Td / (1 + S * series.Tf))
    assert np.allclose(series.standard()(S), product, rtol=1e-10)
    assert np.allclose(series(S), product, rtol=1e-10)


@given(positive, st.floats(4.5, 40), st.floats(0, 0.1))
def test_standard_to_series_keeps_the_controller(K, ratio, share):
    pid = PidStandard(K, ratio, 1.0, 1, 1, Tf=share)
    series = pid.series()
    product = series.K * (1 + 1 / (S * series.Ti)) * (1 + S * series.Td / (1 + S * series.Tf))
    assert np.allclose(product, pid(S), rtol=1e-9)


def test_the_two_meanings_of_n_differ():
    """N divides Td in the standard form and is a pole in rad/s in the parallel form."""
    divisor, pole = PidStandard(1, 10, 4, N=10), PidParallel(1, 0.1, 4, N=10)
    assert divisor.Tf == 0.4
    assert pole.Tf == 0.1
    assert pole.standard().N == 40


def test_simulink_writes_the_same_derivative_otherwise():
    """D N/(1 + N/s), as double-tank has it, is D N s/(s + N)."""
    pid = PidParallel(2, 0.5, 3, N=7)
    assert np.allclose(pid(S), 2 + 0.5 / S + 3 * 7 / (1 + 7 / S), rtol=1e-13)


@pytest.mark.parametrize(
    ("pid", "transfer"),
    [
        (PidStandard(2.0), ((2.0,), (1.0,))),
        (PidStandard(2.0, Ti=4.0), ((2.0, 0.5), (1.0, 0.0))),
        (PidStandard(2.0, Td=3.0), ((6.0, 2.0), (1.0,))),
        (PidParallel(0.0, 1.5), ((1.5,), (1.0, 0.0))),
        (PidStandard(2.0, Td=3.0, Tf=1.0), ((8.0, 2.0), (1.0, 1.0))),
    ],
)
def test_what_does_not_act_leaves_no_pole(pid, transfer):
    assert pid.transfer() == transfer


def test_derivative_on_the_measurement_leaves_the_reference_path():
    pid = PidStandard(2.0, 4.0, 1.0, b=0.5, c=0, N=10)
    num, den = pid.reference_transfer()
    assert np.allclose(np.polyval(num, S) / np.polyval(den, S), 2 * (0.5 + 1 / (4 * S)))


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda: PidStandard(1, 0), "Ti = 0"),
        (lambda: PidStandard(1, -1), "zero or longer"),
        (lambda: PidStandard(1, 1, math.nan), "Td"),
        (lambda: PidStandard(1, 1, 1, N=10, Tf=3), "contradict"),
        (lambda: PidStandard(1, 1, 1, N=0), "must be positive"),
        (lambda: PidStandard(math.inf), "finite"),
        (lambda: PidParallel(1, 1, 1, N=-3), "pole of the derivative"),
        (lambda: PidParallel(0, 1, 1).standard(), "no standard form"),
        (lambda: PidParallel(1, -1).standard(), "differ in sign"),
        (lambda: PidParallel(1, 1, -1).standard(), "differ in sign"),
        (lambda: PidStandard(1, 1, 1, b=1, c=1).series(), "Ti >= 4 Td"),
        (lambda: PidStandard(1, 10, 1, b=1, c=0).series(), "acts on the error"),
        (lambda: PidSeries(1, 1, 10, N=2).standard(), "negative"),
        (lambda: Regulator.of("PID"), "no regulator"),
        (lambda: Regulator([1], [1], [0]), "R is zero"),
    ],
)
def test_errors_say_what_is_wrong(build, says):
    with pytest.raises(ValueError, match=says):
        build()


def test_a_regulator_that_is_itself_unstable_is_seen():
    assert Regulator.one_dof([1], [1, -2, 0]).unstable_poles.tolist() == [2]
    assert not Regulator.one_dof([1], [1, 0]).unstable_poles.size
