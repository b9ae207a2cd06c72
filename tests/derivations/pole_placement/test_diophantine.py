"""The polynomial equation: the document's system, the Diophantine identity on random plants, and its errors by text."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from derivations.algebra.delay_polynomials import DelayPolynomialError, Z, coefficients, polynomial
from derivations.pole_placement.diophantine import (
    CommonFactor,
    NoDelay,
    NoStaticGain,
    PolePlacementError,
    integrators,
    place_exactly,
)
from derivations.pole_placement.regulator_degrees import Degrees, degrees

a1, a2, b3, b4, q = sp.symbols("a_1 a_2 b_3 b_4 q")
R = sp.Rational
HALF = R(1, 2)


@pytest.fixture(scope="module")
def tanks():
    return place_exactly(1 + a1 / Z + a2 / Z**2, b3 / Z**3 + b4 / Z**4, (1 - q / Z) ** 3, integrators(1))


def test_the_document_s_degrees_and_unknowns(tanks):
    n = tanks.degrees
    assert (n.a_prime, n.b, n.c, n.d, n.unknowns) == (3, 4, 3, 2, 6)
    assert [s.name for s in tanks.unknowns] == ["c_1", "c_2", "c_3", "d_0", "d_1", "d_2"]


def test_the_sylvester_system_of_the_appendix(tanks):
    assert tanks.matrix == sp.Matrix(
        [
            [1, 0, 0, 0, 0, 0],
            [-1 + a1, 1, 0, 0, 0, 0],
            [-a1 + a2, -1 + a1, 1, b3, 0, 0],
            [-a2, -a1 + a2, -1 + a1, b4, b3, 0],
            [0, -a2, -a1 + a2, 0, b4, b3],
            [0, 0, -a2, 0, 0, b4],
        ]
    )
    assert (tanks.right_side - sp.Matrix([1 - a1 - 3 * q, a1 - a2 + 3 * q**2, a2 - q**3, 0, 0, 0])).is_zero_matrix


@pytest.mark.long
def test_second_route_the_extended_euclidean_algorithm(tanks):
    w = sp.Symbol("w")
    A, B, P = (sp.Poly(p.subs(Z, 1 / w), w, field=True) for p in (tanks.A * tanks.fixed, tanks.B, tanks.P))
    _, t, g = A.gcdex(B)
    D = (t * P).quo(g).rem(A)
    C_prime = (P - B * D).quo(A)
    found = [*reversed(C_prime.all_coeffs()[:-1]), *reversed(D.all_coeffs())]
    assert all(sp.cancel(x - y) == 0 for x, y in zip(found, tanks.solution.values(), strict=True))


def test_closed_loop_is_identically_the_wanted_polynomial(tanks):
    assert sp.expand(tanks.closed_loop - (1 - q / Z) ** 3) == 0
    direct = sp.cancel(sp.together(tanks.A * tanks.C + tanks.B * tanks.D))
    assert sp.cancel(direct - (1 - q / Z) ** 3) == 0


def test_the_determinant_vanishes_exactly_where_a_prime_and_b_share_a_root(tanks):
    zero = -b4 / b3  # the zero of the plant
    at_zero = sp.cancel((tanks.A * tanks.fixed).subs(Z, zero))
    assert sp.cancel(tanks.determinant - b4**3 * at_zero) == 0


def test_static_gain_one(tanks):
    assert sp.cancel(tanks.Kr - (1 - q) ** 3 / (b3 + b4)) == 0
    closed = tanks.Kr * tanks.B / tanks.P
    assert sp.cancel(closed.subs(Z, 1)) == 1


def test_the_difference_equations_of_the_document(tanks):
    k = sp.Symbol("k", integer=True)
    u, y, r = (sp.Function(name) for name in "uyr")
    Kr, c1, c2, c3, d0, d1, d2 = sp.symbols("K_r c_1 c_2 c_3 d_0 d_1 d_2")
    plant = -a1 * y(k - 1) - a2 * y(k - 2) + b3 * u(k - 3) + b4 * u(k - 4)
    regulator = Kr * r(k) - (c1 - 1) * u(k - 1) - (c2 - c1) * u(k - 2) - (c3 - c2) * u(k - 3) - (-c3) * u(k - 4)
    regulator += -d0 * y(k) - d1 * y(k - 1) - d2 * y(k - 2)
    assert sp.expand(tanks.plant_equation().rhs - plant) == 0
    assert sp.expand(tanks.regulator_equation().rhs - regulator) == 0


def test_a_wrong_coefficient_is_seen(tanks):
    wrong = replace(tanks, solution={**tanks.solution, tanks.unknowns[3]: tanks.solution[tanks.unknowns[3]] + b3})
    assert sp.expand(wrong.closed_loop - wrong.P) != 0


small = st.fractions(min_value=-2, max_value=2, max_denominator=6).map(lambda f: R(f.numerator, f.denominator))


@settings(deadline=None, max_examples=40)
@given(
    a=st.lists(small, max_size=3),
    b=st.lists(small, min_size=1, max_size=3),
    p=st.lists(small, max_size=6),
    delay=st.integers(1, 4),
    count=st.integers(0, 2),
)
@pytest.mark.long
def test_identity_least_degrees_and_numeric_poles_on_random_plants(a, b, p, delay, count):
    A, B, P = polynomial([1, *a]), polynomial([0] * delay + b), polynomial([1, *p])
    assume(B != 0)
    S = integrators(count)
    try:
        design = place_exactly(A, B, P, S)
    except CommonFactor as error:
        for product in (A * S, B):
            assert sp.rem(*_in_w(product, error.factor)) == 0
        assert sp.rem(*_in_w(P, error.factor)) != 0
        return
    assert sp.expand(A * design.C + B * design.D - P) == 0
    n = design.degrees
    assert len(coefficients(design.C_prime)) - 1 <= n.c and len(coefficients(design.D)) - 1 <= n.d
    assert sp.rem(*_in_w(design.C, S)) == 0
    if design.common == 1:
        assert n == degrees(A, B, P, S) and design.determinant != 0


def _in_w(p, divisor):
    w = sp.Symbol("w")
    return sp.Poly(sp.expand(p.subs(Z, 1 / w)), w), sp.Poly(sp.expand(sp.sympify(divisor).subs(Z, 1 / w)), w)


def test_numeric_closed_loop_poles_are_where_they_were_asked():
    A, B = 1 - R(17, 10) / Z + R(71, 100) / Z**2, R(3, 10) / Z**2 + R(1, 10) / Z**3
    P = (1 - R(1, 2) / Z) * (1 - R(1, 5) / Z) * (1 + R(1, 3) / Z)
    design = place_exactly(A, B, P, integrators(2))
    total = coefficients(sp.expand(design.A * design.C + design.B * design.D))
    poles = np.sort(np.roots([float(c) for c in total]).real)
    assert poles[[0, -2, -1]] == pytest.approx([-1 / 3, 0.2, 0.5], abs=1e-6)
    assert sp.expand(design.C).subs(Z, 1) == 0 and sp.diff(sp.expand(design.C), Z).subs(Z, 1) == 0


def test_other_fixed_factors_a_regulator_that_ignores_one_frequency():
    notch = 1 - sp.sqrt(2) / Z + 1 / Z**2
    design = place_exactly(1 - HALF / Z, 1 / Z, 1 - q / Z, fixed=1 - 1 / Z + 1 / Z**2)
    assert sp.rem(*_in_w(sp.expand(design.C), design.fixed)) == 0
    irrational = place_exactly(1 - HALF / Z, 1 / Z, 1, fixed=notch)
    assert sp.simplify(irrational.closed_loop) == 1


def test_long_p_makes_c_prime_longer_and_is_said_to():
    P = (1 - q / Z) ** 6
    design = place_exactly(1 - HALF / Z, 1 / Z**2, P)
    assert (design.degrees.c, design.degrees.d) == (5, 0)
    assert "$C'$ is longer" in " ".join(design.degrees.why())


def test_static_plant_needs_no_feedback():
    design = place_exactly(1, b3 / Z, 1 - q / Z)
    assert design.D == 0
    assert sp.expand(design.C - (1 - q / Z)) == 0


def test_a_common_factor_that_p_contains_is_cancelled_and_named():
    slow = 1 - R(9, 10) / Z
    design = place_exactly(slow * (1 - HALF / Z), slow / Z, slow * (1 - q / Z), integrators(1))
    assert sp.expand(design.common - slow) == 0
    assert design.degrees.common == 1 and any("divided by it" in step for step in design.degrees.why())
    assert sp.expand(design.A * design.C + design.B * design.D - slow * (1 - q / Z)) == 0


def test_scaling_of_the_plant_does_not_matter():
    plain, scaled = (place_exactly(s * (1 - HALF / Z), s * b3 / Z, 1 - q / Z, integrators(1)) for s in (1, 3))
    assert plain.solution == scaled.solution


def test_the_explanation_counts_right(tanks):
    text = " ".join(tanks.degrees.why())
    for part in ("n_{a'} = 2 + 1 = 3", "n_d = 2", "= 3$", "$6$ poles can be placed", "places $3$ outside"):
        assert part in text


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (
            ((1 - q / Z) * (1 - HALF / Z), b3 / Z * (1 - q / Z), 1),
            CommonFactor,
            r"share the factor -q/z \+ 1 \(z = q\)",
        ),
        ((1 - HALF / Z, (1 - 1 / Z) / Z, 1 - q / Z, integrators(1)), CommonFactor, r"1 - 1/z \(z = 1\)"),
        ((1, 1 + 1 / Z, 1), NoDelay, "has a term without delay"),
        ((1, 0, 1), NoDelay, "is zero: the input does not reach the output"),
        ((1 / Z, 1 / Z, 1), PolePlacementError, "A = 1/z must have a term without delay"),
        ((1, 1 / Z, 0), PolePlacementError, "P = 0 must have a term without delay"),
        ((1 - 0.5 / Z, 1 / Z, 1), DelayPolynomialError, r"exact numbers only, write Rational\('-0.5'\)"),
        ((1 + Z, 1 / Z, 1), DelayPolynomialError, r"must be a polynomial in z\^-1"),
    ],
)
def test_errors_name_what_is_wrong(arguments, error, text):
    with pytest.raises(error, match=text):
        place_exactly(*arguments)


def test_error_attributes():
    with pytest.raises(CommonFactor) as caught:
        place_exactly(1 - HALF / Z, b3 / Z * (1 - HALF / Z), 1 - q / Z)
    assert sp.expand(caught.value.factor - (1 - HALF / Z)) == 0
    assert sp.expand(caught.value.P - (1 - q / Z)) == 0


def test_hidden_common_factor_in_numbers_that_depend_on_each_other():
    e = sp.exp
    A = 1 - (e(-R(1, 5)) + e(-R(1, 7))) / Z + e(-R(12, 35)) / Z**2
    with pytest.raises(PolePlacementError, match="numbers that depend on each other"):
        place_exactly(A, (1 - e(-R(1, 5)) / Z) / Z, 1)


def test_no_static_gain():
    with pytest.raises(NoStaticGain, match=r"B\(1\) = 0"):
        _ = place_exactly(1 - HALF / Z, (1 - 1 / Z) / Z, 1 - q / Z).Kr
    with pytest.raises(NoStaticGain, match="P has a root at z = 1"):
        _ = place_exactly(1 - HALF / Z, 1 / Z, 1 - 1 / Z).Kr


@pytest.mark.parametrize(("p", "words"), [(6, "at most $"), (7, "more than $")])
def test_why_names_the_border_from_which_p_makes_the_regulator_longer(p, words):
    degrees = Degrees(a=2, fixed=1, b=4, p=p)
    border = rf"n_{{a'}} + n_b - 1 = {degrees.largest_p}$"
    assert any(f"That of $P$ is ${p}$, {words}{border}" in step for step in degrees.why())
    assert (degrees.c > degrees.b - 1) == (p > degrees.largest_p)
