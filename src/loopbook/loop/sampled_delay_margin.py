"""The delay margin of a sampled loop: the least dead time, added to the continuous process, that brings a root to the
unit circle. Solved, not searched in steps.

A dead time of (l + f) sampling intervals, l whole and 0 <= f < 1, gives the loop

    M(z) + z^-l N(z, f) = 0,     M = A R,   N = S B_f

with B_f(z) the sampled numerator for the fraction f, an entire function of f. On z = exp(ja) a root needs |N| = |M| and

    l a = arg(-N/M) + 2 pi k

Boxes of (a, f) are dropped where bounds on the change of M and N over them prove one of the two impossible, for every
l and k that the best solution so far leaves open; the others are halved. Newton's method in the boxes that could come
first finds that solution to rounding.
"""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev

from loopbook.controllers.rst import Rst, zeros_of
from loopbook.loop.transfer import LoopError
from loopbook.process.near_one import numerator_near_one
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process

RESOLVED, ROUNDING = 1e-13, 1e-15
FINEST = 1e-11
NEAR = 1e-5
NEWTON, NEWTON_EVERY = 12, 5
BESIDE, JUST, LONGEST = 1e-12, 1e-9, 12
TURNS_TRIED = 64
ROUNDS = 120
MOST_BOXES = 100_000


@dataclass(frozen=True)
class _Numerator:
    """B_f as Chebyshev series in x = 2 f - 1, one column per power of v = 1 - z^-1: values, slopes, and what bends.

    Fast sampling brings all that matters near z = 1, where v is small and powers of z^-1 would cancel each other.
    """

    series: np.ndarray

    @classmethod
    def of(cls, process: Process, h: float) -> "_Numerator":
        whole = sample(process.rational, h)
        for count in (12, 24, 48, 96, 192, 384):
            x = chebyshev.chebpts1(count)
            rows = np.array([numerator_near_one(replace(whole, tau=(v + 1) / 2 * h)) for v in x])
            series = chebyshev.chebfit(x, rows[:, ::-1] @ _to_powers_of_v(rows.shape[1]), count - 1)
            if np.abs(series[-3:]).max() <= RESOLVED * np.abs(series).max():
                break
        return cls(np.where(np.abs(series) > ROUNDING * np.abs(series).max(), series, 0.0))

    @classmethod
    def of_jump(cls, process: Process, h: float) -> "_Numerator":
        """B from a dead time of whole samples (0) to one that is longer by nothing (1), where a process that acts at
        once does so one sample later.
        """
        before = numerator_near_one(sample(process.rational, h))
        acts = before[0] * np.append(np.real(np.poly(np.expm1(process.poles * h))), 0.0)
        before, acts = (p[::-1] @ _to_powers_of_v(len(p)) for p in (before, acts))
        return cls(np.array([before - acts / 2, -acts / 2]))

    @cached_property
    def slopes(self) -> np.ndarray:
        return 2 * chebyshev.chebder(self.series)

    @cached_property
    def bend(self) -> np.ndarray:
        """What |d2/df2| of each coefficient cannot exceed."""
        k = np.arange(len(self.series))[:, None]
        return (4 * np.abs(self.series) * k**2 * (k**2 - 1) / 3).sum(axis=0)

    @cached_property
    def steepest(self) -> np.ndarray:
        k = np.arange(len(self.series))[:, None]
        return (2 * np.abs(self.series) * k**2).sum(axis=0)

    @cached_property
    def largest(self) -> np.ndarray:
        return np.abs(self.series).sum(axis=0)

    def at(self, f: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The coefficients and their slopes over f, shapes (len(f), powers)."""
        powers = chebyshev.chebvander(2 * f - 1, len(self.series) - 1)
        return powers @ self.series, powers[:, :-1] @ self.slopes


def _to_powers_of_v(count: int) -> np.ndarray:
    """(z - 1)^k z^-(count - 1) = v^k (1 - v)^(count - 1 - k) as a matrix: rows k, columns powers of v = 1 - z^-1."""
    rows = np.zeros((count, count))
    for k in range(count):
        rows[k, k:] = [math.comb(count - 1 - k, m) * (-1) ** m for m in range(count - k)]
    return rows


class _Circle:
    """M and N on the unit circle for one loop."""

    def __init__(self, process: Process, regulator: Rst, numerator: _Numerator):
        h, self.numerator = regulator.h, numerator
        S = np.asarray(regulator.S)
        self.lead = int(np.flatnonzero(S)[0])
        self.gain = float(S[self.lead])
        self.zeros = zeros_of(S)
        self.poles = np.concatenate([zeros_of(regulator.R), np.exp(process.poles * h)])

    def start(self) -> float:
        """An angle below which nothing but roots at z = 1 is felt."""
        far = [d for d in abs(1 - np.concatenate([self.zeros, self.poles])) if d > FINEST]
        return 1e-4 * min([*far, 1.0])

    def survey(self, a: np.ndarray, f: np.ndarray, da: np.ndarray, df: np.ndarray) -> tuple[np.ndarray, ...]:
        """For boxes a +- da, f +- df: the least and the largest log|N/M|; arg(-N/M) in the middle, how far it departs
        from that; and what a and f contribute to the change.
        """
        back = np.exp(-1j * a)
        m = np.arange(self.numerator.series.shape[1])
        c, slope = self.numerator.at(f)
        powers = (1 - back)[:, None] ** m
        B, B_f = (c * powers).sum(axis=1), (slope * powers).sum(axis=1)
        B_a = (c[:, 1:] * powers[:, :-1] * m[1:]).sum(axis=1)
        far = 2 * np.sin(np.minimum(a + da, np.pi) / 2)
        reach = far[:, None] ** m
        largest, steepest, bend = self.numerator.largest, self.numerator.steepest, self.numerator.bend
        first = reach[:, :-1] @ (largest * m)[1:] + reach[:, :-2] @ (largest * m * (m - 1))[2:]
        bent_by_f = reach @ bend * df**2 / 2
        curved = first * da**2 / 2 + reach[:, :-1] @ (steepest * m)[1:] * da * df + bent_by_f
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = [da[:, None] / abs(1 / back[:, None] - roots) for roots in (self.zeros, self.poles)]
            moved.append(((abs(B_a) * da + abs(B_f) * df + curved) / abs(B))[:, None])
            (up_s, down_s), (up_m, down_m), (up_b, down_b) = (
                (np.log1p(x).sum(axis=1), np.where(x < 1, np.log1p(-np.minimum(x, 1)), -np.inf).sum(axis=1))
                for x in moved
            )
            up_b = np.where(B == 0, 0.0, up_b)
            of_S, of_M = (np.prod(1 - roots * back[:, None], axis=1) for roots in (self.zeros, self.poles))
            level = np.log(abs(self.gain * of_S / of_M))
            most = level + up_s - down_m + np.where(B == 0, np.log(curved), np.log(abs(B)) + up_b)
            least = level + down_s + np.log(abs(B)) + down_b - up_m
            angle = np.angle(-self.gain * of_S * B * back**self.lead / of_M)
            turned = sum(np.where(x < 1, np.arcsin(np.minimum(x, 1.0)), np.pi).sum(axis=1) for x in moved)
            by_f = (abs(B_f) * df + bent_by_f) / abs(B)
            by_a = moved[0].sum(axis=1) + moved[1].sum(axis=1) + moved[2][:, 0] - by_f
        return least, most, angle, np.minimum(turned + self.lead * da, np.pi), by_a, by_f

    def solve(self, a: float, f: float, whole: int) -> tuple[float, float, int] | None:
        """(a, f, whole) with M + z^-whole N = 0 near by; a fraction past the end is one of the next whole dead time."""
        found = self._newton(a, f, whole)
        if found and not -JUST <= found[1] <= 1 + JUST:
            more = math.floor(found[1])
            whole += more
            found = self._newton(found[0], found[1] - more, whole) if whole >= 0 else None
        if not found or not (0 < found[0] <= math.pi * (1 + 1e-12) and -1e-13 <= found[1] <= 1 + 1e-13):
            return None
        return found[0], min(max(found[1], 0.0), 1.0), whole

    def _newton(self, a: float, f: float, whole: int) -> tuple[float, float] | None:
        """(a, f) by Newton's method on log(-z^-whole N/M)."""
        for _ in range(NEWTON):
            back = cmath.exp(-1j * a)
            c, slope = (row[0] for row in self.numerator.at(np.array([f])))
            m = np.arange(len(c))
            powers = (1 - back) ** m
            B, B_f = complex(c @ powers), complex(slope @ powers)
            B_a = 1j * back * complex((c * m)[1:] @ powers[:-1])
            zs, ps = 1 - self.zeros * back, 1 - self.poles * back
            if not B or not zs.all() or not ps.all():
                return None
            value = -self.gain * np.prod(zs) * B * back ** (self.lead + whole) / np.prod(ps)
            to_a = B_a / B - 1j * (self.lead + whole)
            to_a += (1j * self.zeros * back / zs).sum() - (1j * self.poles * back / ps).sum()
            to_f, wanted = B_f / B, -cmath.log(value)
            below = to_a.real * to_f.imag - to_a.imag * to_f.real
            if not below or not math.isfinite(below):
                return None
            change = (wanted.real * to_f.imag - wanted.imag * to_f.real) / below
            also = (to_a.real * wanted.imag - to_a.imag * wanted.real) / below
            a, f = a + change, f + also
            if not (0 < a < 4 and -1 < f < 2):
                return None
            if abs(change) <= 1e-15 * a and abs(also) <= 1e-15:
                break
        return (a, f) if abs(wanted) < 1e-9 else None


def delay_margin(process: Process, regulator: Rst, holds: Callable[[float], bool]) -> float:
    """The least added dead time [s] that makes a stable loop unstable; inf where none does, as |N| < |M| all around.

    holds: is the loop stable with so much more dead time? It is asked where a process that acts at once jumps.
    """
    if not any(regulator.S) or not any(process.num):
        return math.inf
    h, has = regulator.h, process.delay / regulator.h
    best = math.inf if process.relative_degree else _first_jump(process, regulator, holds)
    if process.order:  # without states nothing moves between the jumps
        best = _first_root(_Circle(process, regulator, _Numerator.of(process, h)), has, best)
    return (best - has) * h


def _first_jump(process: Process, regulator: Rst, holds: Callable[[float], bool]) -> float:
    """The dead time of whole intervals of which the least more makes the loop unstable, of a process that acts at once.

    Where the loop is found unstable before, by then at the latest; inf where neither is found.
    """
    h, has = regulator.h, process.delay / regulator.h
    jumps, end = _Circle(process, regulator, _Numerator.of_jump(process, h)), math.inf
    at = _first_root(jumps, math.ceil(has - BESIDE * max(has, 1)), end)
    while at < end:
        whole = math.floor(at)
        if not holds((max(whole - has, 0.0) + JUST) * h):
            return max(whole, has)
        if math.isinf(end):
            end = next((math.ceil(has + 2.0**i) for i in range(LONGEST) if not holds(2.0**i * h)), math.inf)
        at = _first_root(jumps, whole + 1, end)
    return end


def _first_root(circle: _Circle, has: float, best: float) -> float:
    """The least l + f beyond `has`, below `best`, with a root on the circle; `best` where there is none."""
    at = (0.0, 0.0)
    edges = np.geomspace(circle.start(), np.pi, 120)
    low_a, low_f = (x.ravel() for x in np.meshgrid(edges[:-1], np.linspace(0, 1, 5)[:-1], indexing="ij"))
    boxes = np.array([low_a, np.repeat(edges[1:], 4), low_f, low_f + 0.25])
    for round_ in range(ROUNDS):
        least, most, *change = circle.survey(*_middle(boxes), *_half(boxes))
        passes = (least <= 0) & (most >= 0)
        boxes, (angle, turned, by_a, by_f) = boxes[:, passes], (x[passes] for x in change)
        first, whole = _earliest(boxes, angle, turned, has, best)
        boxes, first, whole, by_a, by_f = (x[..., first < best] for x in (boxes, first, whole, by_a, by_f))
        if boxes.shape[1] > MOST_BOXES:
            raise LoopError("the delay margin could not be certified: the loop has more turns than can be searched")
        away = np.abs(_middle(boxes) - np.array([at]).T) > NEAR * np.array([[at[0]], [1.0]])
        if not away.any():  # nothing is left but the solution itself
            break
        if round_ % NEWTON_EVERY == 0:
            waiting = np.where(away.any(axis=0), first, np.inf)
            next_ = int(np.argmin(waiting))
            later = int(np.argmin(np.where(whole > whole[next_], waiting, np.inf)))
            for i in dict.fromkeys((next_, later)):  # the first may end just short of a root: any bound ends the search
                a, f = _middle(boxes)[:, i].tolist()
                found = circle.solve(a, f, int(whole[i]))
                if found and has * (1 + BESIDE) + BESIDE < found[2] + found[1] < best:
                    best, at = float(found[2] + found[1]), found[:2]
                    break
        boxes = _halved(boxes, by_f >= by_a + whole * _half(boxes)[0])[:, np.tile(first < best, 2)]
    return best


def _middle(boxes: np.ndarray) -> np.ndarray:
    return (boxes[::2] + boxes[1::2]) / 2


def _half(boxes: np.ndarray) -> np.ndarray:
    return (boxes[1::2] - boxes[::2]) / 2


def _halved(boxes: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Each box cut in two: over f where `across`, else over a."""
    (low_a, high_a, low_f, high_f), (a, f) = boxes, _middle(boxes)
    lower = [low_a, np.where(across, high_a, a), low_f, np.where(across, f, high_f)]
    upper = [np.where(across, low_a, a), high_a, np.where(across, f, low_f), high_f]
    return np.hstack([np.array(lower), np.array(upper)])


def _earliest(
    boxes: np.ndarray, angle: np.ndarray, turned: np.ndarray, has: float, best: float
) -> tuple[np.ndarray, np.ndarray]:
    """The least dead time l + f in intervals, beyond `has`, that the phase allows in each box, and its l."""
    low_a, high_a, low_f, high_f = boxes
    least = np.ceil(np.maximum(has - high_f, 0.0) - 1e-12)
    k = np.ceil((least * low_a - angle - turned) / (2 * np.pi))
    whole, waiting = np.full(len(angle), np.inf), np.ones(len(angle), dtype=bool)
    for _ in range(TURNS_TRIED):
        from_, to = (angle - turned + 2 * np.pi * k) / high_a, (angle + turned + 2 * np.pi * k) / low_a
        candidate = np.maximum(least, np.ceil(np.minimum(from_, from_ * high_a / low_a) - 1e-9))
        fits = waiting & (candidate <= to + 1e-9)
        whole[fits] = candidate[fits]
        waiting &= ~fits & (candidate + low_f < best)
        if not waiting.any():
            break
        k = k + 1
    whole = np.where(waiting, np.maximum(least, np.floor((angle - turned + 2 * np.pi * k) / high_a)), whole)
    return np.maximum(whole + low_f, has), whole
