"""Derived difference equations, run: exact against the closed-loop polynomial, floats against SciPy, refusals."""

from fractions import Fraction as F

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lfilter

from derivations.algebra.delay_polynomials import Z, difference_equation
from derivations.pole_placement.diophantine import integrators, place_exactly
from loopbook.numerics.recursion import DifferenceEquationError, Recursion, recursion, run_recursion

a1, a2, b3, b4, q = sp.symbols("a_1 a_2 b_3 b_4 q")
TANKS = place_exactly(1 + a1 / Z + a2 / Z**2, b3 / Z**3 + b4 / Z**4, (1 - q / Z) ** 3, integrators(1))
PRINTED = {"a_1": F("-1.686"), "a_2": F("0.7097"), "b_3": F("1.526e-6"), "b_4": F("1.361e-6")}
k = sp.Symbol("k", integer=True)
u, y = sp.Function("u"), sp.Function("y")


def regulator(pole):
    at = {s: sp.Rational(PRINTED[s.name].numerator, PRINTED[s.name].denominator) for s in (a1, a2, b3, b4)} | {q: pole}
    exact = {name: sp.sympify(value).subs(at) for name, value in TANKS.parameters.items()}
    return {name: F(int(v.p), int(v.q)) for name, v in exact.items()}


@pytest.mark.parametrize("pole", [sp.Rational(3, 10), sp.Rational(1, 2), sp.Rational(7, 10)], ids=str)
def test_two_programs_agree_sample_by_sample_in_fractions(pole):
    """Plant and regulator in turn give what Kr B r = P y gives at once."""
    values = PRINTED | regulator(pole)
    equations = [recursion(TANKS.plant_equation(), values), recursion(TANKS.regulator_equation(), values)]
    step = {"r": [F(1)] * 40}
    both = run_recursion(equations, step, 40)
    closed = difference_equation(("y", TANKS.P.subs(q, pole)), {"r": TANKS.B * sp.Symbol("K_r")})
    alone = run_recursion([recursion(closed, values)], step, 40)
    assert both["y"] == alone["y"]
    assert all(isinstance(v, F) for v in both["y"][1:])


def test_a_changed_coefficient_breaks_the_agreement():
    values = PRINTED | regulator(sp.Rational(1, 2))
    values["d_1"] += 1
    equations = [recursion(TANKS.plant_equation(), values), recursion(TANKS.regulator_equation(), values)]
    got = run_recursion(equations, {"r": [F(1)] * 40}, 40)["y"]
    closed = difference_equation(("y", TANKS.P.subs(q, sp.Rational(1, 2))), {"r": TANKS.B * sp.Symbol("K_r")})
    assert got != run_recursion([recursion(closed, values)], {"r": [F(1)] * 40}, 40)["y"]


@settings(deadline=None, max_examples=30)
@given(st.lists(st.floats(-0.4, 0.4), min_size=1, max_size=3), st.lists(st.floats(-2, 2), min_size=1, max_size=4))
def test_floats_against_scipy(a, b):
    names = sp.symbols("p0:3"), sp.symbols("n0:4")
    A = 1 + sum(s * Z ** -(i + 1) for i, s in enumerate(names[0][: len(a)]))
    B = sum(s * Z ** -(i + 1) for i, s in enumerate(names[1][: len(b)]))
    values = {s.name: v for s, v in zip(names[0], a, strict=False)} | {
        s.name: v for s, v in zip(names[1], b, strict=False)
    }
    inputs = np.cos(np.arange(50.0))
    got = run_recursion([recursion(difference_equation(("y", A), {"u": B}), values)], {"u": inputs}, 50)["y"]
    assert np.array(got, dtype=float) == pytest.approx(lfilter([0, *b], [1, *a], inputs), rel=1e-9, abs=1e-9)


def test_everything_before_the_first_sample_is_zero():
    delayed = Recursion("y", (("u", 3, 2),))
    assert run_recursion([delayed], {"u": [1, 1, 1, 1, 1]}, 5)["y"] == [0, 0, 0, 2, 2]


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: recursion(sp.Eq(y(k), a1 * y(k - 1)), {}), "y: no value for a_1; given: none"),
        (lambda: recursion(sp.Eq(y(k), y(k - 1) * u(k)), {}), "must be linear"),
        (lambda: recursion(sp.Eq(y(k), u(k) + 1), {}), "without a constant; 1 is not"),
        (lambda: recursion(sp.Eq(y(k), u(k + 1)), {}), r"u\(k \+ 1\) is no present or earlier sample"),
        (lambda: run_recursion([Recursion("y", (("u", 0, 1),))], {}, 3), "y needs u, which nothing computes"),
        (lambda: run_recursion([Recursion("y", (("u", 0, 1),))], {"u": [1]}, 3), "input u has 1 samples, 3 are needed"),
        (
            lambda: run_recursion([Recursion("y", (("u", 0, 1),)), Recursion("u", (("y", 0, 1),))], {}, 3),
            r"y\(k\) needs u\(k\), which is computed later",
        ),
    ],
)
def test_refusals(call, text):
    with pytest.raises(DifferenceEquationError, match=text):
        call()
