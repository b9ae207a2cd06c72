"""The polynomial equation in numbers: exact where exact, floats beside it; placement in s and with shared factors."""

from decimal import Decimal
from fractions import Fraction as F

import numpy as np
import pytest
import sympy as sp

import loopbook as lb
from derivations.pole_placement.polynomial_equation import place_continuous as in_letters
from loopbook.controllers.rst import PlacementError, with_zeros, zeros_of
from loopbook.loop.continuous import Loop
from loopbook.loop.roots import poles
from loopbook.pole_placement.continuous import place_continuous
from loopbook.pole_placement.numeric import place_numerically
from loopbook.pole_placement.polynomial_equation import PolynomialEquationError, diophantine
from loopbook.process.transfer_function import Process


def total(A, X, B, Y):
    return np.polyadd(np.convolve(A, np.array(X, float)), np.convolve(B, np.array(Y, float)))


def test_exact_and_numeric_are_the_printed_solution():
    A, B, C = [1, 2, -13, -14, 24], [1, -1, -2], [1, 8, 22, 24, 9]
    exact, numeric = diophantine(A, B, C), diophantine(np.array(A, float), B, C)
    assert exact.X == (F(-25, 8), F(-25, 8)) and exact.Y == (F(25, 8), F(27, 2), F(-53, 8), F(-42))
    assert np.allclose(numeric.X, [-25 / 8] * 2, rtol=1e-13) and np.allclose(numeric.Y, [3.125, 13.5, -6.625, -42])
    assert diophantine([Decimal("0.5"), 1], [F(1, 3)], [1, 0]).Y == (F(-6),)
    assert "27/2" in str(exact) and "T" in exact._repr_html_()
    a = sp.Symbol("a")
    assert diophantine([1, a], [1], [1, 0, 0]).Y == (a**2,)


@pytest.mark.parametrize("seed", range(20))
def test_random_equations_and_their_other_solutions(seed):
    rng = np.random.default_rng(seed)
    A, B = rng.normal(size=rng.integers(1, 7)), rng.normal(size=rng.integers(1, 7))
    C, T = rng.normal(size=rng.integers(1, 12)), rng.normal(size=3)
    for least in ("X", "Y"):
        found = diophantine(A, B, C, least)
        assert found.residual < 1e-13
        left = np.polysub(total(A, *found.with_free(T)[:1], B, found.with_free(T)[1]), C)
        assert np.abs(left).max() < 1e-11 * found.condition
        assert len(found.Y if least == "Y" else found.X) <= max(len(A if least == "Y" else B) - 1, 1)


def test_a_shared_factor_in_floats():
    found = diophantine(np.poly([-1.0, -2.0]), np.poly([-1.0, -3.0]), np.poly([-1.0, 0.0, 0.0]))
    assert (
        np.allclose(found.common, [1, 1])
        and np.abs(np.polysub(total([1, 2], found.X, [1, 3], found.Y), [1, 0, 0])).max() < 1e-12
    )
    with pytest.raises(PolynomialEquationError, match="does not divide C"):
        diophantine([1.0, 3, 2], [1, 4, 3], [1, 5])
    with pytest.raises(PolynomialEquationError, match="does not divide C"):
        diophantine([1, 3, 2], [1, 4, 3], [1, 5])
    for wrong, says in (
        (([1.0], ["x"], [1]), "B = "),
        (([0.0], [0.0], [1]), "both zero"),
        (([0.0], [1.0], [1]), "division"),
    ):
        with pytest.raises(PolynomialEquationError, match=says):
            diophantine(*wrong)
    with pytest.raises(PolynomialEquationError, match="X or Y"):
        diophantine([1.0], [1], [1], "Z")


def test_place_cancels_a_factor_that_p_contains():
    """A = (1 - 0.5/z)(1 - 0.4/z), B = (1 - 0.5/z)/z: with 0.5 among the poles the rest is placed, else refused."""
    A, B, wanted = with_zeros([0.5, 0.4]), np.convolve([0, 1], [1, -0.5]), [0.5, 0.3, 0.2]
    found = place_numerically(B, A, with_zeros(wanted), 1.0)
    r = found.regulator
    closed = np.polynomial.polynomial.polyadd(np.convolve(A, r.R), np.convolve(B, r.S))
    assert np.allclose(np.sort(zeros_of(closed).real)[-3:], np.sort(wanted), atol=1e-9) and found.residual < 1e-14
    with pytest.raises(PlacementError, match="which P does not contain"):
        place_numerically(B, A, with_zeros([0.3, 0.3, 0.2]), 1.0)
    pair = with_zeros([0.5 + 0.3j, 0.5 - 0.3j])
    twice = place_numerically(
        np.convolve([0, 1], pair), np.convolve(pair, [1, -0.8]), np.convolve(pair, with_zeros([0.2, 0.2])), 1.0
    )
    assert twice.residual < 1e-13


def test_the_symbolic_and_the_numeric_place_agree_on_a_shared_factor():
    from derivations.algebra.delay_polynomials import coefficients, polynomial
    from derivations.pole_placement import diophantine as symbolic

    q = sp.Rational
    A, B, P = ([1, -q(9, 10), q(1, 5)], [0, 1, -q(1, 2)], [1, -1, q(31, 100), -q(3, 100)])  # P: 0.5, 0.3, 0.2
    design = symbolic.place_exactly(polynomial(A), polynomial(B), polynomial(P), symbolic.integrators(1))
    numeric = place_numerically(*([float(c) for c in row] for row in (B, A, P)), 1.0).regulator
    assert np.allclose(numeric.S, [float(c) for c in coefficients(design.D)], rtol=1e-12)
    assert np.allclose(numeric.R, [float(c) for c in coefficients(design.C)], rtol=1e-12)


def test_continuous_placement_puts_the_poles_there():
    P, wanted, observed = Process([1, 2], [1, 3, 2, 1]), [-1, -1.5, -2 + 1j, -2 - 1j], [-3, -4]
    found = place_continuous(P, wanted, observer=observed)
    loop = Loop(P, found.regulator)
    closed = np.sort_complex(np.asarray(poles(loop)))
    assert np.allclose(closed, np.sort_complex(np.array([*wanted, *observed])), atol=1e-8)
    assert loop.final_values("reference")[0] == pytest.approx(1) and loop.final_values("load")[0] == 0
    to_y = loop.closed("reference", "y")
    assert to_y(0.3 + 1j) == pytest.approx(
        complex(np.polyval(P.num, 0.3 + 1j) / np.polyval(np.real(np.poly(wanted)), 0.3 + 1j))
        * np.real(np.poly(wanted))[-1]
        / P.num[-1],
        rel=1e-9,
    ), "the observer's poles are not seen by the reference"
    assert lb.place(P, wanted, observer=observed).regulator == found.regulator


def test_continuous_placement_in_numbers_is_that_in_letters():
    a, b, w, zeta, ao = 0.7, 2.0, 3.0, 0.6, 5.0
    s = sp.Symbol("s")
    letters = in_letters(s * (s + sp.Rational(7, 10)), 2, s**2 + sp.Rational(18, 5) * s + 9, observer=s + 5, s=s)
    root = w * (-zeta + 1j * np.sqrt(1 - zeta**2))
    numbers = place_continuous(
        Process([b], [1, a, 0]), [root, root.conjugate()], observer=[-ao], integrators=0
    ).regulator
    for name in "RST":
        expected = [float(c) for c in sp.Poly(getattr(letters, name), s).all_coeffs()]
        assert np.allclose(getattr(numbers, name), expected, rtol=1e-12), name


@pytest.mark.parametrize(
    ("process", "options", "says"),
    [
        (Process([1], [1, 1], 2), {"poles": -1}, "dead time"),
        (Process([1], [1, 1]), {"poles": [-1]}, "needs 2 or more"),
        (Process([1], [1, 1]), {"poles": [-1, 1]}, "not stable"),
        (Process([1], [1, 1]), {"poles": [-1, -1 + 1j]}, "conjugate pairs"),
        (Process([1, 0], [1, 2, 1]), {"poles": -1, "integrators": 0}, "blocks constant inputs"),
        (Process([1, 1], [1, 3, 2]), {"poles": -3}, "share the factor"),
    ],
)
def test_what_cannot_be_placed_is_said(process, options, says):
    with pytest.raises(PlacementError, match=says):
        place_continuous(process, **options)


def test_a_plant_in_z_is_placed_like_a_sampled_one():
    sampled = lb.sample(lb.tf(2, [5, 1], 1.5), 1.0)
    plant = lb.DiscreteProcess.of(sampled)
    assert lb.place(plant, 0.6).regulator == lb.place(sampled, 0.6).regulator
