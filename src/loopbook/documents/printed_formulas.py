"""Formulas that the printed data holds as text between backticks, read as mathematics.

    says = "The process is `y(k) = -a_1*y(k-1) + b_3*u(k-3)`."

Names are symbols as written; y, u, r with an argument are signals, k is the integer sample number and z the variable of
the polynomials in z^-1. Several equations are separated by ``;``.
"""

from typing import Any

from notebook_reports.ledger.printed_data import Claim


class FormulaError(ValueError):
    """A claim's text holds no formula between backticks, or one that cannot be read."""


def formulas(claim: Claim) -> list[tuple[Any, Any]]:
    """(left, right) of each equation in the claim's first backticks; right is None for an expression alone.

    A list in square brackets becomes a SymPy Matrix. Raises FormulaError.

    >>> formulas(Claim("", "", "row", "Coefficient of $z^5$: `a_1 + c_1 - 1 = -3*q`"))
    [(a_1 + c_1 - 1, -3*q)]
    """
    parts = claim.says.split("`")
    if len(parts) < 3:
        raise FormulaError(f"{claim.id}: no formula between backticks in {claim.says!r}")
    return [_equation(claim, text) for text in parts[1].split(";")]


def _equation(claim: Claim, text: str) -> tuple[Any, Any]:
    left, equals, right = text.partition("=")
    return _read(claim, left), _read(claim, right) if equals else None


def _read(claim: Claim, text: str) -> Any:
    import sympy

    from derivations.algebra.delay_polynomials import K, Z

    known = {name: sympy.Function(name) for name in "yur"} | {"k": K, "z": Z, "C": sympy.Symbol("C")}
    try:
        value = sympy.sympify(text.strip(), locals=known, rational=True)
    except (sympy.SympifyError, SyntaxError, TypeError) as error:
        raise FormulaError(f"{claim.id}: {text!r} is no formula ({error})") from None
    return sympy.Matrix(value) if isinstance(value, list) else value
