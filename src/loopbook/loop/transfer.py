"""The transfer function around a loop, n(s)/d(s) exp(-L s), and its exact magnitude and phase on the imaginary axis.

|n/d| has no dead time in it, so gain crossovers are roots of the polynomial |d|^2 - |n|^2 in w^2. The phase is a sum
over poles and zeros less w L, continuous in w; its slope is a rational function, so that the phase is monotone between
the roots of a polynomial and each crossing of a level is bracketed. No crossover can hide between grid points.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from loopbook.numerics import horner
from loopbook.process.transfer_function import ProcessError, coefficients

ON_AXIS = 1e-9


class LoopError(ValueError):
    """A question that the loop cannot answer: the message says why."""


def _product_with_mirror(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Re(p(jw) conj(q(jw))) as a polynomial in x = w^2, descending: the even part of p(s) q(-s) at s^2 = -x."""
    mirrored = np.asarray(q) * (-1.0) ** np.arange(len(q) - 1, -1, -1)
    even = np.convolve(p, mirrored)[::-1][::2][::-1]
    return even * (-1.0) ** np.arange(len(even) - 1, -1, -1)


def _magnitude_squared(p: np.ndarray) -> np.ndarray:
    """|p(jw)|^2, a polynomial in w^2."""
    return _product_with_mirror(p, p)


def _slope_of_phase(p: np.ndarray) -> np.ndarray:
    """d/dw arg p(jw) times |p(jw)|^2, a polynomial in w^2: Re(p'(jw) conj(p(jw)))."""
    return _product_with_mirror(np.polyder(p), p) if len(p) > 1 else np.zeros(1)


def positive_roots(p: np.ndarray) -> np.ndarray:
    """The w > 0 at which a real polynomial in x = w^2 vanishes, ascending: candidates at double roots included."""
    x = np.roots(p)
    x = x[(x.real > 0) & (abs(x.imag) <= 1e-6 * abs(x))].real
    return np.sort(np.sqrt(x))


@dataclass(frozen=True)
class LoopTransfer:
    """n(s)/d(s) exp(-delay s). num, den: descending real coefficients; delay L [s] >= 0.

    It may have more zeros than poles only where nothing but its values is asked.
    """

    num: tuple[float, ...]
    den: tuple[float, ...]
    delay: float = 0.0

    def __post_init__(self):
        num, den = coefficients(self.num, "num"), coefficients(self.den, "den")
        if den == (0.0,):
            raise ProcessError("den is zero: a transfer function needs a denominator")
        while len(num) > 1 and len(den) > 1 and num[-1] == den[-1] == 0 and num != (0.0,):
            num, den = num[:-1], den[:-1]
        object.__setattr__(self, "num", num)
        object.__setattr__(self, "den", den)

    def __call__(self, s: Any) -> Any:
        s = np.asarray(s)
        return horner.value(self.num, s) / horner.value(self.den, s) * np.exp(-self.delay * s)

    @cached_property
    def zeros(self) -> np.ndarray:
        return _snapped(np.roots(self.num))

    @cached_property
    def poles(self) -> np.ndarray:
        return _snapped(np.roots(self.den))

    @property
    def gain_at_infinity(self) -> float:
        """|n/d| for w to infinity: 0 for a strictly proper loop, infinite for an improper one."""
        excess = len(self.num) - len(self.den)
        return 0.0 if excess < 0 else np.inf if excess > 0 else abs(self.num[0] / self.den[0])

    def magnitude(self, w: Any) -> Any:
        """|n(jw)/d(jw)|."""
        s = 1j * np.asarray(w, dtype=float)
        return abs(horner.value(self.num, s) / horner.value(self.den, s))

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
        return self.phase_at_start + _turned(self.zeros, w) - _turned(self.poles, w) - self.delay * w

    @cached_property
    def gain_crossovers(self) -> np.ndarray:
        """All w > 0 [rad/s] with |n/d| = 1, ascending: roots of a polynomial, polished."""
        difference = np.polysub(_magnitude_squared(np.array(self.den)), _magnitude_squared(np.array(self.num)))
        scale = np.abs(difference).max(initial=0.0)
        if scale == 0:
            raise LoopError("the loop's magnitude is 1 at every frequency: it has no crossover frequencies")
        found = []
        for w in positive_roots(difference).tolist():
            for _ in range(4):
                level, slope = self._log_magnitude(w)
                if slope == 0:
                    break
                w = w * math.exp(min(max(-level / slope, -1e-3), 1e-3))
            if abs(self._log_magnitude(w)[0]) < 1e-7:
                found.append(w)
        return _distinct(found)

    def _log_magnitude(self, w: float) -> tuple[float, float]:
        """log|n/d| at s = jw and its slope over log w; the slope is 0 where n or d vanishes."""
        s = 1j * w
        (n, dn), (d, dd) = horner.with_slope(self.num, s), horner.with_slope(self.den, s)
        if not (n and d):
            return (-math.inf if d else math.inf), 0.0
        return math.log(abs(n) / abs(d)), (s * (dn / n - dd / d)).real

    @cached_property
    def monotone_phase(self) -> np.ndarray:
        """The w > 0 that cut the axis into intervals of monotone phase: turning points, poles and zeros on the axis."""
        n, d = np.array(self.num), np.array(self.den)
        n2, d2 = _magnitude_squared(n), _magnitude_squared(d)
        slope = np.polysub(np.polymul(_slope_of_phase(n), d2), np.polymul(_slope_of_phase(d), n2))
        slope = np.polysub(slope, self.delay * np.polymul(n2, d2))
        axis = [abs(r.imag) for r in (*self.zeros, *self.poles) if r.real == 0 and r.imag > 0]
        return np.unique(np.concatenate([positive_roots(slope), axis]))

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
        last = self._last_frequency(floor)
        cuts = self.monotone_phase
        cuts = np.concatenate([[0.0], cuts[cuts < last], [last]])
        found: list[float] = []
        for a, b in pairwise(cuts):
            found.extend(self._levels(a, b))
        found = [w for w in found if self.magnitude(w) >= floor]
        return _distinct(found)

    def _last_frequency(self, floor: float) -> float:
        """Beyond it |n/d| stays below the floor; without dead time, where all turning is over."""
        difference = np.polysub(
            floor**2 * _magnitude_squared(np.array(self.den)), _magnitude_squared(np.array(self.num))
        )
        roots = np.append(positive_roots(difference), self.monotone_phase)
        radius = max((abs(r) for r in (*self.zeros, *self.poles)), default=1.0) or 1.0
        return 1.001 * max(float(roots.max(initial=0.0)), 1e3 * radius if not self.delay else 0.0, 1e-9 * radius)

    def _levels(self, a: float, b: float) -> list[float]:
        """The w in (a, b), where the phase is monotone, at which it is an odd multiple of pi."""
        from scipy.optimize import brentq

        inner = a + (b - a) * 1e-13 if a else min(b, 1.0) * 1e-14
        ends = sorted([float(self.phase(inner)), float(self.phase(b * (1 - 1e-13)))])
        first, last = np.ceil((ends[0] / np.pi - 1) / 2 - 1e-12), np.floor((ends[1] / np.pi - 1) / 2 + 1e-12)
        found = []
        for k in np.arange(first, last + 1):
            level = (2 * k + 1) * np.pi
            low, high = self.phase(inner) - level, self.phase(b * (1 - 1e-13)) - level
            if low * high < 0:
                found.append(brentq(lambda w, c=level: float(self.phase(w)) - c, inner, b * (1 - 1e-13), xtol=1e-300))
        return [self._polished(w) for w in found]

    def _polished(self, w: float) -> float:
        """A last Newton step with the polynomials themselves, which are more exact than their roots."""
        s = 1j * w
        (n, dn), (d, dd) = horner.with_slope(self.num, s), horner.with_slope(self.den, s)
        if not (n and d):
            return w
        wrapped = np.angle(-n / d * np.exp(-self.delay * s))
        slope = (1j * (dn / n - dd / d)).imag - self.delay
        change = wrapped / slope if slope else 0.0
        return w - change if abs(change) < 1e-6 * w else w


def _snapped(roots: np.ndarray) -> np.ndarray:
    """Roots within rounding of the imaginary axis are set on it."""
    roots = np.asarray(roots, dtype=complex)
    near = abs(roots.real) <= ON_AXIS * abs(roots)
    return np.where(near, 1j * roots.imag, roots)


def _turned(roots: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The change of arg(s - root), summed over the roots, from s = 0+ to s = jw; roots on the axis count as left."""
    re, im, w = roots.real, roots.imag, np.asarray(w)[..., None]
    # measured from the direction away from the root's side, where arg never jumps
    side = -np.sign(re) * (np.arctan2(w - im, abs(re)) - np.arctan2(-im, abs(re)))
    on_axis = np.where(w >= im, np.pi / 2, -np.pi / 2) + np.sign(im) * np.pi / 2
    return np.where(re == 0, on_axis, side).sum(axis=-1)


def _last_nonzero(p: tuple[float, ...]) -> float:
    return [c for c in p if c][-1] if any(p) else 1.0


def _distinct(found: list[float]) -> np.ndarray:
    values = np.sort(np.array(found, dtype=float))
    return values[np.append(True, np.diff(values) > 1e-9 * values[1:])] if values.size else values
