"""Is a loop in z stable? By Schur's and Cohn's recursion, and by the turning of the loop transfer where that is open.

A loop transfer n/d, both in z^-1, has the closed-loop polynomial d + n. Where poles crowd around the unit circle, as
under fast sampling and long dead times, they are counted by the turning of n/d on it, which needs no root of a long
polynomial.
"""

from collections.abc import Callable

import numpy as np

from loopbook.loop.unit_circle import CircleTransfer

BORDER = 1e-9
LONGEST, ROUNDED = 40, 4 * float(np.finfo(float).eps)


def is_stable_in_z(n: np.ndarray, d: np.ndarray, on_circle: Callable[[], CircleTransfer]) -> bool:
    """All zeros of d + n inside the unit circle, also those that n and d share. on_circle: gives n/d there."""
    certain = _inside(row_sum(n, d), float(row_sum(abs(n), abs(d)).max()))
    if certain is not None:
        return certain
    circle = on_circle()
    if not n.any():
        return bool((abs(circle.poles) < 1 - BORDER).all())
    try:
        return circle.roots_outside() == 0
    except ValueError:
        return False


def row_sum(n: np.ndarray, d: np.ndarray) -> np.ndarray:
    """n + d in z^-1, whatever their lengths."""
    total = np.zeros(max(len(n), len(d)))
    total[: len(n)] += n
    total[: len(d)] += d
    return total


def _inside(p: np.ndarray, size: float) -> bool | None:
    """Do all roots lie in the unit circle, by Schur's and Cohn's recursion? None where rounding leaves that open, or
    where the polynomial is long.

    p: descending coefficients; size: what they are made of at most, so that their rounding is a fraction of that.
    """
    if len(p) > LONGEST:
        return None
    row, error = p.tolist(), ROUNDED * size
    while len(row) > 1:
        largest = max(map(abs, row))
        if abs(row[0]) <= error:
            return None
        k = row[-1] / row[0]
        of_k = error * (1 + abs(k)) / (abs(row[0]) - error)
        if abs(abs(k) - 1) <= of_k + ROUNDED:
            return None
        if abs(k) > 1:
            return False
        row = [a - k * b for a, b in zip(row[:-1], row[:0:-1], strict=True)]
        error = error * (1 + abs(k) + of_k) + (of_k + ROUNDED) * largest
    return True
