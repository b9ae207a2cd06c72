"""A problem in units of its own: what makes every answer the same for microseconds and for years.

Time is counted in a characteristic time of the problem, gains in a characteristic gain. Both are powers of two, so that
going into these units and coming back rounds nothing. All that is tested, searched or bounded happens inside, between
numbers near one; a tolerance there is a fraction of the problem's own time or gain.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np


def power_of_two(value: float) -> float:
    """The power of two next to a positive number, in ratio; 1 for zero.

    >>> power_of_two(0.3), power_of_two(1000.0), power_of_two(0.0)
    (0.25, 1024.0, 1.0)
    """
    return math.ldexp(1.0, round(math.log2(value))) if value else 1.0


def octaves(p: Sequence[float]) -> list[float]:
    """log2 |root| of the roots of a polynomial that are not zero, within a few octaves: the slopes of Newton's polygon.

    p: descending coefficients. The polygon is the upper hull of log2 |coefficient| over the power.

    >>> octaves([2.0, 2.0, 64.0, 0.0])
    [2.5, 2.5]
    """
    points = [(power, math.log2(abs(c))) for power, c in enumerate(reversed(p)) if c]
    hull: list[tuple[int, float]] = []
    for x, y in points:
        while len(hull) > 1 and (hull[-1][1] - hull[-2][1]) * (x - hull[-2][0]) <= (y - hull[-2][1]) * (
            hull[-1][0] - hull[-2][0]
        ):
            hull.pop()
        hull.append((x, y))
    return [(y - v) / (u - x) for (x, y), (u, v) in pairwise(hull) for _ in range(u - x)]


def characteristic_time(num: Sequence[float], den: Sequence[float], delay: float) -> float:
    """A power of two near the time [s] in which num(s)/den(s) exp(-delay s) moves.

    The median of 1/|root| over the roots of both polynomials that are not zero, so that none that lies far off decides;
    without such a root the dead time; without one the time of the integrators' gain; else 1.

    >>> characteristic_time([2.0], [1e-6, 2e-3, 1.0], 0.0) == 2.0**-10
    True
    """
    found = sorted(octaves(num) + octaves(den))
    if found:
        return math.ldexp(1.0, -round((found[len(found) // 2] + found[(len(found) - 1) // 2]) / 2))
    if delay:
        return power_of_two(delay)
    excess = len(den) - len(num)
    if excess and num[0]:
        return math.ldexp(1.0, round((math.log2(abs(den[0])) - math.log2(abs(num[0]))) / excess))
    return 1.0


def in_units(p: Sequence[float], time: float, gain: float = 1.0) -> tuple[float, ...]:
    """The coefficients of p(s/time)/gain: what p(s) is as a polynomial in s time. Exact for powers of two.

    >>> in_units([1.0, 3.0, 1.0], 0.5)
    (4.0, 6.0, 1.0)
    """
    each, whole = math.frexp(time)[1] - 1, math.frexp(gain)[1] - 1
    n = len(p) - 1
    return tuple(math.ldexp(c, -each * (n - i) - whole) for i, c in enumerate(p))


def ratio_in_units(
    num: Sequence[float], den: Sequence[float], time: float
) -> tuple[tuple[float, ...], tuple[float, ...], float]:
    """num', den' and gain with num(s)/den(s) = gain num'(s time)/den'(s time), the largest coefficients near one."""
    num, den = in_units(num, time), in_units(den, time)
    above, below = size(num), size(den)
    return in_units(num, 1.0, above), in_units(den, 1.0, below), above / below


def size(p: Sequence[float]) -> float:
    """A power of two near the largest coefficient."""
    return power_of_two(max(map(abs, p)))


def rounded_sum(p: Sequence[float], q: Sequence[float]) -> np.ndarray:
    """p + q, a coefficient that is nothing but rounding of two that cancel taken as zero: each by its own size.

    >>> rounded_sum([1.0, 0.1 + 0.2], [-0.3]).tolist()
    [1.0, 0.0]
    """
    a, b = np.zeros(max(len(p), len(q))), np.zeros(max(len(p), len(q)))
    a[len(a) - len(p) :], b[len(b) - len(q) :] = p, q
    total = a + b
    return np.where(abs(total) > CANCELLED * (abs(a) + abs(b)), total, 0.0)


CANCELLED = 8 * float(np.finfo(float).eps)
