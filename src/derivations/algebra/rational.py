"""Rational expressions, exactly and at once: is one zero, and what solves an equation that is linear in an unknown.

SymPy's `simplify` and `solve` try many rules that a ratio of polynomials does not need. Here such an expression becomes
one fraction; it is zero where its multiplied-out numerator is, and a linear equation is solved by its coefficients.
"""

from sympy import Expr, Mul, S, expand, factor, fraction, simplify, together
from sympy.core.function import AppliedUndef

from derivations.errors import LoopbookError


class NotLinear(LoopbookError):
    """An equation is not linear in the unknown, or does not hold it. Attributes: left, right, unknown."""

    def __init__(self, left: Expr, right: Expr, unknown: Expr):
        self.left, self.right, self.unknown = left, right, unknown
        super().__init__(f"{left} = {right} must be linear in {unknown}; for other equations use sympy.solve")


def _numerator(expr: Expr) -> Expr:
    return expand(fraction(together(expr))[0])


def _is_rational(expr: Expr) -> bool:
    """Only + - * / and whole powers of symbols, samples such as y(t_k), and rational numbers."""
    if expr.is_Add or expr.is_Mul:
        return all(_is_rational(part) for part in expr.args)
    if expr.is_Pow:
        return expr.exp.is_Integer and _is_rational(expr.base)
    return expr.is_Symbol or expr.is_Rational or isinstance(expr, AppliedUndef)


def vanishes(expr: Expr) -> bool:
    """Is the expression zero for all values of its symbols?

    Exact for rational expressions. Where roots, exponentials and the like remain that do not cancel as they stand,
    `sympy.simplify` decides: then True is a proof, and False says that it found none.

    >>> from sympy.abc import x, y
    >>> vanishes(1 / x - y / (x * y)), vanishes(1 / x - 1 / y)
    (True, False)
    """
    numerator = _numerator(expr)
    return numerator == 0 or (not _is_rational(numerator) and simplify(expr) == 0)


def factored(expr: Expr) -> Expr:
    """One fraction in lowest terms and in factors, without a minus sign before a bracket.

    >>> from sympy.abc import a, b, x
    >>> factored((x - x**2) / (a * x + b * x)), factored(b / a - 1)
    ((1 - x)/(a + b), (-a + b)/a)
    """
    expr = factor(expr)
    sign, rest = expr.as_coeff_Mul()
    sums = [part for part in Mul.make_args(rest) if part.is_Add]
    return -sign * (rest / sums[0]) * expand(-sums[0]) if sign < 0 and sums else expr


def solved_for(unknown: Expr, left: Expr, right: Expr = S.Zero) -> Expr:
    """The unknown (a symbol or a sample) of left = right, an equation that is linear in it; `factored`.

    Symbols stand for generic values: the solution holds where its denominator is not zero.
    Raises NotLinear where the equation, cleared of fractions, is not linear in the unknown or does not hold it.

    >>> from sympy.abc import a, b, x
    >>> solved_for(x, a * x, b - x)
    b/(a + 1)
    """
    numerator = _numerator(left - right)
    slope = numerator.coeff(unknown)
    rest = expand(numerator - slope * unknown)
    if slope == 0 or rest.has(unknown) or slope.has(unknown):
        raise NotLinear(left, right, unknown)
    return factored(-rest / slope)
