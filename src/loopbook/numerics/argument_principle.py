"""How many zeros of a sum of polynomials times exponentials lie inside a box, by the argument principle, certified.

The argument of f is followed around the box. On a piece of the path with the middle m and half the length r,

    |f(m + x) - f(m)| <= |f'(m)| r + R(r)        R: what the Taylor series holds from the second order on, in size

and where that is less than |f(m)|, the argument at the ends is within a right angle of that at m: nothing can turn
unseen. Other pieces are halved. No grid of points decides.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial

ROUNDING = 1e-13
PIECES = 24
MOST_PIECES = 2_000_000


class BoundaryError(LoopbookError):
    """A zero lies on the boundary of the region, within rounding. Attribute: at."""

    def __init__(self, at: complex):
        self.at = at
        super().__init__(f"a root lies on the boundary of the region, near s = {at:.6g}: move the boundary")


class Rectangle(NamedTuple):
    """left <= Re s <= right, bottom <= Im s <= top [1/s]."""

    left: float
    right: float
    bottom: float
    top: float

    def holds(self, s: np.ndarray) -> np.ndarray:
        """Which s lie inside or on the boundary."""
        return (s.real >= self.left) & (s.real <= self.right) & (s.imag >= self.bottom) & (s.imag <= self.top)

    def widened(self, by: float) -> "Rectangle":
        """The same box with each side moved outwards."""
        return Rectangle(self.left - by, self.right + by, self.bottom - by, self.top + by)

    def scaled(self, factor: float) -> "Rectangle":
        """The box of s times a positive factor."""
        return Rectangle(*(side * factor for side in self))


def zeros_inside(f: ExponentialPolynomial, box: Rectangle) -> int:
    """The number of zeros of f inside the box, with multiplicity. Raises BoundaryError for one on its boundary.

    >>> zeros_inside(ExponentialPolynomial.of([1.0, 0.0, 1.0]), Rectangle(-1, 1, -2, 2))
    2
    """
    low, high = complex(box.left, box.bottom), complex(box.right, box.top)
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag), low]
    share = np.linspace(0.0, 1.0, PIECES + 1)
    path = np.concatenate([a + (b - a) * share[:-1] for a, b in pairwise(corners)])
    return round(_turned(f, path, np.append(path[1:], low)) / (2 * np.pi))


def zeros_right(f: ExponentialPolynomial, reach: float) -> int:
    """The number of zeros of f with a positive real part; none of them farther from the origin than `reach`.

    f: its first term, without delay, has the highest power, c s^n. Only the imaginary axis is followed: on the half
    circle from -j reach to j reach the argument of f is that of c s^n within a right angle at both ends. Raises
    BoundaryError for a zero on the axis.

    >>> f = ExponentialPolynomial.of([1.0, 0.0]) + ExponentialPolynomial.of([1.6], 1.0)
    >>> zeros_right(f, 2.0)
    2
    """
    edges = np.concatenate([[0.0], np.geomspace(1e-3 * reach, reach, 4 * PIECES)]) * 1j
    along = _turned(f, edges[:-1], edges[1:])
    n = len(f.terms[0][1]) - 1
    end = complex(f(edges[-1])) / (f.terms[0][1][0] * complex(edges[-1]) ** n)
    return round(n / 2 + (np.angle(end) - along) / np.pi)


def zeros_around(f: ExponentialPolynomial, centre: complex, radius: float) -> int:
    """The number of zeros of f in the square of half the side `radius` around a point."""
    return zeros_inside(
        f, Rectangle(centre.real - radius, centre.real + radius, centre.imag - radius, centre.imag + radius)
    )


def _turned(f: ExponentialPolynomial, a: np.ndarray, b: np.ndarray) -> float:
    total, counted = 0.0, 0
    scale = float(np.abs(a).max())
    while a.size:
        middle, half = (a + b) / 2, np.abs(b - a) / 2
        value, room = variation(f, middle, half)
        proved = room < np.abs(value)
        if proved.any():
            inside = value[proved]
            total += float(np.angle(f(b[proved]) / inside).sum() - np.angle(f(a[proved]) / inside).sum())
        counted += a.size
        a, b, middle = a[~proved], b[~proved], middle[~proved]
        lost = half[~proved] <= ROUNDING * scale
        if lost.any() or counted > MOST_PIECES:
            raise BoundaryError(complex(middle[np.argmin(np.abs(f(middle)))]))
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    return total


def variation(f: ExponentialPolynomial, s: np.ndarray, radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """f(s), and what |f(s + x) - f(s)| cannot exceed for |x| <= radius, rounding of f included."""
    value, slope = np.zeros(s.shape, dtype=complex), np.zeros(s.shape, dtype=complex)
    rest, size = np.zeros(s.shape), np.zeros(s.shape)
    with np.errstate(over="ignore", invalid="ignore"):
        for (delay, _), (turn, c) in zip(f.terms, f.taylor(s), strict=True):
            sizes = np.abs(c) * np.abs(turn)
            first = c[1] - delay * c[0] if len(c) > 1 else -delay * c[0]
            value, slope, size = value + turn * c[0], slope + turn * first, size + sizes[0]
            whole = np.zeros(s.shape)
            for row in sizes[::-1]:
                whole = whole * radius + row
            linear = sizes[0] * (1 + delay * radius) + (sizes[1] * radius if len(c) > 1 else 0.0)
            rest = rest + np.maximum(whole * np.exp(delay * radius) - linear, 0.0)
    return value, np.abs(slope) * radius + rest + ROUNDING * size
