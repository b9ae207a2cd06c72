"""Ms and Mt: the largest |1/(1 + G)| and |G/(1 + G)| over all frequencies, certified.

    1/Ms = min |1 + G(jw)|,    1/Mt = min |1 + 1/G(jw)|,    G = n/d exp(-Ls)

With dead time the minimum may lie on any of the many loops of the Nyquist curve. Branch and bound finds it: on an
interval of w the distances to the poles and zeros bound |G| and |dG/dw|, hence |1 + G| from below; an interval is
dropped only when that bound shows that nothing smaller can lie in it.
"""

from typing import NamedTuple

import numpy as np

from loopbook.circle_transfer import CircleTransfer
from loopbook.loop_transfer import LoopError, LoopTransfer

CERTAIN = 1e-6


class Peak(NamedTuple):
    """value: the peak's magnitude. w: where it is reached [rad/s]; inf or 0 where it is a limit."""

    value: float
    w: float


class _Axis:
    """W = k prod(s - z)/prod(s - p) exp(-L s) on the imaginary axis: G itself or 1/G (then with a negative L)."""

    def __init__(self, loop: LoopTransfer, inverse: bool):
        num, den = (loop.den, loop.num) if inverse else (loop.num, loop.den)
        self.zeros, self.poles = (loop.poles, loop.zeros) if inverse else (loop.zeros, loop.poles)
        self.num, self.den = np.array(num), np.array(den)
        self.delay = -loop.delay if inverse else loop.delay
        self.k = abs(num[0] / den[0])

    def __call__(self, w: np.ndarray) -> np.ndarray:
        s = 1j * np.asarray(w, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.polyval(self.num, s) / np.polyval(self.den, s) * np.exp(-self.delay * s)

    def distance(self, w: np.ndarray) -> np.ndarray:
        """|1 + W|, infinite at a pole."""
        value = np.abs(1 + self(w))
        return np.where(np.isfinite(value), value, np.inf)

    def grid(self) -> tuple[np.ndarray, float, float]:
        """Where to search, beyond which nothing is left to find, and the best of the curve's two ends: value, w."""
        sizes = [abs(r) for r in (*self.zeros, *self.poles) if abs(r) > 0]
        pace = [1 / abs(self.delay)] if self.delay else []
        low, high = 1e-3 * min([*sizes, *pace], default=1.0), 2 * max([*sizes, *pace], default=1.0)
        ends = (_limit(self), np.inf), (float(self.distance(np.array([1e-12 * low]))[0]), 0.0)
        best, at = min(ends)
        for _ in range(400):
            if _tail(self, high) >= min(best, 1.0) * (1 - CERTAIN) or high > 1e12 * low:
                break
            high *= 1.5
        return np.concatenate([[0.0], np.geomspace(low, high, 200)]), best, at

    def slope(self, w: float) -> float:
        """A positive multiple of d|1 + W|/dw."""
        s, value = 1j * w, complex(self(w))
        logs = [np.polyval(np.polyder(p), s) / np.polyval(p, s) for p in (self.num, self.den)]
        return float((np.conj(1 + value) * value * 1j * (logs[0] - logs[1] - self.delay)).real)

    def bound(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """What |1 + W| cannot fall below on [a, b]."""
        (z_near, z_far), (p_near, p_far) = _distances(self.zeros, a, b), _distances(self.poles, a, b)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            most = self.k * z_far.prod(axis=0) / p_near.prod(axis=0)
            least = self.k * z_near.prod(axis=0) / p_far.prod(axis=0)
            steepest = most * ((1 / z_near).sum(axis=0) + (1 / p_near).sum(axis=0) + abs(self.delay))
            local = self.distance((a + b) / 2) - steepest * (b - a) / 2
        return np.fmax(np.fmax(np.where(np.isfinite(local), local, -1.0), least - 1), 1 - most)


def _distances(roots: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each root to the nearest and to the farthest point of j[a, b]; shapes (roots, intervals)."""
    re, im = roots.real[:, None], roots.imag[:, None]
    outside = np.maximum(0.0, np.maximum(a - im, im - b))
    return np.hypot(re, outside), np.hypot(re, np.maximum(abs(a - im), abs(b - im)))


def _tail(curve: _Axis, start: float) -> float:
    """What |1 + W| cannot fall below beyond `start`, which exceeds every |root|."""
    excess = len(curve.zeros) - len(curve.poles)
    up = lambda roots: float(np.prod(1 + abs(roots) / start))  # noqa: E731
    down = lambda roots: float(np.prod(1 - abs(roots) / start))  # noqa: E731
    scale = curve.k * start**excess
    if excess <= 0:
        most = scale * up(curve.zeros) / down(curve.poles)
        least = scale * down(curve.zeros) / up(curve.poles) if excess == 0 else 0.0
        return max(1 - most, least - 1)
    return scale * down(curve.zeros) / up(curve.poles) - 1


def _limit(curve: _Axis) -> float:
    """The smallest value that |1 + W| comes near for w to infinity."""
    excess = len(curve.zeros) - len(curve.poles)
    if excess:
        return 1.0 if excess < 0 else np.inf
    if curve.delay:
        return abs(1 - curve.k)
    return abs(1 + curve.num[0] / curve.den[0])


class Circle:
    """W = G or 1/G on the unit circle, for sampled loops; w is the angle."""

    def __init__(self, transfer: CircleTransfer):
        self.transfer = transfer

    def distance(self, a: np.ndarray) -> np.ndarray:
        value = np.abs(1 + self.transfer(a))
        return np.where(np.isfinite(value), value, np.inf)

    def slope(self, a: float) -> float:
        at = np.array(a)
        value = complex(self.transfer(at))
        return float((np.conj(1 + value) * value * complex(self.transfer.log_slope(at))).real)

    def grid(self) -> tuple[np.ndarray, float, float]:
        t = self.transfer
        ends = [(float(self.distance(np.array(a))), float(a)) for a in (1e-9 * t.start, np.pi)]
        return np.concatenate([[0.0], np.geomspace(t.start, np.pi, 200)]), *min(ends)

    def bound(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        t = self.transfer
        (z_near, z_far), (p_near, p_far) = (t.distances(roots, a, b) for roots in (t.zeros, t.poles))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            most = abs(t.k) * z_far.prod(axis=0) / p_near.prod(axis=0)
            least = abs(t.k) * z_near.prod(axis=0) / p_far.prod(axis=0)
            pace = (abs(t.zeros)[:, None] / z_near).sum(axis=0) + (abs(t.poles)[:, None] / p_near).sum(axis=0)
            local = self.distance((a + b) / 2) - most * (pace + abs(t.d)) * (b - a) / 2
        return np.fmax(np.fmax(np.where(np.isfinite(local), local, -1.0), least - 1), 1 - most)


def _polished(curve: "_Axis | Circle", a: float, b: float, w: float) -> tuple[float, float]:
    """(distance, w) at the minimum near w in [a, b]."""
    from scipy.optimize import brentq

    low, high = curve.slope(a) if a > 0 else -1.0, curve.slope(b)
    if np.isfinite(low) and np.isfinite(high) and low < 0 < high and a > 0:
        w = brentq(curve.slope, a, b, xtol=1e-15 * b, rtol=1e-14)
    return float(curve.distance(np.array(w))), float(w)


def closest(curve: "_Axis | Circle") -> tuple[float, float]:
    """min |1 + W| over the whole curve and where, to a certified relative 1e-6 and in fact to rounding."""
    grid, best, at = curve.grid()
    a, b = grid[:-1], grid[1:]
    for _ in range(60):
        middle = (a + b) / 2
        values = curve.distance(middle)
        i = int(np.argmin(values))
        if values[i] < best * (1 - 1e-15):
            width = b[i] - a[i]
            best, at = min(
                (float(values[i]), float(middle[i])),
                _polished(curve, max(a[i] - width, 0.0), b[i] + width, float(middle[i])),
            )
        keep = curve.bound(a, b) < best * (1 - CERTAIN)
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
    distance, w = closest(_Axis(loop, inverse=False))
    return _reciprocal(distance, w)


def complementary_peak(loop: LoopTransfer) -> Peak:
    """Mt = max |G/(1 + G)| [-], and where.

    >>> complementary_peak(LoopTransfer([0.1], [1, 0], 1.0))
    Peak(value=1.0, w=0.0)
    """
    if not any(loop.num):
        return Peak(0.0, 0.0)
    distance, w = closest(_Axis(loop, inverse=True))
    return _reciprocal(distance, w)


def sampled_peaks(transfer: CircleTransfer) -> tuple[Peak, Peak]:
    """Ms and Mt of a sampled loop, with the angle wh [rad] in the place of w."""
    inverse = transfer.inverse() if transfer.k else None
    Mt = _reciprocal(*closest(Circle(inverse))) if inverse else Peak(0.0, 0.0)
    return _reciprocal(*closest(Circle(transfer))), Mt


def _reciprocal(distance: float, w: float) -> Peak:
    if distance < 1e-12:
        raise LoopError(f"the loop is on the border of stability: 1 + G = 0 at w = {w:.6g} rad/s")
    return Peak(1 / distance, w)
