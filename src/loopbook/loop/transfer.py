"""The transfer function around a loop, n(s)/d(s) exp(-L s), and its exact magnitude and phase on the imaginary axis.

|n/d| has no dead time in it, so gain crossovers are roots of the polynomial |d|^2 - |n|^2 in w^2. The phase is a sum
over poles and zeros less w L, continuous in w; its slope is a rational function, so that the phase is monotone between
the roots of a polynomial and each crossing of a level is bracketed. No crossover can hide between grid points.

Frequencies are searched for in the loop's own unit of time (`LoopTransfer.own_units`), where nothing is far from one.
"""

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics import horner, units
from loopbook.numerics.imaginary_axis import (
    magnitude_squared,
    positive_roots,
    slope_of_phase,
    snapped,
    turned,
    turned_on_axis,
)
from loopbook.process.transfer_function import ProcessError, checked_coefficients

TOUCHES = 1e-7
BESIDE = 1e-13
SAME = 1e-9


class LoopError(LoopbookError):
    """A question that the loop cannot answer: the message says why."""


@dataclass(frozen=True)
class LoopTransfer:
    """n(s)/d(s) exp(-delay s). num, den: descending real coefficients; delay L [s] >= 0.

    It may have more zeros than poles only where nothing but its values is asked. hidden: how many factors s of num and
    den were divided out: modes at s = 0 that the transfer function does not show and the loop cannot move.
    """

    num: Sequence[float]
    den: Sequence[float]
    delay: float = 0.0
    hidden: int = field(init=False, default=0, repr=False)

    def __post_init__(self) -> None:
        num, den = checked_coefficients(self.num, "num"), checked_coefficients(self.den, "den")
        if den == (0.0,):
            raise ProcessError("den is zero: a transfer function needs a denominator")
        hidden = 0
        while len(num) > 1 and len(den) > 1 and num[-1] == den[-1] == 0:
            num, den, hidden = num[:-1], den[:-1], hidden + 1
        self._set(num, den, self.delay, hidden)

    def _set(self, num: tuple[float, ...], den: tuple[float, ...], delay: float, hidden: int) -> None:
        for name, value in (("num", num), ("den", den), ("delay", delay), ("hidden", hidden)):
            object.__setattr__(self, name, value)

    @cached_property
    def own_units(self) -> tuple["LoopTransfer", float]:
        """The same loop with time counted in units of its own, and that unit [s]: a frequency there is w times it."""
        time = units.characteristic_time(self.num, self.den, self.delay)
        num, den = units.in_units(self.num, time), units.in_units(self.den, time)
        scale = units.size(den)
        if time == 1 and scale == 1:
            return self, 1.0
        inside = object.__new__(LoopTransfer)
        num, den = units.in_units(num, 1.0, scale), units.in_units(den, 1.0, scale)
        inside._set(num, den, self.delay / time, self.hidden)
        inside.__dict__["own_units"] = (inside, 1.0)
        return inside, time

    def __call__(self, s: Any) -> Any:
        s = np.asarray(s)
        return horner.value(self.num, s) / horner.value(self.den, s) * np.exp(-self.delay * s)

    @cached_property
    def zeros(self) -> np.ndarray:
        inside, time = self.own_units
        return snapped(np.roots(inside.num)) / time

    @cached_property
    def poles(self) -> np.ndarray:
        inside, time = self.own_units
        return snapped(np.roots(inside.den)) / time

    @property
    def gain_at_infinity(self) -> float:
        """|n/d| for w to infinity: 0 for a strictly proper loop, infinite for an improper one."""
        excess = len(self.num) - len(self.den)
        return 0.0 if excess < 0 else np.inf if excess > 0 else abs(self.num[0] / self.den[0])

    def magnitude(self, w: Any) -> Any:
        """|n(jw)/d(jw)|."""
        inside, time = self.own_units
        s = 1j * time * np.asarray(w, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return abs(horner.value(inside.num, s) / horner.value(inside.den, s))

    @cached_property
    def phase_at_start(self) -> float:
        """The argument of n/d just right of the origin on the real axis: 0 or -pi."""
        ratio = _last_nonzero(self.num) / _last_nonzero(self.den)
        return 0.0 if ratio > 0 else -np.pi

    def phase(self, w: Any) -> Any:
        """The continuous argument [rad] for w > 0, starting from `phase_at_start` at the origin.

        A pole on the imaginary axis counts as if it lay to the left: it takes pi off where w passes it.
        """
        w = np.asarray(w, dtype=float)
        return self.phase_at_start + turned(self.zeros, w) - turned(self.poles, w) - self.delay * w

    @cached_property
    def gain_crossovers(self) -> np.ndarray:
        """All w > 0 [rad/s] with |n/d| = 1, ascending: roots of a polynomial, polished.

        The polynomial's roots tell where to look; between them the magnitude itself must change sides, and where it
        does the crossover is bracketed. A touch without a crossing is kept where a root says so.
        """
        inside, time = self.own_units
        difference = np.polysub(magnitude_squared(np.array(inside.den)), magnitude_squared(np.array(inside.num)))
        if not difference.any():
            raise LoopError("the loop's magnitude is 1 at every frequency: it has no crossover frequencies")
        candidates = positive_roots(difference)
        if not candidates.size:
            return candidates
        between = [candidates[0] / 2, *np.sqrt(candidates[:-1] * candidates[1:]).tolist(), 2 * candidates[-1]]
        loud = [inside._log_magnitude(w)[0] > 0 for w in between]
        found = []
        for w, (a, b), (before, after) in zip(candidates.tolist(), pairwise(between), pairwise(loud), strict=True):
            found.extend(inside._crossing(w, a, b, before) if before != after else inside._touch(w))
        return _distinct(found) / time

    def _crossing(self, w: float, a: float, b: float, falls: bool) -> list[float]:
        """The w in (a, b) at which the magnitude, above 1 at a if it falls, becomes 1: Newton's method, kept inside."""
        for _ in range(80):
            level, slope = self._log_magnitude(w)
            if level == 0:
                break
            a, b = (w, b) if (level > 0) == falls else (a, w)
            after = w * math.exp(max(min(-level / slope, 40.0), -40.0)) if slope else 0.0
            after = after if a < after < b else math.sqrt(a * b)
            if abs(after - w) <= 4e-16 * w:
                return [after]
            w = after
        return [w]

    def _touch(self, w: float) -> list[float]:
        for _ in range(4):
            level, slope = self._log_magnitude(w)
            if slope == 0:
                break
            w = w * math.exp(min(max(-level / slope, -1e-3), 1e-3))
        return [w] if abs(self._log_magnitude(w)[0]) < TOUCHES else []

    def _log_magnitude(self, w: float) -> tuple[float, float]:
        """log|n/d| at s = jw and its slope over log w; the slope is 0 where n or d vanishes."""
        s = 1j * w
        (n, dn), (d, dd) = horner.with_slope(self.num, s), horner.with_slope(self.den, s)
        if not (n and d):
            return (-math.inf if d else math.inf), 0.0
        return math.log(abs(n) / abs(d)), (s * (dn / n - dd / d)).real

    @cached_property
    def monotone_phase(self) -> np.ndarray:
        """The w > 0 [rad/s] that cut the axis into intervals of monotone phase: turning points, poles, zeros on it."""
        inside, time = self.own_units
        n, d = np.array(inside.num), np.array(inside.den)
        n2, d2 = magnitude_squared(n), magnitude_squared(d)
        slope: np.ndarray = np.polysub(np.polymul(slope_of_phase(n), d2), np.polymul(slope_of_phase(d), n2))
        slope = np.polysub(slope, inside.delay * np.polymul(n2, d2))
        axis = [abs(r.imag) for r in (*inside.zeros, *inside.poles) if r.real == 0 and r.imag > 0]
        return np.unique(np.concatenate([positive_roots(slope), axis])) / time

    def phase_crossovers(self, floor: float) -> np.ndarray:
        """All w > 0 [rad/s] where n/d exp(-Ls) is real and negative and its magnitude at least `floor`, ascending.

        With dead time there are infinitely many without a floor. Raises LoopError where |n/d| does not fall below the
        floor (a floor at or below the gain at infinity).
        """
        if self.delay and not floor > self.gain_at_infinity:
            raise LoopError(
                f"the loop gain tends to {self.gain_at_infinity:g}: infinitely many phase crossovers lie above the "
                f"floor {floor:g}"
            )
        inside, time = self.own_units
        last = inside._last_frequency(floor)
        turns = inside.monotone_phase
        cuts = [0.0, *turns[turns < last].tolist(), last]
        found: list[float] = []
        for a, b in pairwise(cuts):
            found.extend(inside._levels(a, b))
        found = [w for w in found if inside.magnitude(w) >= floor]
        return _distinct(found) / time

    def _last_frequency(self, floor: float) -> float:
        """Beyond it |n/d| stays below the floor; without dead time, where all turning is over."""
        difference = np.polysub(floor**2 * magnitude_squared(np.array(self.den)), magnitude_squared(np.array(self.num)))
        roots = np.append(positive_roots(difference), self.monotone_phase)
        radius = max((abs(r) for r in (*self.zeros, *self.poles)), default=1.0) or 1.0
        return 1.001 * max(float(roots.max(initial=0.0)), 1e3 * radius if not self.delay else 0.0, 1e-9 * radius)

    @cached_property
    def beginning(self) -> float:
        """A frequency below which nothing turns but what lies at s = 0."""
        paces = [abs(r) for r in (*self.zeros, *self.poles) if r] + ([1 / self.delay] if self.delay else [])
        return 1e-14 * min(paces, default=1.0)

    def _levels(self, a: float, b: float) -> list[float]:
        """The w in (a, b), where the phase is monotone, at which it is an odd multiple of pi."""
        from scipy.optimize import brentq

        low, high = (a * (1 + BESIDE) if a else min(self.beginning, b / 2)), b * (1 - BESIDE)
        if not low < high:
            return []
        start, end = self.phase_at(low), self.phase_at(high)
        first, last = sorted(((start / np.pi - 1) / 2, (end / np.pi - 1) / 2))
        found = []
        for k in range(math.ceil(first), math.floor(last) + 1):
            level = (2 * k + 1) * math.pi
            if (start - level) * (end - level) < 0:
                gap = lambda x, c=level: self.phase_at(math.exp(x)) - c  # noqa: E731
                found.append(math.exp(brentq(gap, math.log(low), math.log(high), xtol=1e-14, rtol=1e-14)))
        return [self._polished(w) for w in found]

    @cached_property
    def _turning(self) -> list[tuple[float, float, float, float]]:
        """Each root that is not on the axis as (its real part's size, imaginary part, sign, angle at the start)."""
        signed = [(r, 1.0) for r in self.zeros.tolist()] + [(r, -1.0) for r in self.poles.tolist()]
        return [
            (abs(r.real), r.imag, -sign * math.copysign(1.0, r.real), math.atan2(-r.imag, abs(r.real)))
            for r, sign in signed
            if r.real
        ]

    def phase_at(self, w: float) -> float:
        """`phase` for one w, in Python's numbers: root finding asks for one at a time."""
        on_axis = sum(turned_on_axis(r.imag, w) for r in self.zeros.tolist() if not r.real)
        on_axis -= sum(turned_on_axis(r.imag, w) for r in self.poles.tolist() if not r.real)
        aside = sum(sign * (math.atan2(w - im, re) - start) for re, im, sign, start in self._turning)
        return self.phase_at_start + on_axis + aside - self.delay * w

    def _polished(self, w: float) -> float:
        """A last Newton step with the polynomials themselves, which are more exact than their roots."""
        s = 1j * w
        (n, dn), (d, dd) = horner.with_slope(self.num, s), horner.with_slope(self.den, s)
        if not (n and d):
            return w
        wrapped = cmath.phase(-n / d * cmath.exp(-self.delay * s))
        slope = (1j * (dn / n - dd / d)).imag - self.delay
        change = wrapped / slope if slope else 0.0
        return w - change if abs(change) < 1e-6 * w else w


def _last_nonzero(p: Sequence[float]) -> float:
    return [c for c in p if c][-1] if any(p) else 1.0


def _distinct(found: list[float]) -> np.ndarray:
    values = np.sort(np.array(found, dtype=float))
    return values[np.append(True, np.diff(values) > SAME * values[1:])] if values.size else values
