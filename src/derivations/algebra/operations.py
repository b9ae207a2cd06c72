"""Counting what a processor has to do for an expression as it is written.

Source: the captions of pid-report, figures 4.9 to 4.13, which count the operations between reading y and setting u.
"""

from dataclasses import dataclass

from sympy import Expr, Pow


@dataclass(frozen=True)
class Operations:
    """Numbers of multiplications, subtractions, additions and divisions."""

    multiplications: int = 0
    subtractions: int = 0
    additions: int = 0
    divisions: int = 0

    def __add__(self, other: "Operations") -> "Operations":
        return Operations(*(a + b for a, b in zip(self.counts, other.counts, strict=True)))

    @property
    def counts(self) -> tuple[int, int, int, int]:
        return self.multiplications, self.subtractions, self.additions, self.divisions

    @property
    def total(self) -> int:
        return sum(self.counts)


def operations(expr: Expr) -> Operations:
    """Operations of one expression: a negative term of a sum is a subtraction, min and max cost nothing here.

    >>> from sympy.abc import a, b, x, y
    >>> operations(a * (b * x - y)).counts
    (2, 1, 0, 0)
    """
    below = sum((operations(part) for part in expr.args), Operations())
    if expr.is_Add:
        negative = sum(part.could_extract_minus_sign() for part in expr.args)
        signs = min(negative, len(expr.args) - 1)
        return below + Operations(subtractions=signs, additions=len(expr.args) - 1 - signs)
    if expr.is_Mul:
        factors = [f for f in expr.args if f != -1]
        divisors = sum(isinstance(f, Pow) and f.exp == -1 for f in factors)
        return below + Operations(max(len(factors) - divisors - 1, 0), divisions=divisors)
    return below
