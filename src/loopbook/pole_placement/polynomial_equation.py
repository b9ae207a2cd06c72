"""The polynomial equation A X + B Y = C, exact where its coefficients are exact, else in double precision.

In exact numbers and letters it is `derivations.pole_placement.polynomial_equation`. In floats it is a Sylvester system
of scaled columns, with a common factor of A and B recognised by its roots, divided out, and looked for in C.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from derivations.pole_placement import polynomial_equation as exact
from loopbook.numerics.real_numbers import plain_number
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr

NEAR, DIVIDES = 1e-8, 1e-7


class PolynomialEquationError(LoopbookError):
    """A X + B Y = C has no solution, or its data are no polynomials; the message says which factor or which row."""


@dataclass(frozen=True, repr=False)
class PolynomialSolution(ShortRepr, ShownAsTable):
    """One solution and the way to all others. Rows of descending coefficients; exact ones are fractions or letters.

    X, Y: the solution of least degree. common: gcd(A, B). of_X, of_Y: B/g and A/g: with any polynomial T,
    X + of_X T and Y - of_Y T solve the equation too. condition: of the linear system (1 where it was solved exactly).
    residual: the largest coefficient of A X + B Y - C over that of |A| |X| + |B| |Y|.
    """

    X: tuple[Any, ...]
    Y: tuple[Any, ...]
    common: tuple[Any, ...]
    of_X: tuple[Any, ...]
    of_Y: tuple[Any, ...]
    condition: float = 1.0
    residual: float = 0.0

    def with_free(self, T: Sequence[Any]) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """(X + of_X T, Y - of_Y T) for a row T.

        >>> found = diophantine([1, 1], [1, 2], [1])
        >>> [[int(c) for c in row] for row in found.with_free([1, 0])]
        [[1, 2, -1], [-1, -1, 1]]
        """
        return _added(self.X, _times(self.of_X, T)), _added(self.Y, _times([-c for c in self.of_Y], T))

    def table(self) -> PlainTable:
        """The rows."""
        rows = [["X", _text(self.X)], ["Y", _text(self.Y)], ["all: X +", f"({_text(self.of_X)}) T"]]
        rows += [["all: Y -", f"({_text(self.of_Y)}) T"]]
        if len(self.common) > 1:
            rows.append(["common factor", _text(self.common)])
        return PlainTable(["A X + B Y = C", "descending powers"], rows)


def diophantine(A: Any, B: Any, C: Any, least: str = "Y") -> PolynomialSolution:
    """X and Y with A X + B Y = C: the solution in which Y (or X) has the least degree, and the others from it.

    A, B, C: descending coefficients. Integers, fractions, decimals and SymPy expressions give an exact solution
    (letters stand for generic values); a float among them one in double precision.
    Raises PolynomialEquationError where A and B share a factor that C lacks, with the factor.

    >>> found = diophantine([1, 0, -10, 0, 9], [1, 0, -4], [1, 8, 22, 24, 9])
    >>> print(*found.X), print(*found.Y)
    -56/15 -113/15
    56/15 128/15 -72/5 -96/5
    (None, None)
    """
    if least not in ("X", "Y"):
        raise PolynomialEquationError(f"least = {least!r}: X or Y")
    rows = [_row(p, name) for p, name in ((A, "A"), (B, "B"), (C, "C"))]
    if any(isinstance(c, float) for row in rows for c in row):
        a, b, c = (np.array([float(x) for x in row]) for row in rows)
        return _numeric(a, b, c, least)
    return _exact(rows, least)


def _row(p: Any, name: str) -> list[Any]:
    found = []
    for c in np.atleast_1d(np.asarray(p, dtype=object)).tolist():
        letters = getattr(c, "free_symbols", None)
        try:
            found.append(c if letters else plain_number(c))
        except TypeError:
            if not hasattr(c, "is_number") or not c.is_number or c.is_real is False:
                raise PolynomialEquationError(f"{name} = {p!r}: a row of numbers or expressions is expected") from None
            found.append(c)
    while len(found) > 1 and found[0] == 0:
        found.pop(0)
    if not found:
        raise PolynomialEquationError(f"{name} is empty: a row of coefficients in descending powers is expected")
    return found


def _exact(rows: list[list[Any]], least: str) -> PolynomialSolution:
    import sympy

    def given(c: Any) -> Any:
        return c if isinstance(c, sympy.Basic) else sympy.Rational(Fraction(c).numerator, Fraction(c).denominator)

    try:
        A, B, C = ([given(c) for c in row] for row in rows)
        solved = exact.solve(A, B, C, least)
    except LoopbookError as error:
        raise PolynomialEquationError(str(error)) from None

    def row(p: Any) -> tuple[Any, ...]:
        return tuple(Fraction(int(c.p), int(c.q)) if c.is_Rational else c for c in p.all_coeffs())

    return PolynomialSolution(row(solved.X), row(solved.Y), row(solved.common), row(solved.of_X), row(solved.of_Y))


def _numeric(A: np.ndarray, B: np.ndarray, C: np.ndarray, least: str) -> PolynomialSolution:
    if least == "X":
        other = _numeric(B, A, C, "Y")
        return PolynomialSolution(
            other.Y, other.X, other.common, other.of_Y, other.of_X, other.condition, other.residual
        )
    if not A.any():
        if not B.any():
            raise PolynomialEquationError("A and B are both zero")
        raise PolynomialEquationError(
            "A is zero: what is asked for is C/B, a division; ask for the X of least degree instead"
        )
    common = common_factor(A, B)
    a, b = divided(A, common), divided(B, common) if B.any() else B
    c, rest = np.polydiv(C, common)
    c = np.atleast_1d(c)
    if np.abs(rest).max(initial=0.0) > DIVIDES * np.abs(C).max():
        raise PolynomialEquationError(
            f"A and B share the factor {_text(common)} (descending powers), which does not divide C: no X and Y solve "
            "the equation; cancel it, or put it into C"
        )
    X, Y, condition = sylvester(a, b, c)
    total = _added(_times(A, X), _times(B, Y), [-x for x in C])
    width = _added(_times(np.abs(A), np.abs(X)), _times(np.abs(B), np.abs(Y)))
    residual = float(np.abs(total).max() / np.abs(width).max())
    found = [tuple(p.tolist()) for p in (X, Y, common, b, a)]
    return PolynomialSolution(found[0], found[1], found[2], found[3], found[4], condition, residual)


def common_factor(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The monic factor of the roots that two rows share within 1e-8 of their size."""
    shared, left = [], list(np.roots(q)) if q.any() else []
    scale = max([abs(r) for r in left], default=1.0)
    for root in np.roots(p):
        near = [other for other in left if abs(other - root) <= NEAR * max(abs(root), NEAR * scale)]
        if near:
            left.remove(min(near, key=lambda other: abs(other - root)))
            shared.append(root)
    return np.atleast_1d(np.real(np.poly(np.array(shared))))


def divided(p: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """p/factor, the remainder left out."""
    return np.atleast_1d(np.polydiv(p, factor)[0]) if len(factor) > 1 else p


def sylvester(A: np.ndarray, B: np.ndarray, C: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """X, Y with A X + B Y = C, deg Y < deg A, and the condition number of the system with columns scaled to one."""
    n = len(A) - 1
    degree_X = max(len(C) - 1 - n, len(B) - 2 if n else len(C) - 1, 0)
    size = max(degree_X + n, len(C) - 1) + 1
    columns = [np.pad(A, (size - len(A) - k, k)) for k in range(degree_X, -1, -1)]
    columns += [np.pad(B, (size - len(B) - k, k)) for k in range(n - 1, -1, -1)] if n else []
    matrix = np.array(columns).T
    scale = np.linalg.norm(matrix, axis=0)
    scale[scale == 0] = 1.0
    right = np.pad(C, (size - len(C), 0)).astype(float)
    solution = np.linalg.lstsq(matrix / scale, right, rcond=None)[0]
    solution += np.linalg.lstsq(matrix / scale, right - matrix / scale @ solution, rcond=None)[0]
    solution /= scale
    X, Y = solution[: degree_X + 1], solution[degree_X + 1 :]
    return X, Y if len(Y) else np.zeros(1), float(np.linalg.cond(matrix / scale))


def _times(p: Any, q: Any) -> list[Any]:
    found = [0] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            found[i + j] = found[i + j] + x * y
    return found


def _added(*rows: Any) -> tuple[Any, ...]:
    length = max(map(len, rows))
    total = [0] * length
    for row in rows:
        for i, value in enumerate(row):
            at = length - len(row) + i
            total[at] = total[at] + value
    return tuple(total)


def _text(row: Any) -> str:
    return ", ".join(f"{c:.6g}" if isinstance(c, float) else str(c) for c in row)
