"""All zeros of a sum of polynomials times exponentials in a half plane or a box: found, and counted to be all.

`spectral_roots` says where they are nearly, Newton's method where exactly, and the argument principle
(`argument_principle`) how many there must be. What is returned agrees with the count; else nothing is.

    f(s) = p_0(s) + p_1(s) exp(-d_1 s) + ...        0 < d_1 < ...,  no p_k of a higher degree than p_0

The zeros right of a line lie in a bounded box, unless the terms of the highest degree make a chain of them (a neutral
equation): then there are infinitely many, and that is said.
"""

import math
from typing import NamedTuple

import numpy as np

from loopbook.numerics.argument_principle import BoundaryError, Rectangle, zeros_around, zeros_inside
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial, characteristic_time_of
from loopbook.numerics.multiple_roots import put_together
from loopbook.numerics.right_half_plane import RootsError, chain, half_plane
from loopbook.numerics.spectral_roots import DelaySpectrum

WIDER = 1e-8
SAME, CLUSTER, NOTHING = 1e-6, 1e-3, 1e-13
CONVERGED = 1e-12
REACH = 16.0
STEPS = 60
SETTLED = 10  # steps after which a start that led anywhere is close
MOST_STRIPS = 4000
SIX = 6


class Zeros(NamedTuple):
    """values: distinct zeros, the rightmost first, those of a pair side by side. multiplicity: of each."""

    values: np.ndarray
    multiplicity: np.ndarray


def zeros_in(
    f: ExponentialPolynomial, right_of: float | None = None, box: Rectangle | None = None
) -> tuple[Zeros, Rectangle]:
    """The zeros of f and the box that holds them.

    right_of [1/s]: those with Re s >= right_of (the box then has infinite sides); box [1/s]: those in it; neither: the
    rightmost six or so. A zero within 1e-8 of the boundary counts as inside. Raises RootsError.

    >>> f = ExponentialPolynomial.of([1.0, 0.0]) + ExponentialPolynomial.of([np.pi / 2], 1.0)
    >>> found, _ = zeros_in(f, right_of=-1.0)
    >>> bool(np.allclose(found.values, [np.pi / 2 * 1j, -np.pi / 2 * 1j]))
    True
    """
    if f.is_zero:
        raise RootsError("the equation is zero everywhere: every s is a root")
    f = f.delayed(-f.delays[0])
    time = characteristic_time_of(f)
    inside = f.in_units(time)
    inside = inside * (1 / max(abs(c) for _, p in inside.terms for c in p))
    if not inside.degree + (len(inside.terms) > 1):
        return Zeros(np.zeros(0, complex), np.zeros(0, int)), box or Rectangle(-math.inf, math.inf, -math.inf, math.inf)
    if len(inside.terms) == 1:
        return _rational(inside, right_of, box, time)
    if len(inside.terms[0][1]) - 1 < inside.degree:
        return _advanced(f, box)
    spectrum = DelaySpectrum(inside)
    if box is not None:
        region = box.scaled(time)
    elif right_of is not None:
        region = half_plane(inside, right_of * time, time)
    else:
        region, right_of = _of_the_rightmost(inside, spectrum, time)
    found = _all_in(inside, spectrum, region)
    searched = box or region.scaled(1 / time)
    if right_of is not None:
        searched = Rectangle(right_of, math.inf, -math.inf, math.inf)
    return Zeros(found.values / time, found.multiplicity), searched


def _rational(
    f: ExponentialPolynomial, right_of: float | None, box: Rectangle | None, time: float
) -> tuple[Zeros, Rectangle]:
    """Of a polynomial: what of its roots lies in the region; those that rounding split are one."""
    region = box or Rectangle(-math.inf if right_of is None else right_of, math.inf, -math.inf, math.inf)
    row = f.terms[0][1]
    values, multiplicity = np.unique(put_together(row, np.roots(row)), return_counts=True)
    kept = region.holds(values / time)
    return _sorted(values[kept].astype(complex) / time, multiplicity[kept]), region


def _advanced(f: ExponentialPolynomial, box: Rectangle | None) -> tuple[Zeros, Rectangle]:
    """In a box, by the mirror image f(-s) exp(-d s), whose first term is the last one of f."""
    if box is None or len(f.terms[-1][1]) - 1 < f.degree:
        raise RootsError(
            "a delayed term has a higher power of s than the one without delay: there are roots with real parts beyond "
            "all bounds (of a loop: one that cannot be built); ask for those in a box"
        )
    found, region = zeros_in(f.mirrored(), box=Rectangle(-box.right, -box.left, -box.top, -box.bottom))
    return _sorted(-found.values, found.multiplicity), Rectangle(
        -region.right, -region.left, -region.top, -region.bottom
    )


def _of_the_rightmost(f: ExponentialPolynomial, spectrum: DelaySpectrum, unit: float) -> tuple[Rectangle, float | None]:
    """Half a plane with six zeros in it, or all where there are no more, as a box and its left side [1/s]."""
    near = _newton(f, spectrum.near(0, 48))
    real = np.sort(_distinct(near, _width(f)).real)[::-1]
    line = chain(f)
    real = real[real > line + 1e-6]
    if not real.size:
        pace = math.pi / max(f.delays)
        return Rectangle(line - pace, line + pace, -SIX * pace, SIX * pace), None
    steps = -np.diff(real[: 2 * SIX])
    after = [i for i in range(min(SIX, len(real)) - 1, len(steps)) if steps[i] > SAME]
    last = after[0] if after else len(real) - 1
    left = (real[last] + real[last + 1]) / 2 if last + 1 < len(real) else real[last] - 0.5
    left = max(float(left), (line + real[last]) / 2)
    return half_plane(f, left, unit), left / unit


def _width(f: ExponentialPolynomial) -> float:
    """What the size of zeros is measured by near the origin."""
    return 1.0 / max(1.0, *f.delays)


def _all_in(f: ExponentialPolynomial, spectrum: DelaySpectrum, region: Rectangle) -> Zeros:
    """The zeros in the region, as many as the argument principle counts."""
    width = _width(f)
    wide = region.widened(WIDER * max(width, *map(abs, region)))
    try:
        count = zeros_inside(f, wide)
    except BoundaryError:
        wide = wide.widened(30 * WIDER * max(width, *map(abs, region)))
        count = zeros_inside(f, wide)
    if not count:
        return Zeros(np.zeros(0, complex), np.zeros(0, int))
    for points in (32, 64, 128):
        found = _search(f, spectrum, wide, count, points)
        found = _merged(f, found, width) if len(found) == count else found
        if len(found) == count:
            return _sorted(found, np.ones(len(found), int))
        multiplicity = np.array([_multiplicity(f, s, found, width) for s in found], dtype=int)
        if multiplicity.sum() == count:
            polished = [_polished(f, s, int(m)) for s, m in zip(found, multiplicity, strict=True)]
            return _sorted(np.array(polished), multiplicity)
    raise RootsError(f"{count} roots lie in the region, {len(found)} of them could be told: ask for a smaller region")


def _search(f: ExponentialPolynomial, spectrum: DelaySpectrum, box: Rectangle, count: int, points: int) -> np.ndarray:
    """Distinct zeros in the box, strip after strip from the real axis upwards, until they are as many as counted."""
    step = REACH * points / 32 / float(spectrum.delays.max())
    nearest = min(max(0.0, box.bottom), box.top) if box.bottom * box.top > 0 else 0.0
    found = np.zeros(0, complex)
    strips = math.ceil((max(abs(box.bottom), abs(box.top)) - abs(nearest)) / step) + 1
    for k in range(min(strips, MOST_STRIPS)):
        centre = 1j * (abs(nearest) + k * step) + (min(max(0.0, box.left), box.right) if k or nearest else 0.0)
        more = _newton(f, spectrum.near(centre, points))
        both = np.concatenate([found, more, more.conj()])
        found = _distinct(both[box.holds(both)], _width(f))
        if len(found) >= count:
            break
    return found


def _newton(f: ExponentialPolynomial, s: np.ndarray) -> np.ndarray:
    """The zeros to which Newton's method leads; of what does not converge, nothing."""
    slope = f.derivative()
    s = np.asarray(s, dtype=complex)
    longest = max(f.delays)
    done = np.zeros(0, complex)
    with np.errstate(all="ignore"):
        for step in range(STEPS):
            change = f(s) / slope(s)
            change = np.where(np.abs(change) > 2 / (longest + 1e-3), 2 / (longest + 1e-3) * np.sign(change), change)
            after = s - change
            still = np.isfinite(after)
            small = still & (np.abs(change) <= CONVERGED * np.maximum(np.abs(after), 1e-6 / (longest + 1)))
            done = np.append(done, after[small])
            astray = np.abs(change) > 0.5 / (longest + 1e-3) if step == SETTLED else small
            s = after[still & ~small & ~astray]
            if not s.size:
                break
        flat = s[np.abs(f(s) / slope(s)) < 1e-7 * np.maximum(np.abs(s), 1.0 / (longest + 1))]  # multiple zeros
    return np.append(done, flat)


def _distinct(s: np.ndarray, width: float) -> np.ndarray:
    """Each zero once; those within rounding of the real axis on it."""
    s = np.where(np.abs(s.imag) <= 1e-11 * np.maximum(np.abs(s), width), s.real + 0j, s)
    kept: list[complex] = []
    for value in s[np.lexsort((s.imag, s.real))].tolist():
        near = SAME * max(abs(value), width)
        if not any(abs(value - other) <= near for other in kept[-40:]):
            kept.append(value)
    return np.array(kept, dtype=complex)


def _merged(f: ExponentialPolynomial, found: np.ndarray, width: float) -> np.ndarray:
    """Zeros so near each other that rounding may have split a multiple one are one, where f says so."""
    kept = found
    for s in found:
        near = np.abs(kept - s) <= CLUSTER * max(abs(s), width)
        if near.sum() > 1:
            m = int(near.sum())
            middle = _polished(f, complex(kept[near].mean()), m)
            if _vanishes(f, middle, m):
                kept = np.append(kept[~near], middle)
    return kept


def _vanishes(f: ExponentialPolynomial, s: complex, order: int) -> bool:
    """Are f and its derivatives below `order` nothing but rounding at s?"""
    for _ in range(order):
        size = sum(np.polyval(np.abs(p), abs(s)) * abs(np.exp(-delay * s)) for delay, p in f.terms)
        if abs(f(s)) > NOTHING * size:
            return False
        f = f.derivative()
    return True


def _multiplicity(f: ExponentialPolynomial, s: complex, found: np.ndarray, width: float) -> int:
    others = np.abs(found - s)
    nearest = float(others[others > 0].min(initial=np.inf))
    return zeros_around(f, s, min(1e-3 * max(abs(s), width), nearest / 3))


def _polished(f: ExponentialPolynomial, s: complex, multiplicity: int) -> complex:
    """A zero of order m is a simple one of the derivative of order m - 1."""
    for _ in range(multiplicity - 1):
        f = f.derivative()
    found = _newton(f, np.array([s]))
    return complex(found[0]) if multiplicity > 1 and found.size and abs(found[0] - s) < 1e-2 * (abs(s) + 1) else s


def _sorted(values: np.ndarray, multiplicity: np.ndarray) -> Zeros:
    order = np.lexsort((-values.imag, np.abs(values.imag), -np.round(values.real, 9)))
    return Zeros(values[order], multiplicity[order])
