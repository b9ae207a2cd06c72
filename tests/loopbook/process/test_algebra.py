"""The algebra of transfer functions: against python-control without dead time, against complex numbers with it."""

import math
from decimal import Decimal
from fractions import Fraction

import control
import numpy as np
import pytest

from loopbook.process.transfer_function import DelayedSum, Process, ProcessError, TransferFunction

S = np.array([0.3j, 0.1 + 1j, -0.4 + 0.2j, 2.0])
RATIONAL = [
    Process([2], [10, 1]),
    Process([1, 3], [1, 2, 5]),
    Process([1], [1, 0]),
    Process([2, 1], [1, 4]),
    Process([-1, 1], [1, 2, 1]),
]
DELAYED = [Process([2], [10, 1], 3), Process([1, 3], [1, 2, 5], 0.1), Process([1], [1, 0], 3), Process([2], [1], 0.7)]
OPERATIONS = {
    "sum": lambda a, b: a + b,
    "difference": lambda a, b: a - b,
    "product": lambda a, b: a * b,
    "quotient": lambda a, b: a / b,
    "feedback": lambda a, b: a / (1 + a * b),
    "power": lambda a, b: a**3 * b**-2,
    "numbers": lambda a, b: 2 - a / 3 + (b * 2 + 1) * 0.5 - (-b) + 1 / b,
}


@pytest.mark.parametrize("name", OPERATIONS)
def test_the_value_of_every_operation_is_that_of_complex_numbers(name):
    for processes in (RATIONAL, DELAYED, [*RATIONAL[:2], *DELAYED[:2]]):
        for a in processes:
            for b in processes:
                made = OPERATIONS[name](a, b)
                assert np.allclose(made(S), OPERATIONS[name](a(S), b(S)), rtol=1e-12, atol=1e-13), (a, b, made)
                if name == "feedback":
                    assert np.allclose(a.feedback(b)(S), made(S), rtol=1e-12)


@pytest.mark.parametrize("name", ["sum", "difference", "product", "power", "numbers"])
def test_rational_ones_agree_with_python_control(name):
    for a in RATIONAL:
        for b in RATIONAL:
            if name in ("power", "numbers") and a.relative_degree + b.relative_degree:
                continue  # improper there
            ours = OPERATIONS[name](a, b)
            theirs = OPERATIONS[name](a.to_control(), b.to_control())
            assert isinstance(ours, Process)
            assert np.allclose(ours(S), theirs(S), rtol=1e-12)


def test_feedback_doubles_no_pole():
    closed = Process([1], [5, 1]).feedback(Process([4, 1], [1, 0]))
    theirs = control.feedback(control.tf([1], [5, 1]), control.tf([4, 1], [1, 0]))
    assert closed == Process(theirs.num[0][0], theirs.den[0][0])
    assert Process([1], [1, 0]).feedback(sign=1) == Process([1], [1, -1])


def test_what_is_equal_cancels_and_nothing_else():
    P, Q = Process([2], [10, 1], 3), Process([3, 1], [4, 5, 1])
    assert P / P == P**0 == P**-1 * P == Process([1], [1])
    assert P - P == Process([0], [1])
    assert (P + Q) - Q == P
    assert Q * Process([1], [3, 1]) == Process([1], [4, 5, 1])
    assert Q * Process([1], [3, 4, 1]) == Process([3, 1], [12, 31, 27, 9, 1]), "a factor of a row stays"
    assert P / Process([1], [10, 1], 1) == Process([2], [1], 2)


def test_the_least_denominator_that_needs_no_rounding():
    assert Process([1], [1, 1, 0]) + Process([1], [1, 0]) == Process([1, 2], [1, 1, 0])
    assert Process([1], [2, 1, 0]) + Process([1], [5, 1, 0]) == Process([7, 2], [10, 7, 1, 0])


def test_dead_times_add_in_products_and_stay_apart_in_sums():
    P, Q = Process([2], [10, 1], 3), Process([1], [5, 1], 1)
    assert (P * Q).delay == 4 and (P**3).delay == 9
    assert isinstance(P + Q, DelayedSum) and [term.delay for term in (P + Q).terms] == [3, 1]
    assert isinstance(P + Process([1], [5, 1], 3), Process)
    assert (P / Process([1], [1], 3)).delay == 0
    assert 0.1 + 0.2 != 0.3
    assert isinstance(Process([1], [1], 0.1) * Process([1], [1], 0.2) - Process([1], [1], 0.3), Process)


def test_the_laplace_variable_builds_processes():
    import loopbook as lb

    s = lb.tf("s")
    assert 2 / ((10 * s + 1) * (4 * s + 1)) == Process([2], [40, 14, 1])
    assert (s + 1) / (s + 2) == Process([1, 1], [1, 2])
    assert s * Process([1], [3, 1], 2) == Process([1, 0], [3, 1], 2)
    assert lb.tf("s", delay=0) == s


@pytest.mark.parametrize("number", [2, np.int64(2), np.float32(2), Fraction(2), Decimal(2)])
def test_numbers_of_any_kind_count(number):
    P = Process([3], [5, 1], 1)
    assert P * number == number * P == Process([6], [5, 1], 1)
    assert P / number == Process([1.5], [5, 1], 1)
    assert (P + number)(0.0) == (number + P)(0.0) == 5
    assert (number - P)(0.0) == -1


@pytest.mark.parametrize(
    ("build", "error", "says"),
    [
        (lambda P: P / 0, ProcessError, "division by zero"),
        (lambda P: 1 / (P - P), ProcessError, "division by zero"),
        (lambda P: P.feedback(-1 / P), ProcessError, "algebraic loop"),
        (lambda P: P.feedback("x"), ProcessError, "no transfer function"),
        (lambda P: P + "x", TypeError, "unsupported"),
        (lambda P: P**0.5, TypeError, "unsupported"),
        (lambda P: (1 / P).step([1.0]), ValueError, "precedes the input"),
        (lambda P: (1 / P.rational).step([1.0]), ValueError, "more zeros than poles"),
        (lambda P: (P.rational + 1).impulse([1.0]), ProcessError, "begins with an impulse"),
    ],
)
def test_what_cannot_be_is_said(build, error, says):
    with pytest.raises(error, match=says):
        build(Process([2], [10, 1], 3))


@pytest.mark.parametrize(
    ("made", "gain"),
    [
        (Process([2], [10, 1], 3).feedback(), 2 / 3),
        (Process([2], [10, 0], 3).feedback(), 1.0),
        (Process([1], [1], 0) - Process([1], [1], 2), 0.0),
        ((Process([1], [1], 0) - Process([1], [1], 2)) / Process([1, 0], [1, 1]), 2.0),
        (1 / (Process([1], [1], 0) - Process([1], [1], 2)), math.inf),
        (Process([1], [1, 0], 2) - Process([1], [1, 0], 5), 3.0),
    ],
)
def test_static_gains_with_dead_times_inside(made, gain):
    assert made.static_gain == pytest.approx(gain, rel=1e-14)


def test_impulse_and_ramp_are_the_formulas():
    t = np.linspace(0, 30, 301)
    later = np.maximum(t - 1.7, 0)
    P = Process.fopdt(2.5, 3, 1.7)
    assert np.abs(P.impulse(t) - np.where(t < 1.7, 0, 2.5 / 3 * np.exp(-later / 3))).max() < 1e-14
    assert np.abs(P.ramp(t) - 2.5 * (later - 3 * (1 - np.exp(-later / 3)))).max() < 1e-12
    fast = Process([1e6], [1, 2e3, 1e6])  # a double pole at 1e3
    assert np.allclose(fast.impulse(t / 1e3), 1e6 * t / 1e3 * np.exp(-t), rtol=1e-10, atol=1e-9)


def test_a_step_of_a_sum_and_of_a_quotient():
    t = np.linspace(0, 40, 401)
    P, Q = Process([2], [10, 1], 3), Process([1], [5, 1], 1)
    assert np.abs((P + Q).step(t) - P.step(t) - Q.step(t)).max() < 1e-14
    assert np.abs((P + Q).impulse(t[:-1]) - P.impulse(t[:-1]) - Q.impulse(t[:-1])).max() < 1e-13
    # the echo 1/(1 + exp(-2 s)/2): a geometric series of steps
    echo = Process([0.5], [1], 2)
    expected = sum((-0.5) ** k * (t >= 2 * k) for k in range(21))
    assert np.abs((1 / (1 + echo)).step(t) - expected).max() < 1e-14


def test_text_and_formula_are_short():
    long = Process(np.ones(30), np.ones(31), 2).feedback()
    shown = [Process(np.arange(1.0, 40), np.arange(1.0, 41)), long, long + 1, Process([1], [1, 1], 1) + 1]
    assert all(len(repr(one)) < 300 for one in shown)
    closed = Process([2], [10, 1], 3).feedback(0.5)
    assert isinstance(closed, TransferFunction)
    assert repr(closed) == "TransferFunction(2 exp(-3 s) over 10 s + 1 + exp(-3 s))"
    assert closed.latex() == r"\frac{2 e^{-3 s}}{10 s + 1 + e^{-3 s}}"
    both = Process([2], [10, 1], 3) - Process([1], [5, 1])
    assert both.latex() == r"\frac{2}{10 s + 1} e^{-3 s} - \frac{1}{5 s + 1}"
    assert closed._repr_latex_() == f"$${closed.latex()}$$"
