"""Multiple roots of a real polynomial put together again.

Rounding the coefficients of (s + 1)^7 scatters its computed roots by a hundredth around -1, and a unit of time that is
no power of two scatters them otherwise. Roots that lie together are taken as one multiple root where the polynomial
with that root is the given one to rounding: then no computation with these coefficients could tell them apart.
"""

import math
from collections.abc import Sequence
from itertools import combinations

import numpy as np

LINKS = (0.6, 0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-4, 1e-6)
"""How far apart, relative to their size, neighbours in a group may lie: tried in this order, less than the widest."""
ROUNDED = 4 * float(np.finfo(float).eps)
RANGE, REAL = 1e3 * float(np.finfo(float).eps), 1e-9
STEPS = 4


def roots_of(p: Sequence[float]) -> np.ndarray:
    """All roots, complex, multiple ones together; by formula up to the second degree.

    >>> roots_of([1.0, 3.0, 2.0]).real.tolist(), roots_of([1.0, 2.0, 1.0]).real.tolist()
    ([-2.0, -1.0], [-1.0, -1.0])
    """
    if len(p) == 2:
        return np.array([-p[1] / p[0]], dtype=complex)
    if len(p) != 3 or not p[2]:
        return put_together(p, np.roots(p))
    a, half, c = p[0], p[1] / 2, p[2]
    square = half * half - a * c
    if abs(square) <= ROUNDED * max(half * half, abs(a * c)):
        return np.full(2, -half / a, dtype=complex)
    if square < 0:
        pair = complex(-half / a, math.sqrt(-square) / abs(a))
        return np.array([pair, pair.conjugate()])
    large = -half - math.copysign(math.sqrt(square), half)
    return np.array([large / a, c / large], dtype=complex)


def put_together(p: Sequence[float], roots: np.ndarray) -> np.ndarray:
    """The same roots, the scattered ones of a multiple root all at its place.

    p: descending real coefficients; roots: as computed, in conjugate pairs.

    >>> p = np.poly([-1.0, -1.0, -1.0, -1.0, -2.0])
    >>> sorted({complex(r) for r in put_together(p, np.roots(p)).round(12)}, key=abs)
    [(-1+0j), (-2+0j)]
    """
    roots = np.asarray(roots, dtype=complex)
    listed = [r for r in roots.tolist() if r]
    widest = 4 * RANGE ** (1 / max(len(listed), 1))  # rounding scatters no farther
    if not any(abs(a - b) <= widest * abs(a) for a, b in combinations(listed, 2)):
        return roots
    some = roots[roots != 0]
    size, apart = abs(some), abs(some[:, None] - some[None, :])
    given = np.trim_zeros(np.asarray(p, dtype=float), "b")
    width = abs(given[0]) * np.poly(-size)
    found, joined = some, np.arange(len(some))
    for link in (widest, *(link for link in LINKS if link < widest)):
        groups = _groups(apart <= link * size, joined)
        for chosen in (
            [groups, *([group] for group in groups)] if groups else []
        ):  # all at once: neighbours scatter each other
            wanted = joined.copy()
            for group in chosen:
                wanted[group] = group[0]
            refined = _refined(given, some, wanted, width)
            if refined is not None:
                found, joined = refined, wanted
                if chosen is groups:
                    break
    return np.append(found, roots[roots == 0])


def _groups(linked: np.ndarray, joined: np.ndarray) -> list[list[int]]:
    """The indices of roots that are not joined yet, in groups of two and more that links connect."""
    times = np.bincount(joined, minlength=len(joined))
    left, groups = set(np.flatnonzero(times[joined] == 1).tolist()), []
    while left:
        group, front = [], [left.pop()]
        while front:
            i = front.pop()
            group.append(i)
            more = [j for j in left if linked[i, j]]
            left.difference_update(more)
            front += more
        groups.append(sorted(group))
    return [group for group in groups if len(group) > 1]


def _refined(p: np.ndarray, roots: np.ndarray, joined: np.ndarray, width: np.ndarray) -> np.ndarray | None:
    """The roots, equal where joined alike, that give p best (Gauss and Newton); None where not to rounding."""
    heads, member, times = np.unique(joined, return_inverse=True, return_counts=True)
    if len(heads) == len(roots) or not width.all():
        return None
    places = np.array([roots[joined == head].mean() for head in heads])
    for _ in range(STEPS):
        whole = p[0] * np.poly(np.repeat(places, times))
        one_less = (np.repeat(places, times - each) for each in np.eye(len(places), dtype=int))
        slopes = [np.append(0.0, -m * p[0] * np.poly(rest)) for m, rest in zip(times, one_less, strict=True)]
        if not np.isfinite(whole).all():
            return None
        places = places + np.linalg.lstsq((np.array(slopes) / width).T, (p - whole) / width, rcond=None)[0]
    back = p[0] * np.poly(np.repeat(places, times))
    if (abs(back - p) > ROUNDED * len(roots) * width).any():
        return None
    partner = abs(places.conj()[:, None] - places[None, :]).argmin(axis=1)
    places = (places + places[partner].conj()) / 2
    places = np.where(abs(places.imag) <= REAL * abs(places), places.real, places)
    return places[member]
