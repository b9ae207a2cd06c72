"""The polynomial equation A X + B Y = C in one variable, solved exactly: every solution, and those of least degree.

With g = gcd(A, B) it has a solution exactly where g divides C. If (X, Y) is one, all are

    X + (B/g) T,    Y - (A/g) T        for every polynomial T,

so one of them has deg Y < deg(A/g), and one deg X < deg(B/g); where deg C < deg A + deg B - deg g they are the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from derivations.errors import LoopbookError

VARIABLE = sp.Symbol("s")


class NoSolution(LoopbookError):
    """gcd(A, B) does not divide C. Attribute: factor, the greatest common divisor."""

    def __init__(self, factor: sp.Expr, C: sp.Expr):
        self.factor = factor
        super().__init__(
            f"A and B share the factor {factor}, which does not divide C = {C}: no X and Y give A X + B Y = C; cancel "
            "the factor, or put it into C"
        )


@dataclass(frozen=True)
class PolynomialEquation:
    """A X + B Y = C with one solution. All are `sympy.Poly` in one variable over the field of their coefficients.

    X, Y: the solution asked for. common: g = gcd(A, B), monic.
    """

    A: sp.Poly
    B: sp.Poly
    C: sp.Poly
    X: sp.Poly
    Y: sp.Poly
    common: sp.Poly

    @cached_property
    def of_X(self) -> sp.Poly:
        """B/g: what may be added to X, times any polynomial T."""
        return self.B.quo(self.common)

    @cached_property
    def of_Y(self) -> sp.Poly:
        """A/g: what must be taken from Y then, times T."""
        return self.A.quo(self.common)

    def solution(self, T: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """The solution with the free polynomial T, as expressions.

        >>> equation = solve([1, 1], [1, 2], [1])
        >>> equation.solution(VARIABLE)
        (s**2 + 2*s - 1, -s**2 - s + 1)
        """
        free = sp.Poly(T, self.A.gen, domain=self.A.domain)
        return (self.X + self.of_X * free).as_expr(), (self.Y - self.of_Y * free).as_expr()


def solve(
    A: Sequence, B: Sequence, C: Sequence, least: str = "Y", variable: sp.Symbol = VARIABLE
) -> PolynomialEquation:
    """X and Y with A X + B Y = C.

    A, B, C: descending coefficients, exact numbers or expressions in other symbols, which stand for generic values.
    least: which of the two has the lowest degree that is possible, "X" or "Y".
    Raises NoSolution where gcd(A, B) does not divide C, LoopbookError where A and B are both zero, and for inexact
    numbers.

    >>> equation = solve([1, 0, -10, 0, 9], [1, 0, -4], [1, 8, 22, 24, 9])
    >>> equation.X.all_coeffs(), equation.Y.all_coeffs()
    ([-56/15, -113/15], [56/15, 128/15, -72/5, -96/5])
    """
    if least not in ("X", "Y"):
        raise LoopbookError(f"least = {least!r}: X or Y")
    rows = [[sp.sympify(c, strict=True) for c in row] for row in (A, B, C)]
    if any(c.has(sp.Float) for row in rows for c in row):
        raise LoopbookError("inexact numbers: an exact solution needs integers, fractions or symbols")
    a, b, c = _over_one_field(rows, variable)
    if a.is_zero and b.is_zero:
        raise LoopbookError("A and B are both zero")
    u, v, common = _bezout(a, b)
    factor = c.quo(common)
    if not (c - factor * common).is_zero:
        raise NoSolution(common.as_expr(), c.as_expr())
    short_a, short_b = a.quo(common), b.quo(common)
    if least == "Y" and not a.is_zero:
        Y = (v * factor).rem(short_a)
        X = (factor - short_b * Y).quo(short_a)
    elif not b.is_zero:
        X = (u * factor).rem(short_b)
        Y = (factor - short_a * X).quo(short_b)
    else:
        X, Y = factor.quo(short_a), b
    X, Y = (sp.Poly([sp.factor(k) for k in p.all_coeffs()], variable, domain=a.domain) for p in (X, Y))
    if not (a * X + b * Y - c).is_zero:
        raise AssertionError("the solution does not satisfy A X + B Y = C")
    return PolynomialEquation(a, b, c, X, Y, common)


def _bezout(a: sp.Poly, b: sp.Poly) -> tuple[sp.Poly, sp.Poly, sp.Poly]:
    """u, v and the monic g = gcd(a, b) with u a + v b = g; one of a and b may be zero."""
    if not (a.is_zero or b.is_zero):
        u, v, g = a.gcdex(b)
        return u, v, g
    zero, other = (a, b) if a.is_zero else (b, a)
    inverse = other.one.quo_ground(other.LC())
    return (zero, inverse, other.monic()) if a.is_zero else (inverse, zero, other.monic())


def _over_one_field(rows: list[list[sp.Expr]], variable: sp.Symbol) -> list[sp.Poly]:
    polys = [sp.Poly(row or [0], variable, field=True) for row in rows]
    first, second = polys[0].unify(polys[1])
    first, third = first.unify(polys[2])
    second, third = second.unify(third)
    return [first, second, third]


@dataclass(frozen=True)
class ContinuousPlacement:
    """A R + B S = P in s with fixed factors in R. R, S, T: of R u = T r - S y, as expressions; R is monic."""

    R: sp.Expr
    S: sp.Expr
    T: sp.Expr
    equation: PolynomialEquation


def place_continuous(
    A: sp.Expr,
    B: sp.Expr,
    P: sp.Expr,
    fixed: sp.Expr = sp.S.One,
    observer: sp.Expr = sp.S.One,
    s: sp.Symbol = VARIABLE,
) -> ContinuousPlacement:
    """The regulator with A R + B S = P A_o of a continuous plant y = (B/A) u, of the least degree of S.

    A, B: polynomials in s. P: what the reference sees, observer: A_o, what it does not. fixed: factors that R must
    have, s for an integrator. T = P(0)/B(0) A_o: the closed loop has static gain one.
    Raises NoSolution, and LoopbookError where S would have a higher degree than R (P A_o is too short: an ideal
    derivative), or B(0) = 0.

    >>> a, b, w, zeta, ao = sp.symbols("a b omega zeta a_o", positive=True)
    >>> s = VARIABLE
    >>> found = place_continuous(s * (s + a), b, s**2 + 2 * zeta * w * s + w**2, observer=s + ao)
    >>> found.R
    -a + a_o + 2*omega*zeta + s
    >>> sp.collect(sp.expand(found.S * b), s)
    a_o*omega**2 + s*(a**2 - a*a_o - 2*a*omega*zeta + 2*a_o*omega*zeta + omega**2)
    """
    rows = [sp.Poly(sp.expand(e), s).all_coeffs() for e in (A * fixed, B, P * observer)]
    above, through, wanted = rows
    equation = solve(above, through, wanted, variable=s)
    R = (equation.X.as_expr() * fixed).expand()
    degree_R, degree_S = sp.degree(R, s), sp.degree(equation.Y.as_expr(), s)
    if R == 0 or degree_S > degree_R:
        needed = 2 * sp.degree(A * fixed, s) - sp.degree(fixed, s) - 1
        raise LoopbookError(
            f"P A_o has degree {len(rows[2]) - 1}: S would have degree {degree_S} and R only {max(degree_R, 0)}, a "
            f"regulator that differentiates; give {needed} poles in all, or more"
        )
    B_0 = sp.cancel(sp.sympify(B, strict=True).subs(s, 0))
    if B_0 == 0:
        raise LoopbookError("B(0) = 0: the plant blocks constant inputs, and no T gives the loop static gain one")
    lead = sp.Poly(R, s).LC()
    T = sp.factor(sp.sympify(P, strict=True).subs(s, 0) / B_0) * observer
    R, S, T = (sp.collect(sp.expand(sp.cancel(e / lead)), s) for e in (R, equation.Y.as_expr(), T))
    return ContinuousPlacement(R, S, T, equation)
