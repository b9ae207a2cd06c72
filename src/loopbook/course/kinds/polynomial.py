"""A polynomial, as its coefficients or as a formula in its variable."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from loopbook.course.errors import SheetError, Unreadable
from loopbook.course.kinds.kind import finite_number, real_number, shown_number
from loopbook.course.tolerance import Tolerance
from notebook_reports.formula.read import FormulaError, read_formula

HIGHEST = 30
NOTHING = 1e-9
"""Relative to the largest coefficient: what computing leaves of a zero."""


@dataclass(frozen=True)
class Polynomial:
    """A polynomial in `symbol`; compared coefficient by coefficient, highest power first."""

    tolerance: Tolerance
    symbol: str = "z"
    unit: str = ""

    def key(self, value: Any) -> tuple[float, ...]:
        if hasattr(value, "free_symbols"):
            value = _coefficients(value, self.symbol)
        found = _trimmed([real_number(v, "a coefficient") for v in value])
        if not found:
            raise SheetError("the zero polynomial is no answer")
        return found

    def read(self, raw: Any) -> tuple[float, ...]:
        if raw is None or raw in ("", []):
            raise Unreadable("nothing was written")
        if isinstance(raw, list):
            return _trimmed([finite_number(v) for v in raw])
        if not isinstance(raw, str):
            raise Unreadable(f"a polynomial is asked for: coefficients in square brackets, or a text in {self.symbol}")
        import sympy

        try:
            expression = read_formula(raw, {self.symbol: sympy.Symbol(self.symbol)})
            return _trimmed([finite_number(float(c)) for c in _coefficients(expression, self.symbol)])
        except FormulaError as error:
            raise Unreadable(f"this is no polynomial: at character {error.position + 1}: {error.reason}") from None
        except SheetError as error:
            raise Unreadable(str(error)) from None

    def same(self, given: Sequence[float], key: Sequence[float], widths: float = 1.0) -> bool:
        if len(given) != len(key):
            return False
        scale = 1e-2 * max(map(abs, key))
        return all(self.tolerance.within(g, k, widths, scale) for g, k in zip(given, key, strict=True))

    def handed(self, given: Sequence[float], value: Any) -> Any:
        if not hasattr(value, "free_symbols"):
            return list(given)
        import sympy

        return sympy.Poly(list(given), sympy.Symbol(self.symbol)).as_expr()

    def plain(self, key: Sequence[float]) -> list[float]:
        return list(key)

    def text(self, key: Sequence[float]) -> str:
        parts: list[str] = []
        for power, coefficient in zip(range(len(key) - 1, -1, -1), key, strict=True):
            if abs(coefficient) > NOTHING * max(map(abs, key)):
                x = "" if not power else self.symbol if power == 1 else f"{self.symbol}^{{{power}}}"
                size = shown_number(abs(coefficient), self.tolerance.shown_digits)
                digits = "" if x and abs(coefficient) == 1 else size
                sign = ("- " if parts else "-") if coefficient < 0 else ("+ " if parts else "")
                parts.append(f"{sign}{digits}{x}")
        return f"${' '.join(parts)}$"

    def wants(self) -> str:
        form = f"[...] from the highest power of {self.symbol} on, or a text in {self.symbol}"
        return f"the coefficients {form}; each {self.tolerance}"

    def blank(self) -> str:
        return "[]"

    def numbers(self, key: Sequence[float]) -> list[float]:
        return [c for c in key if abs(c) > NOTHING * max(map(abs, key)) and abs(c) != 1.0]


def _trimmed(coefficients: list[float]) -> tuple[float, ...]:
    first = next((i for i, c in enumerate(coefficients) if c != 0), len(coefficients))
    return tuple(coefficients[first:])


def _coefficients(expression: Any, symbol: str) -> list[Any]:
    import sympy

    letter = sympy.Symbol(symbol)
    try:
        found = sympy.Poly(expression.subs({s: letter for s in expression.free_symbols if s.name == symbol}), letter)
    except sympy.PolynomialError:
        raise SheetError(f"this is no polynomial in {symbol}") from None
    if found.degree() > HIGHEST:
        raise SheetError(f"the power of {symbol} is beyond {HIGHEST}")
    coefficients = found.all_coeffs()
    if any(not c.is_number for c in coefficients):
        raise SheetError(f"the coefficients of {symbol} are numbers")
    return coefficients
