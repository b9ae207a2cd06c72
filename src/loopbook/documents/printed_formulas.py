"""Formulas that the printed data holds as text between backticks, read as mathematics.

    says = "The process is `y(k) = -a_1*y(k-1) + b_3*u(k-3)`."

Names are symbols as written; y, u, r with an argument are signals, k is the integer sample number, z the variable of
the polynomials in z^-1, and saturate(v, low, high) limits.
"""

import sympy
from sympy import Expr, MatrixBase, Piecewise

from derivations.algebra.delay_polynomials import K, Z
from notebook_reports.formula.read import Symbols, read_equations
from notebook_reports.ledger.printed_data import Claim


def formulas(claim: Claim) -> list[tuple[Expr | MatrixBase, Expr | MatrixBase | None]]:
    """(left, right) of each equation in the claim's first backticks; right is None for an expression alone.

    Raises PrintedDataError where there are no backticks, FormulaError where what they hold is no formula.

    >>> formulas(Claim("", "", "row", "Coefficient of $z^5$: `a_1 + c_1 - 1 = -3*q`"))
    [(a_1 + c_1 - 1, -3*q)]
    """
    functions = {name: sympy.Function(name) for name in "yur"} | {"saturate": saturate}
    return read_equations(claim.formula, Symbols(k=K, z=Z), functions, where=claim.where)


def saturate(value: Expr, low: Expr, high: Expr) -> Expr:
    """The value within its limits, by cases."""
    return Piecewise((high, value > high), (low, value < low), (value, True))
