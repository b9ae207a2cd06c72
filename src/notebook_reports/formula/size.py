"""How large a formula gets when it is multiplied out, known before anybody multiplies."""

from math import ceil, comb, isfinite
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from sympy import Expr

LENGTH = 2000
"""Characters of a text."""
DEPTH = 50
"""Brackets, signs and powers within each other."""
DIGITS = 300
"""Digits of a number, as written or as the power of one."""
EXPONENT = 100
"""Magnitude of a number in an exponent."""
ARGUMENT = 1000
"""Magnitude of a number that a function is taken of."""
TERMS = 10_000
"""Terms of numerator and denominator together."""


class Size(NamedTuple):
    """At most so many terms over and under the line; `to`: raised to a power.

    >>> fraction = Size(2, 1) * Size(1, 1).inverse + Size(1, 3)
    >>> fraction, Size(3, 1).to(4).terms
    (Size(over=7, under=3), 16)
    """

    over: int = 1
    under: int = 1

    @property
    def terms(self) -> int:
        return self.over + self.under

    @property
    def inverse(self) -> "Size":
        return Size(self.under, self.over)

    def __add__(self, other: "Size") -> "Size":  # type: ignore[override]
        return Size(self.over * other.under + other.over * self.under, self.under * other.under)

    def __mul__(self, other: "Size") -> "Size":  # type: ignore[override]
        return Size(self.over * other.over, self.under * other.under)

    def to(self, n: int) -> "Size":
        """A sum of t terms to the power n has comb(t + n - 1, n)."""
        power = Size(comb(self.over + abs(n) - 1, abs(n)), comb(self.under + abs(n) - 1, abs(n)))
        return power if n >= 0 else power.inverse


def magnitude(number: "Expr") -> float:
    """The absolute value of a number of SymPy, infinite where a float cannot hold it."""
    import sympy

    try:
        return float(abs(sympy.N(number, 15)))
    except (OverflowError, TypeError, ValueError):
        return float("inf")


def digits(number: "Expr") -> float:
    """The digits before (or zeros after) the decimal point of a number; at least one, both parts of a fraction."""
    import mpmath
    import sympy

    if number.is_Rational:
        return max(len(str(abs(int(number.p)))), len(str(int(number.q))))
    size = mpmath.mpmathify(abs(sympy.N(number, 15)))
    return max(1.0, abs(float(mpmath.log10(size)))) if size else 1.0


def power(exponent: "Expr") -> float:
    """A whole power at least as far from zero as the exponent; of a symbolic one the largest of its numbers counts.

    >>> from sympy import Rational, Symbol
    >>> power(Rational(-1, 2)), power(Symbol("x") + 3)
    (-1, 3)
    """
    import sympy

    numbers = [exponent] if exponent.is_number else list(exponent.atoms(sympy.Number))
    largest = max([1.0, *(magnitude(n) for n in numbers)])
    whole = ceil(largest) if isfinite(largest) else largest
    return -whole if exponent.could_extract_minus_sign() else whole
