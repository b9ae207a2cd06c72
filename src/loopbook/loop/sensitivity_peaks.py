"""Ms and Mt: the largest |1/(1 + G)| and |G/(1 + G)| over all frequencies, certified.

    1/Ms = min |1 + G(jw)|,    1/Mt = min |1 + 1/G(jw)|,    G = n/d exp(-Ls)

With dead time the minimum may lie on any of the many loops of the Nyquist curve. Branch and bound finds it: on an
interval of w the distances to the poles and zeros bound |G| and the curve's departure from its tangent, hence |1 + G|
from below; an interval is dropped only when that bound shows that nothing smaller can lie in it.
"""

import cmath
import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.loop.unit_circle import CircleTransfer
from loopbook.numerics import horner

CERTAIN = 1e-6
BESIDE = (1e-2, 1e-4, 1e-6)


class Peak(NamedTuple):
    """value: the peak's magnitude. w: where it is reached [rad/s]; inf or 0 where it is a limit."""

    value: float
    w: float


class NyquistCurve(ABC):
    """W over w. A subclass tells W, d log W/dw, and what bounds them on intervals."""

    @abstractmethod
    def __call__(self, w: np.ndarray) -> np.ndarray: ...
    @abstractmethod
    def log_slope(self, w: np.ndarray) -> np.ndarray: ...
    @abstractmethod
    def extent(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]: ...
    @abstractmethod
    def grid(self) -> tuple[np.ndarray, float, float]: ...

    def distance(self, w: np.ndarray) -> np.ndarray:
        """|1 + W|, infinite at a pole."""
        value = np.abs(1 + self(w))
        return np.where(np.isfinite(value), value, np.inf)

    def slope(self, w: float) -> float:
        """A positive multiple of d|1 + W|/dw."""
        value = self(np.array(w))
        return float((np.conj(1 + value) * value * self.log_slope(np.array(w))).real)

    def survey(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """|1 + W| in the middle m of each [a, b], and what it cannot fall below there:

        |1 + W(w)| >= |1 + W(m) + (w - m) W'(m)| - max|W''| (b - a)^2/8,    |W| - 1,    1 - |W|
        """
        least, most, pace, bend = self.extent(a, b)
        middle, half = (a + b) / 2, (b - a) / 2
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            W = self(middle)
            start, chord = 1 + W, W * self.log_slope(middle) * half
            to_foot = np.clip(-(np.conj(chord) * start).real / np.abs(chord) ** 2, -1, 1)
            to_foot = np.where(np.isfinite(to_foot), to_foot, 0.0)
            local = np.abs(start + to_foot * chord) - most * (pace**2 + bend) * half**2 / 2
        values = np.where(np.isfinite(W), np.abs(start), np.inf)
        return values, np.fmax(np.fmax(np.where(np.isfinite(local), local, -1.0), least - 1), 1 - most)


class _Axis(NyquistCurve):
    """W = k prod(s - z)/prod(s - p) exp(-L s) on the imaginary axis: G itself or 1/G (then with a negative L)."""

    def __init__(self, loop: LoopTransfer, inverse: bool):
        self.num, self.den = (loop.den, loop.num) if inverse else (loop.num, loop.den)
        self.zeros, self.poles = (loop.poles, loop.zeros) if inverse else (loop.zeros, loop.poles)
        self.delay = -loop.delay if inverse else loop.delay
        self.k = abs(self.num[0] / self.den[0])
        turning = bool(self.delay) and len(self.zeros) == len(self.poles)
        self.monotone_from = _monotone_from(self.num, self.den) if turning else np.inf

    def __call__(self, w: np.ndarray) -> np.ndarray:
        s = 1j * np.asarray(w, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return horner.value(self.num, s) / horner.value(self.den, s) * np.exp(-self.delay * s)

    def log_slope(self, w: np.ndarray) -> np.ndarray:
        """d log W/dw."""
        (n, dn), (d, dd) = (horner.with_slope(p, 1j * w) for p in (self.num, self.den))
        return 1j * (dn / n - dd / d - self.delay)

    def slope(self, w: float) -> float:
        """The same with numerator and denominator n, d, in which nothing is divided by."""
        s = 1j * w
        (n, dn), (d, dd) = (horner.with_slope(p, s) for p in (self.num, self.den))
        turn = cmath.exp(-self.delay * s)
        return ((d + n * turn).conjugate() * d.conjugate() * turn * 1j * (dn * d - dd * n - self.delay * n * d)).real

    def grid(self) -> tuple[np.ndarray, float, float]:
        """Where to search, beyond which nothing is left to find, and the best of the curve's two ends: value, w."""
        sizes = [abs(r) for r in (*self.zeros, *self.poles) if abs(r) > 0]
        pace = [1 / abs(self.delay)] if self.delay else []
        low, high = 1e-3 * min([*sizes, *pace], default=1.0), 2 * max([*sizes, *pace], default=1.0)
        w = np.geomspace(low, high, 200)
        at_zero, *inside = self.distance(np.append(1e-12 * low, w))
        end = min((_limit(self), np.inf), (float(at_zero), 0.0))
        farther = high * 1.5 ** np.arange(2 + max(0, math.ceil(math.log(1e12 * low / high, 1.5))))
        over = np.flatnonzero(_tail(self, farther) >= min(end[0], *inside) * (1 - CERTAIN))
        return np.concatenate([[0.0], w, farther[1 : over[0] + 1 if over.size else None]]), *end

    def extent(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """On each [a, b]: what |W| exceeds and what it cannot, what |d log W/dw| and |d2 log W/dw2| cannot."""
        roots, split = np.concatenate([self.zeros, self.poles])[:, None], len(self.zeros)
        outside = np.maximum(0.0, np.maximum(a - roots.imag, roots.imag - b))
        near = np.hypot(roots.real, outside)
        far = np.hypot(roots.real, np.maximum(abs(a - roots.imag), abs(b - roots.imag)))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            most = self.k * far[:split].prod(axis=0) / near[split:].prod(axis=0)
            least = self.k * near[:split].prod(axis=0) / far[split:].prod(axis=0)
            beyond = a >= self.monotone_from
            if beyond.any():
                at_ends = np.abs(self(a)), np.abs(self(b))
                least, most = (
                    np.where(beyond, np.minimum(*at_ends), least),
                    np.where(beyond, np.maximum(*at_ends), most),
                )
            return least, most, (1 / near).sum(axis=0) + abs(self.delay), (1 / near**2).sum(axis=0)


def _monotone_from(num: Sequence[float], den: Sequence[float]) -> float:
    """A frequency beyond which |num/den|, of equal degrees, only rises or only falls: beyond all its extremes.

    |p(jw)|^2 is a polynomial in x = w^2, and N/D has its extremes where N' D = N D'.
    """
    if len(num) == 1:
        return 0.0
    N, D = (_squared(p) for p in (num, den))
    parts = np.convolve(np.polyder(N), D), np.convolve(N, np.polyder(D))
    slope = (parts[0] - parts[1])[1:]  # the leading terms are equal
    slope = np.where(np.abs(slope) > 1e-13 * (np.abs(parts[0]) + np.abs(parts[1]))[1:], slope, 0.0)
    roots = np.roots(slope) if len(slope) > 1 and slope.any() else np.zeros(0)
    return float(2 * np.sqrt(np.abs(roots).max(initial=0.0)))


def _squared(p: Sequence[float]) -> np.ndarray:
    """|p(jw)|^2 in descending powers of w^2."""
    signs = (-1.0) ** np.arange(len(p))[::-1]
    even = np.convolve(p, p * signs)[::2]
    return np.asarray(even * (-1.0) ** np.arange(len(even))[::-1])


def _tail(curve: _Axis, start: np.ndarray) -> np.ndarray:
    """What |1 + W| cannot fall below beyond each `start`, which exceeds every |root|."""
    excess = len(curve.zeros) - len(curve.poles)
    up = lambda roots: np.prod(1 + abs(roots) / start[:, None], axis=1)  # noqa: E731
    down = lambda roots: np.prod(1 - abs(roots) / start[:, None], axis=1)  # noqa: E731
    scale = curve.k * start**excess
    least = scale * down(curve.zeros) / up(curve.poles)
    if excess > 0:
        return least - 1
    if np.isfinite(curve.monotone_from):
        size = np.abs(curve(start))
        toward = np.where((size - 1) * (curve.k - 1) > 0, np.minimum(np.abs(size - 1), abs(curve.k - 1)), 0.0)
        return np.where(
            start >= curve.monotone_from, toward, np.maximum(1 - scale * up(curve.zeros) / down(curve.poles), least - 1)
        )
    most = scale * up(curve.zeros) / down(curve.poles)
    return np.maximum(1 - most, least - 1) if excess == 0 else 1 - most


def _limit(curve: _Axis) -> float:
    """The smallest value that |1 + W| comes near for w to infinity."""
    excess = len(curve.zeros) - len(curve.poles)
    if excess:
        return 1.0 if excess < 0 else np.inf
    if curve.delay:
        return abs(1 - curve.k)
    return abs(1 + curve.num[0] / curve.den[0])


class Circle(NyquistCurve):
    """W = G or 1/G on the unit circle, for sampled loops; w is the angle."""

    def __init__(self, transfer: CircleTransfer):
        self.transfer = transfer

    def __call__(self, w: np.ndarray) -> np.ndarray:
        return self.transfer(w)

    def log_slope(self, w: np.ndarray) -> np.ndarray:
        return self.transfer.log_slope(w)

    def grid(self) -> tuple[np.ndarray, float, float]:
        t = self.transfer
        ends = [(float(self.distance(np.array(a))), float(a)) for a in (1e-9 * t.start, np.pi)]
        return np.concatenate([[0.0], np.geomspace(t.start, np.pi, 200)]), *min(ends)

    def extent(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        t = self.transfer
        roots, split = np.concatenate([t.zeros, t.poles]), len(t.zeros)
        near, far = t.distances(roots, a, b)
        size = abs(roots)[:, None]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            most = abs(t.k) * far[:split].prod(axis=0) / near[split:].prod(axis=0)
            least = abs(t.k) * near[:split].prod(axis=0) / far[split:].prod(axis=0)
            return least, most, (size / near).sum(axis=0) + abs(t.d), (size / near**2).sum(axis=0)


def _polished(curve: NyquistCurve, a: float, b: float, w: float) -> tuple[float, float]:
    """(distance, w) at the minimum near w in [a, b]; beside w itself where [a, b] does not bracket one."""
    from scipy.optimize import brentq

    for low, high in ((a, b), *((w * (1 - share), w * (1 + share)) for share in BESIDE)):
        if low > 0 and np.isfinite(ends := (curve.slope(low), curve.slope(high))).all() and ends[0] < 0 < ends[1]:
            w = brentq(curve.slope, low, high, xtol=1e-15 * high, rtol=1e-14)
            break
    return float(curve.distance(np.array(w))), float(w)


def closest(curve: NyquistCurve) -> tuple[float, float]:
    """min |1 + W| over the whole curve and where, to a certified relative 1e-6 and in fact to rounding."""
    grid, best, at = curve.grid()
    a, b = grid[:-1], grid[1:]
    for _ in range(60):
        middle = (a + b) / 2
        values, bound = curve.survey(a, b)
        i = int(np.argmin(values))
        if values[i] < best * (1 - 1e-15):
            width = b[i] - a[i]
            best, at = min(
                (float(values[i]), float(middle[i])),
                _polished(curve, max(a[i] - width, 0.0), b[i] + width, float(middle[i])),
            )
        keep = bound < best * (1 - CERTAIN)
        a, b, middle = a[keep], b[keep], middle[keep]
        if not a.size:
            return best, at
        if a.size > 400_000:
            break
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    raise LoopError(
        "the peak of the sensitivity could not be certified: the loop has more turns than can be searched, or it is on "
        "the border of stability"
    )


def sensitivity_peak(loop: LoopTransfer) -> Peak:
    """Ms = max |1/(1 + G(jw))| [-], and where. 1 at least; the reciprocal of the distance from -1 to the curve.

    Raises LoopError on the border of stability, where it is infinite.

    >>> round(sensitivity_peak(LoopTransfer([1.0], [1, 0], 1.0)).value, 4)
    3.1293
    """
    if loop.gain_at_infinity == np.inf:
        raise LoopError("the loop transfer has more zeros than poles: its sensitivity peak is no measure; filter it")
    return _in_seconds(loop, inverse=False)


def complementary_peak(loop: LoopTransfer) -> Peak:
    """Mt = max |G/(1 + G)| [-], and where.

    >>> complementary_peak(LoopTransfer([0.1], [1, 0], 1.0))
    Peak(value=1.0, w=0.0)
    """
    if not any(loop.num):
        return Peak(0.0, 0.0)
    return _in_seconds(loop, inverse=True)


def _in_seconds(loop: LoopTransfer, inverse: bool) -> Peak:
    inside, time = loop.own_units
    distance, w = closest(_Axis(inside, inverse))
    return _reciprocal(distance, w / time)


def sampled_peaks(transfer: CircleTransfer) -> tuple[Peak, Peak]:
    """Ms and Mt of a sampled loop, with the angle wh [rad] in the place of w."""
    inverse = transfer.inverse() if transfer.k else None
    Mt = _reciprocal(*closest(Circle(inverse))) if inverse else Peak(0.0, 0.0)
    return _reciprocal(*closest(Circle(transfer))), Mt


def _reciprocal(distance: float, w: float) -> Peak:
    if distance < 1e-12:
        raise LoopError(f"the loop is on the border of stability: 1 + G = 0 at w = {w:.6g} rad/s")
    return Peak(1 / distance, w)
