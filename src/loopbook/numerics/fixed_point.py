"""Matrix exponentials and characteristic polynomials in whole numbers: as many digits as a cancellation will cost.

A number x stands as the integer round(x 2^bits); a matrix as an object array of such integers.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np


@dataclass(frozen=True)
class FixedPoint:
    """Arithmetic with `bits` binary places.

    >>> half = FixedPoint(64).matrix([[Fraction(1, 2)]])
    >>> float(FixedPoint(64).floats(FixedPoint(64).exponential(half))[0, 0])
    1.6487212707001282
    """

    bits: int

    def matrix(self, rows: Sequence[Sequence[Fraction]]) -> np.ndarray:
        return np.array([[round(x * 2**self.bits) for x in row] for row in rows], dtype=object)

    def identity(self, n: int) -> np.ndarray:
        return np.array([[(i == j) << self.bits for j in range(n)] for i in range(n)], dtype=object)

    def product(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (a @ b) >> self.bits

    def floats(self, a: np.ndarray) -> np.ndarray:
        return np.array([float(Fraction(x, 2**self.bits)) for x in a.ravel()]).reshape(a.shape)

    def exponential(self, a: np.ndarray) -> np.ndarray:
        """exp of a matrix, by Taylor's series of a/2^k and k squarings."""
        largest = max(sum(abs(x) for x in row) for row in a)
        halvings = max(0, largest.bit_length() - self.bits)
        small = a >> halvings
        total, term, k = self.identity(len(a)), self.identity(len(a)), 0
        while term.any():
            k += 1
            term = self.product(term, small) // k
            term = np.where((term == -1), 0, term)  # rounding downwards ends at -1, never at 0
            total = total + term
        for _ in range(halvings):
            total = self.product(total, total)
        return total

    def characteristic(self, a: np.ndarray) -> list[int]:
        """Coefficients of det(z - a) from z^n down, by Faddeev and LeVerrier."""
        n = len(a)
        found, m = [1 << self.bits], self.identity(n)
        for k in range(1, n + 1):
            m = self.product(a, m)
            found.append(-int(np.trace(m)) // k)
            m = m + self.identity(n) * found[-1] // (1 << self.bits)
        return found
