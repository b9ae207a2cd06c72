"""Rational expressions, exactly and at once: is one zero, and what solves an equation that is linear in an unknown.

SymPy's `simplify` and `solve` try many rules that a ratio of polynomials does not need. Here such an expression becomes
one fraction; it is zero where its multiplied-out numerator is, and a linear equation is solved by its coefficients.
"""

from sympy import Eq, Expr, Mul, expand, factor, fraction, simplify, together
from sympy.core.function import AppliedUndef


class NotLinear(ValueError):
    """An equation is not linear in the unknown, or does not hold it. Attributes: equation, unknown."""

    def __init__(self, equation: Eq, unknown: Expr):
        self.equation, self.unknown = equation, unknown
        super().__init__(f"{equation} must be linear in {unknown}: sympy.solve finds the roots of other equations")


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


def solved_for(unknown: Expr, equation: Eq) -> Expr:
    """The unknown (a symbol or a sample) of an equation that is linear in it, `factored`.

    Symbols stand for generic values: the solution holds where its denominator is not zero.
    Raises NotLinear where the equation, cleared of fractions, is not linear in the unknown or does not hold it.

    >>> from sympy.abc import a, b, x
    >>> solved_for(x, Eq(a * x, b - x))
    b/(a + 1)
    """
    numerator = _numerator(equation.lhs - equation.rhs)
    slope = numerator.coeff(unknown)
    rest = expand(numerator - slope * unknown)
    if slope == 0 or rest.has(unknown) or slope.has(unknown):
        raise NotLinear(equation, unknown)
    return factored(-rest / slope)
