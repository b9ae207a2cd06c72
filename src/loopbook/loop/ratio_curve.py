"""A quotient of exponential polynomials on the imaginary axis, with what bounds it: for peaks and crossovers.

    W(jw) = (jw)^k N(jw)/D(jw)

On an interval with the middle m and half the length r, Taylor's formula to the second order bounds |N|, |N'| and |N''|
from above and |N| from below, the same for D; hence |W|, the pace |W'/W| and how fast that changes. An interval where
|W| cannot be 1, or its argument not pi, is left; one where log|W|, or the argument, is proved monotone is bracketed.
Factors s of all terms are the power k, which turns the argument by whole right angles only.
"""

import math
from typing import NamedTuple

import numpy as np

from loopbook.loop.sensitivity_peaks import CERTAIN, NyquistCurve
from loopbook.loop.transfer import LoopError
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial

FINEST, MOST = 1e-11, 400_000
SLOWEST, FASTEST = 1e-14, 1e30


class _Sizes(NamedTuple):
    """On each interval: what |f| exceeds, what it cannot, and what |f'| and |f''| cannot."""

    least: np.ndarray
    most: np.ndarray
    slope: np.ndarray
    bend: np.ndarray


def _sizes(f: ExponentialPolynomial, a: np.ndarray, b: np.ndarray) -> _Sizes:
    middle, half = (a + b) / 2, (b - a) / 2
    value, slope = np.zeros(middle.shape, complex), np.zeros(middle.shape, complex)
    bend = np.zeros(middle.shape)
    for (delay, _), (turn, c) in zip(f.terms, f.taylor(1j * middle), strict=True):
        size = np.abs(c)
        value = value + turn * c[0]
        slope = slope + turn * ((c[1] if len(c) > 1 else 0.0) - delay * c[0])
        bend = bend + _most(size, half, 2) + 2 * delay * _most(size, half, 1) + delay**2 * _most(size, half, 0)
    move = np.abs(slope) * half + bend * half**2 / 2
    least, most = np.maximum(np.abs(value) - move, 0.0), np.abs(value) + move
    return _Sizes(least, most, np.abs(slope) + bend * half, bend)


def _most(size: np.ndarray, half: np.ndarray, order: int) -> np.ndarray:
    """What a derivative of that order cannot exceed, size: of the Taylor coefficients in the middle."""
    total = np.zeros(half.shape)
    for k in range(len(size) - 1, order - 1, -1):
        total = total * half + math.perm(k, order) * size[k]
    return total


class RatioCurve(NyquistCurve):
    """num/den in units of their own time, strictly proper. inverse: den/num instead, for Mt."""

    def __init__(self, num: ExponentialPolynomial, den: ExponentialPolynomial, inverse: bool = False):
        self._loop, self.inverse = (num, den), inverse
        above, below = (den, num) if inverse else (num, den)
        zeros, poles = _factors_s(above), _factors_s(below)
        self.power, self.above, self.below = zeros - poles, above.over_s(zeros), below.over_s(poles)
        self.slopes = self.above.derivative(), self.below.derivative()

    def __call__(self, w: np.ndarray) -> np.ndarray:
        s = 1j * np.asarray(w, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(s**self.power * (self.above(s) / self.below(s)))

    def _own_slope(self, w: np.ndarray) -> np.ndarray:
        s = 1j * np.asarray(w, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(1j * (self.slopes[0](s) / self.above(s) - self.slopes[1](s) / self.below(s)))

    def log_slope(self, w: np.ndarray) -> np.ndarray:
        """d log W/dw."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self._own_slope(w) + self.power / np.asarray(w)

    def _own_extent(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """`extent` of N/D without the power of s."""
        n, d = _sizes(self.above, a, b), _sizes(self.below, a, b)
        pace = n.slope / n.least + d.slope / d.least
        bend = n.bend / n.least + (n.slope / n.least) ** 2 + d.bend / d.least + (d.slope / d.least) ** 2
        return n.least / d.most, n.most / d.least, pace, bend

    def extent(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """On each [a, b]: what |W| exceeds and what it cannot, what |d log W/dw| and |d2 log W/dw2| cannot."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            least, most, pace, bend = self._own_extent(a, b)
            ends = a**self.power, b**self.power
            k = abs(self.power)
            turned, bent = (k / a, k / a**2) if k else (0.0, 0.0)
            return least * np.minimum(*ends), most * np.maximum(*ends), pace + turned, bend + bent

    def quiet_from(self, level: float) -> float:
        """A frequency beyond which |num/den| stays below a level."""
        num, den = self._loop
        w = 1.0
        while not _tail(num, den, w) < level:
            w *= 1.5
            if w > FASTEST:
                raise LoopError("the loop gain does not fall off with frequency: its margins cannot be certified")
        while w > SLOWEST and _tail(num, den, w / 1.5) < level:
            w /= 1.5
        return w

    def loud_until(self) -> float:
        """A frequency below which log|W| falls or rises as w^k alone and does not pass 0."""
        w = min(1.0, self.quiet_from(0.5))
        while w > SLOWEST:
            whole = np.array([0.0]), np.array([w])
            with np.errstate(divide="ignore", invalid="ignore"):
                least, most, pace, _ = self._own_extent(*whole)
            near = bool(pace[0] * w < 0.1)
            sides = least[0] * w**self.power > 1 if self.power < 0 else most[0] * w**self.power < 1 or least[0] > 1
            if near and (sides or not self.power):
                break
            w /= 4
        return w

    def grid(self) -> tuple[np.ndarray, float, float]:
        """Where to search, and the best of the curve's two ends: value, w."""
        high = self.quiet_from(0.5)
        low = 1e-4 * min(high, 1.0)
        w = np.geomspace(low, high, 200)
        distances = self.distance(np.append(1e-9 * low, w))
        end = (float(distances[0]), 0.0)
        if not self.inverse:
            end = min(end, (1.0, np.inf))
        best = min(end[0], float(np.min(distances[1:])), 1.0)
        farther = self.quiet_from(max(1 - best * (1 - CERTAIN), 1e-6)) if not self.inverse else self.quiet_from(0.4)
        more = np.geomspace(high, farther, 50)[1:] if farther > high else np.zeros(0)
        return np.concatenate([[0.0], w, more]), *end

    def gain_crossovers(self) -> np.ndarray:
        """All w > 0 with |W| = 1, ascending; touching does not count."""
        from scipy.optimize import brentq

        level = lambda w: math.log(abs(complex(self(np.array(w)))))  # noqa: E731
        found = []
        for a, b in self._pieces(phase=False, last=self.quiet_from(0.999)):
            before, after = level(a), level(b)
            if before * after < 0:
                found.append(float(brentq(level, a, b, xtol=1e-15 * b, rtol=1e-14)))
        return np.unique(np.array(found))

    def phase_crossovers(self, floor: float) -> np.ndarray:
        """All w > 0 with W real and negative and |W| >= floor, ascending."""
        from scipy.optimize import brentq

        turned = lambda w: float(np.angle(-complex(self(np.array(w)))))  # noqa: E731
        found = []
        for a, b in self._pieces(phase=True, last=self.quiet_from(floor)):
            before, after = turned(a), turned(b)
            if before * after < 0 and abs(before - after) < math.pi:
                w = float(brentq(turned, a, b, xtol=1e-15 * b, rtol=1e-14))
                if abs(complex(self(np.array(w)))) >= floor:
                    found.append(w)
        return np.unique(np.array(found))

    def _pieces(self, phase: bool, last: float) -> list[tuple[float, float]]:
        """Intervals that may hold a crossover and on which what crosses is monotone, or too short to matter."""
        edges = np.geomspace(min(self.loud_until(), last / 2), last, 300)
        a, b, kept, looked = edges[:-1], edges[1:], [], 0
        while a.size:
            looked += a.size
            if looked > MOST:
                raise LoopError("the loop has more turns than can be searched for crossovers")
            middle, half = (a + b) / 2, (b - a) / 2
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                if phase:
                    _, _, pace, bend = self._own_extent(a, b)
                    possible = ~(np.abs(np.angle(-self(middle))) > pace * half)
                    sure = (np.abs(self._own_slope(middle).imag) > bend * half) & (pace * half < 1)
                else:
                    least, most, _, bend = self.extent(a, b)
                    possible = ~((least > 1) | (most < 1))
                    sure = np.abs(self.log_slope(middle).real) > bend * half
            done = possible & (sure | (half <= FINEST * b))
            kept += [*zip(a[done].tolist(), b[done].tolist(), strict=True)]
            again = possible & ~done
            a, b, middle = a[again], b[again], middle[again]
            a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
        return sorted(kept)


def _factors_s(f: ExponentialPolynomial) -> int:
    """How many factors s all terms share."""
    return min(p[::-1].index(next(c for c in reversed(p) if c)) for _, p in f.terms)


def _tail(num: ExponentialPolynomial, den: ExponentialPolynomial, w: float) -> float:
    """What |num/den| cannot exceed beyond w, infinite where nothing can be said."""

    def size(f: ExponentialPolynomial) -> float:
        return sum(float(np.abs(p) @ w ** (np.arange(len(p))[::-1] - float(den.degree))) for _, p in f.terms)

    lead = abs(den.terms[0][1][0])
    below = 2 * lead - size(den)
    return size(num) / below if below > 0 else math.inf
