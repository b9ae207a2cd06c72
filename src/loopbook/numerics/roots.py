"""How many roots of a real polynomial lie in the right half plane, certain also where its roots are ill-conditioned.

Computed roots are the exact roots of a polynomial nearby. As long as that one departs from the given one by less than
the given one's own size along the imaginary axis, both have as many roots on the right (Rouché). Where this cannot be
shown, the count is done in whole numbers.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

ROUNDING = 1e-12
DOUBTFUL = 1e-2


def clearly_left(p: list[float]) -> bool:
    """Do all roots lie to the left, by Routh's array, with no difference in it small enough to be doubted?

    >>> clearly_left([1.0, 3.0, 3.0, 1.0]), clearly_left([1.0, 1.0, 1.0, 1.0 - 1e-9])
    (True, False)
    """
    if not p[0] or min(c / p[0] for c in p) <= 0:
        return False
    above, row = [c / p[0] for c in p[::2]], [c / p[0] for c in p[1::2]]
    while row:
        factor, below = above[0] / row[0], []
        for a, b in zip(above[1:], [*row[1:], 0.0], strict=False):
            below.append(a - factor * b)
            if below[-1] <= DOUBTFUL * a:
                return False
        above, row = row, below
    return True


def undecided(p: np.ndarray, width: np.ndarray, roots: np.ndarray, border: float) -> tuple[float | None, bool]:
    """(w where p(jw) vanishes within rounding, None if nowhere; whether the computed roots count rightly).

    p: descending coefficients. width: what each is made of in size, so that its rounding is a fraction of that.
    border: |Re r|/|r| of a root on the axis.
    """
    if not roots.size:
        return None, True
    w = np.concatenate([abs(roots.imag), abs(roots)])
    room = np.polyval(width, w)  # zero where p(0) = 0: a root at the origin
    least = np.abs(np.polyval(p, 1j * w)) / np.where(room, room, 1.0)
    near = np.append(abs(roots.real) <= border * abs(roots), np.zeros(len(roots), dtype=bool))
    on_axis = np.flatnonzero((near | (least <= ROUNDING)) & (np.arange(len(w)) < len(roots)))
    if on_axis.size:
        return float(w[on_axis[0]]), False
    back = np.real(np.poly(roots)) * p[0]
    return None, bool((abs(back - p) <= least.min() / 4 * width).all())


def count_right(p: Sequence[float]) -> int:
    """The number of roots with a positive real part, exact for these coefficients; none may lie on the axis.

    By the Cauchy index of the odd over the even part along the axis, with Euclid's algorithm in fractions. Factors that
    both parts share have roots symmetric to the axis: half of those that are not on it lie to the right.

    >>> count_right([1.0, 1.0, 1.0, 2.0]), count_right([1.0, 3.0, 3.0, 1.0]), count_right([1.0, 0.0, 0.0, 0.0, 4.0])
    (2, 0, 2)
    """
    c = [Fraction(float(x)) for x in p]
    while not c[-1]:
        c.pop()
    n = len(c) - 1
    # p(jw)/j^n = f(w) - j g(w) with real f, g of degree n and n - 1
    f = [(-1) ** (i // 2) * x if i % 2 == 0 else Fraction(0) for i, x in enumerate(c)]
    g = _stripped([(-1) ** (i // 2) * x if i % 2 else Fraction(0) for i, x in enumerate(c)])
    chain = _chain(f, g)
    shared = len(chain[-1]) - 1
    turned = _variations(chain, -1) - _variations(chain, 1)  # the Cauchy index of g/f
    if not shared:
        return (n - turned) // 2
    common = chain[-1]
    real = _chain(common, _stripped([x * (shared - i) for i, x in enumerate(common)][:-1]))
    on_axis = _variations(real, -1) - _variations(real, 1)
    if on_axis:
        raise ValueError("a root lies on the imaginary axis")
    return (n - turned) // 2


def _stripped(p: list[Fraction]) -> list[Fraction]:
    while len(p) > 1 and not p[0]:
        p = p[1:]
    return p


def _chain(f: list[Fraction], g: list[Fraction]) -> list[list[Fraction]]:
    """Sturm's chain of f, g: each the negative remainder of the two before; the last one is their common factor."""
    chain = [f]
    while any(g):
        chain.append(g)
        rest = list(f)
        while len(rest) >= len(g) and any(rest):
            factor = rest[0] / g[0]
            rest = [a - factor * b for a, b in zip(rest, g + [Fraction(0)] * (len(rest) - len(g)), strict=True)][1:]
        f, g = g, _stripped([-x for x in rest] or [Fraction(0)])
    return chain


def _variations(chain: list[list[Fraction]], side: int) -> int:
    """The changes of sign along the chain at w = side * infinity."""
    signs = [p[0] if side > 0 or len(p) % 2 else -p[0] for p in chain]
    return sum(a * b < 0 for a, b in pairwise(signs))
