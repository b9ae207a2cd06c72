"""A X + B Y = C exactly: printed solutions, every other solution, letters, and where there is none."""

import pytest
import sympy as sp

from derivations.errors import LoopbookError
from derivations.pole_placement.polynomial_equation import NoSolution, place_continuous, solve

s = sp.Symbol("s")


def row(p):
    return p.all_coeffs()


def test_the_printed_solutions():
    R = sp.Rational
    first = solve([1, 0, -10, 0, 9], [1, 0, -4], [1, 8, 22, 24, 9])
    assert row(first.X) == [R(-56, 15), R(-113, 15)]
    assert row(first.Y) == [R(56, 15), R(128, 15), R(-72, 5), R(-96, 5)]
    second = solve([1, 2, -13, -14, 24], [1, -1, -2], [1, 8, 22, 24, 9])  # C contains the factor s + 1 of B
    assert row(second.X) == [R(-25, 8), R(-25, 8)]
    assert row(second.Y) == [R(25, 8), R(27, 2), R(-53, 8), -42]


@pytest.mark.parametrize("least", ["X", "Y"])
def test_every_solution_solves_it_and_the_least_is_least(least):
    a, b, c = sp.symbols("a b c")
    A, B, C = [1, a, 2], [b, 1], [1, 2, 3, 4, c]
    found = solve(A, B, C, least)
    for T in (0, 1, s + c):
        X, Y = found.solution(T)
        assert sp.cancel(sp.Poly(A, s).as_expr() * X + sp.Poly(B, s).as_expr() * Y - sp.Poly(C, s).as_expr()) == 0
    assert (found.Y.degree() < 2) if least == "Y" else (found.X.degree() < 1)


def test_a_common_factor_is_cancelled_where_c_contains_it():
    found = solve(
        row(sp.Poly((s + 1) * (s + 2), s)), row(sp.Poly((s + 1) * (s + 3), s)), row(sp.Poly((s + 1) * s**2, s))
    )
    assert found.common.as_expr() == s + 1
    assert sp.expand((s + 2) * found.X.as_expr() + (s + 3) * found.Y.as_expr()) == s**2
    assert found.Y.degree() < 1
    with pytest.raises(NoSolution, match=r"share the factor s \+ 1") as error:
        solve([1, 3, 2], [1, 4, 3], [1, 5])
    assert error.value.factor == s + 1


def test_a_or_b_zero():
    assert row(solve([1, 1], [0], [1, 3, 2]).X) == [1, 2]
    assert row(solve([0], [1, 1], [1, 3, 2], "X").Y) == [1, 2]
    with pytest.raises(LoopbookError, match="both zero"):
        solve([0], [0], [1])
    with pytest.raises(LoopbookError, match="inexact"):
        solve([1.5], [1], [1])
    with pytest.raises(LoopbookError, match="X or Y"):
        solve([1], [1], [1], "Z")


def test_the_printed_continuous_placement():
    """b/(s(s + a)): r1 = 2 zeta w + ao - a, s0 = (2 ao zeta w + w^2 - a r1)/b, s1 = w^2 ao/b."""
    a, b, w, zeta, ao = sp.symbols("a b omega zeta a_o", positive=True)
    found = place_continuous(s * (s + a), b, s**2 + 2 * zeta * w * s + w**2, observer=s + ao, s=s)
    r1 = 2 * zeta * w + ao - a
    assert sp.expand(found.R - (s + r1)) == 0
    assert sp.cancel(found.S - ((2 * ao * zeta * w + w**2 - a * r1) / b * s + w**2 * ao / b)) == 0
    assert sp.cancel(found.T - w**2 / b * (s + ao)) == 0


def test_an_integrator_in_the_regulator():
    found = place_continuous(s + 1, 2, (s + 3) ** 2, fixed=s, s=s)  # PI: R = s
    assert sp.expand(found.R) == s and sp.expand(found.S * 2) == 5 * s + 9
    with pytest.raises(LoopbookError, match="give 3 poles in all"):
        place_continuous(s**2 + 1, 1, (s + 1) ** 2, s=s)
    with pytest.raises(LoopbookError, match="blocks constant inputs"):
        place_continuous(s**2 + s + 1, s, (s + 1) ** 3, s=s)
