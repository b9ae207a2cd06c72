"""The transfer function around a sampled loop on the unit circle: magnitude, phase, all crossovers.

With z = exp(j a), 0 <= a <= pi, and polynomials in z^-1,

    G = k z^-d prod(1 - z_i z^-1)/prod(1 - p_i z^-1)

d/da log G is a sum over zeros and poles, and so is a bound on the second derivative over an interval, from the
distances of the arc to them. Intervals are halved until that bound proves magnitude (or phase) monotone in each; then
the values at its ends tell every crossing. This holds for fast sampling too, where all that matters happens close to
z = 1 and polynomials in cos(a) would lose it to rounding.
"""

import cmath
import math
from functools import cached_property

import numpy as np

ON_CIRCLE = 1e-9
ROUNDING = 4e-16
FINEST = 1e-7
PARTS = 8  # into which an interval is cut whose slope may change its sign


class CircleTransfer:
    """num/den in z^-1, ascending coefficients; zeros and poles are their roots in z, given where they are known better
    than the coefficients tell."""

    def __init__(self, num: np.ndarray, den: np.ndarray, zeros: np.ndarray, poles: np.ndarray):
        first = int(np.flatnonzero(num)[0]) if np.any(num) else 0
        lead = int(np.flatnonzero(den)[0])
        self.num, self.den = np.asarray(num, dtype=float), np.asarray(den, dtype=float)
        self.k, self.d = float(self.num[first] / self.den[lead]), first - lead
        self.zeros, self.poles = np.asarray(zeros), np.asarray(poles)

    def inverse(self) -> "CircleTransfer":
        """den/num."""
        return CircleTransfer(self.den, self.num, self.poles, self.zeros)

    def __call__(self, a: np.ndarray) -> np.ndarray:
        turned = np.exp(-1j * np.asarray(a, dtype=float))[..., None]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.prod(1 - self.zeros * turned, axis=-1) / np.prod(1 - self.poles * turned, axis=-1)
            return self.k * turned[..., 0] ** self.d * ratio

    def log_slope(self, a: np.ndarray) -> np.ndarray:
        """d/da log G: the real part is the slope of log|G|, the imaginary part that of the phase."""
        turned = np.exp(-1j * np.asarray(a, dtype=float))[..., None]
        with np.errstate(divide="ignore", invalid="ignore"):
            parts = [(1j * r * turned / (1 - r * turned)).sum(axis=-1) for r in (self.zeros, self.poles)]
        return parts[0] - parts[1] - 1j * self.d

    def phase(self, a: np.ndarray) -> np.ndarray:
        """The argument [rad], continuous in a but for jumps where a root lies on the circle."""
        a = np.asarray(a, dtype=float)
        start = 0.0 if self.k > 0 else -np.pi
        return start - self.d * a + _turned(self.zeros, a) - _turned(self.poles, a)

    def distances(self, roots: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of each root to the nearest and the farthest point of the arcs [a, b]; shapes (roots, arcs)."""
        size, angle = abs(roots)[:, None], np.angle(roots)[:, None]

        def distance(x: np.ndarray) -> np.ndarray:
            return np.hypot(1 - size, 2 * np.sqrt(size) * np.sin((x - angle) / 2))

        ends = distance(a), distance(b)
        passed = (a <= angle) & (angle <= b)  # the arc lies in [0, pi], the angles of the roots in (-pi, pi]
        opposite = (a <= angle + np.pi) & (angle + np.pi <= b)
        near = np.where(passed, abs(1 - size), np.minimum(*ends))
        return near, np.where(opposite, 1 + size, np.maximum(*ends))

    def curvature(self, a: np.ndarray, b: np.ndarray, of_phase: bool = False) -> np.ndarray:
        """What |d2/da2 log G| cannot exceed on [a, b]; of its phase, in which roots on the circle turn evenly."""
        size, root, angle, turning = self._roots
        if of_phase:
            size, root, angle = size[turning], root[turning], angle[turning]
        across = np.minimum(abs(np.sin((a - angle) / 2)), abs(np.sin((b - angle) / 2)))
        squared = (1 - size) ** 2 + np.where((a <= angle) & (angle <= b), 0.0, 2 * root * across) ** 2
        with np.errstate(divide="ignore"):
            return np.asarray((size / squared).sum(axis=0))

    @cached_property
    def _roots(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Size, its root and angle of zeros and poles, as columns; which do not lie on the circle."""
        roots = np.concatenate([self.zeros, self.poles])
        size = abs(roots)[:, None]
        return size, np.sqrt(size), np.angle(roots)[:, None], ~on_circle(roots)

    @cached_property
    def start(self) -> float:
        """An angle below which nothing but a pole or zero at z = 1 is felt."""
        far = [abs(1 - r) for r in (*self.zeros, *self.poles) if r != 1]
        return 1e-4 * min([*far, 1.0])

    def _monotone(self, of_phase: bool) -> np.ndarray:
        """Cuts of [start, pi] between which log|G|, or its phase, is proved monotone, or finer than matters."""
        a = np.concatenate([np.geomspace(self.start, np.pi, 60)])
        axis = [abs(np.angle(r)) for roots in (self.zeros, self.poles) for r in roots[on_circle(roots)]]
        a = np.unique(np.concatenate([a, [x for x in axis if self.start < x < np.pi]]))
        low, high, done = a[:-1], a[1:], [a]
        while low.size:
            middle = (low + high) / 2
            slope = self.log_slope(middle)
            slope, bend = slope.imag if of_phase else slope.real, self.curvature(low, high, of_phase)
            open_ = (abs(slope) <= bend * (high - low) / 2) & (high - low > FINEST * high)
            share = np.arange(PARTS + 1)[:, None] / PARTS
            cuts = low[open_] + share * (high[open_] - low[open_])
            done.append(cuts[1:-1].ravel())
            low, high = cuts[:-1].ravel(), cuts[1:].ravel()
        return np.unique(np.concatenate(done))

    @cached_property
    def _lists(self) -> tuple[list[complex], list[complex]]:
        return self.zeros.tolist(), self.poles.tolist()

    def _log_magnitude(self, a: float) -> float:
        """log|G| for one angle, in Python's numbers: root finding asks for one at a time."""
        back, (zeros, poles) = cmath.exp(-1j * a), self._lists
        above, below = math.prod(abs(1 - z * back) for z in zeros), math.prod(abs(1 - p * back) for p in poles)
        return math.log(abs(self.k) * above / below)

    def _phase_at(self, a: float) -> float:
        """`phase` for one angle."""
        back, (zeros, poles) = cmath.exp(-1j * a), self._lists
        start = 0.0 if self.k > 0 else -math.pi
        return (
            start - self.d * a + sum(_turned_at(z, a, back) for z in zeros) - sum(_turned_at(p, a, back) for p in poles)
        )

    @cached_property
    def gain_crossovers(self) -> np.ndarray:
        """All angles in (0, pi) with |G| = 1, ascending."""
        from scipy.optimize import brentq

        cuts = self._monotone(of_phase=False)
        with np.errstate(divide="ignore"):
            level = np.log(abs(self(cuts)))
            sides = np.where(np.isfinite(level), np.sign(level), 0.0)
        found = [
            brentq(self._log_magnitude, cuts[i], cuts[i + 1], xtol=1e-15 * cuts[i + 1], rtol=1e-14)
            for i in np.flatnonzero(sides[:-1] * sides[1:] < 0)
        ]
        return np.array(found)

    def roots_outside(self) -> int:
        """How many roots of num + den lie outside the unit circle, by the turning of 1 + G from a = 0 to pi.

        As in `stability`: where |G| < 1 the argument of 1 + G stays within a right angle of 0, where |G| > 1 of that of
        G, and both meet at the gain crossovers. Raises ValueError where a root lies on the circle within 1e-9.
        """
        a = self.gain_crossovers
        ends = np.concatenate([[self.start], a, [np.pi]])
        between = (ends[:-1] + ends[1:]) / 2
        loud = abs(self(between)) > 1
        turns = 0.0
        for at, falls, passes in zip(a, loud[:-1], loud[:-1] != loud[1:], strict=True):
            whole = float(self.phase(np.array(at))) / (2 * np.pi)
            if passes and abs(abs(whole - round(whole)) - 0.5) < ON_CIRCLE:
                raise ValueError(f"a root lies on the unit circle at the angle {at:.6g}")
            turns += passes * round(whole) * (1 if falls else -1)
        for p in self.poles[on_circle(self.poles)]:
            if (abs(self.zeros - p) <= ON_CIRCLE * abs(1 - p)).any():
                raise ValueError(f"a root on the unit circle at z = {p:.6g} is cancelled: the loop cannot move it")
        turns += (self._half_turns(np.pi, -1.0, loud[-1]) - self._half_turns(self.start, 1.0, loud[0])) / 2
        return int(((abs(self.poles) > 1) & ~on_circle(self.poles)).sum() - round(2 * turns))

    def _half_turns(self, a: float, z: float, loud: bool) -> int:
        """The argument of 1 + G at z = 1 or -1, where G is real, in half turns; poles and zeros there as if inside."""
        here = int((self.poles == z).sum()) - int((self.zeros == z).sum())
        if not here and abs(1 + float(self(np.array(a if z < 0 else 0.0)).real)) < ON_CIRCLE:
            raise ValueError(f"a root lies on the unit circle at z = {z:g}")
        return round(float(self.phase(np.array(a))) / np.pi + here / 2) if loud else 0

    @cached_property
    def phase_crossovers(self) -> np.ndarray:
        """All angles in [0, pi] with G real and negative, ascending; the ends where G is finite there."""
        from scipy.optimize import brentq

        cuts = self._monotone(of_phase=True)
        low, high = cuts[:-1] + 1e-13 * cuts[1:], cuts[1:] - 1e-13 * cuts[1:]
        turns = np.sort((np.array([self.phase(low), self.phase(high)]) / np.pi - 1) / 2, axis=0)
        first, last = np.ceil(turns[0]), np.floor(turns[1])
        found = []
        for i in np.flatnonzero(first <= last):
            for k in np.arange(first[i], last[i] + 1):
                gap = lambda x, level=(2 * k + 1) * math.pi: self._phase_at(x) - level  # noqa: E731
                if gap(low[i]) * gap(high[i]) < 0:
                    found.append(brentq(gap, low[i], high[i], xtol=1e-15 * cuts[i + 1]))
        ends = [x for x in (0.0, np.pi) if np.isfinite(v := self(np.array(x))) and v.real < 0 and abs(v) > 1e-12]
        return np.unique(np.array([*(x for x in found if x < np.pi * (1 - 1e-9)), *ends]))


def on_circle(r: np.ndarray) -> np.ndarray:
    """Which roots lie on the unit circle within rounding, measured by how far from z = 1 they are."""
    return abs(abs(r) - 1) <= np.maximum(ON_CIRCLE * abs(1 - r), ROUNDING)


def _turned_at(r: complex, a: float, back: complex) -> float:
    """arg(1 - r exp(-ja)) for one root and one angle, continuous as in `_turned`."""
    if abs(abs(r) - 1) <= max(ON_CIRCLE * abs(1 - r), ROUNDING):
        x = a - cmath.phase(r)
        return (math.pi / 2 if x >= 0 else -math.pi / 2) - x / 2
    if abs(r) < 1:
        return cmath.phase(1 - r * back)
    return cmath.phase(-r) - a + cmath.phase(1 - 1 / (back * r))


def _turned(roots: np.ndarray, a: np.ndarray) -> np.ndarray:
    """arg(1 - r exp(-ja)) summed over the roots, continuous but for roots on the circle."""
    total = np.zeros(np.shape(a))
    for r in roots:
        if on_circle(r):
            x = a - np.angle(r)
            total = total + np.where(x >= 0, np.pi / 2, -np.pi / 2) - x / 2
        elif abs(r) < 1:
            total = total + np.angle(1 - r * np.exp(-1j * a))
        else:
            total = total + np.angle(-r) - a + np.angle(1 - np.exp(1j * a) / r)
    return total
