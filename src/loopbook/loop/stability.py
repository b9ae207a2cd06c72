"""How many zeros of d(s) + n(s) exp(-L s) lie in the right half plane: an argument count, exact for dead time.

With G = n/d exp(-Ls) and P zeros of d in the right half plane,

    Z = P - (1/pi) (change of arg(1 + G) along s = 0+ ... j infinity)

Where |G| < 1, the argument of 1 + G stays within a right angle of 0; where |G| > 1, that of 1 + G = G (1 + 1/G) stays
within a right angle of the argument phi of G. Both meet where |G| = 1, at the gain crossovers w_i, so the change is

    2 pi (sum of the nearest whole number to phi(w_i)/2 pi, + where |G| falls through 1, - where it rises) - phi(0+)

with phi(0+) only where |G| > 1 there. The w_i are roots of a polynomial and phi is a sum over poles and zeros less
w L: Z is a sum of whole numbers, and no grid of frequencies enters.
"""

import cmath
import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.numerics import horner
from loopbook.numerics.roots import clearly_left, count_right, undecided
from loopbook.numerics.units import rounded_sum

BORDER = 1e-9
NARROW = 4e-7
FASTEST = 200.0


class BorderError(LoopError):
    """A root of 1 + G lies on the imaginary axis at s = jw, w [rad/s], within rounding: no count holds."""

    def __init__(self, w: float, hidden: bool = False):
        self.w, self.hidden = w, hidden
        at = f"s = {w:.6g}j" if w else "s = 0"
        super().__init__(
            f"the loop is not internally stable: process and regulator cancel a factor at {at}, a mode that the loop "
            "cannot move and that signals inside it show"
            if hidden
            else f"the loop is on the border of stability: 1 + G has a root on the imaginary axis, {at}"
        )


class Crossing(NamedTuple):
    """A gain crossover: w [rad/s], phase [rad] (continuous), falls: does the magnitude fall through 1 there?"""

    w: float
    phase: float
    falls: bool


def crossings(loop: LoopTransfer) -> list[Crossing]:
    """The gain crossovers where the magnitude passes 1 (touching it does not count), ascending."""
    w = loop.gain_crossovers
    if not w.size:
        return []
    between = np.concatenate([[w[0] / 2], np.sqrt(w[:-1] * w[1:]), [2 * w[-1]]])
    loud = loop.magnitude(between) > 1
    passed = np.flatnonzero(loud[:-1] != loud[1:])
    phases = loop.phase(w[passed])
    return [Crossing(*row) for row in zip(w[passed].tolist(), phases.tolist(), loud[passed].tolist(), strict=True)]


def loud_at_start(loop: LoopTransfer, passed: list[Crossing]) -> bool:
    """Is the magnitude above 1 for w to 0, with those `crossings`?"""
    return passed[0].falls if passed else bool(loop.own_units[0].magnitude(1.0) > 1)


def unstable_roots(loop: LoopTransfer) -> float:
    """The number of roots of d + n exp(-Ls) with a positive real part, each counted with its multiplicity.

    inf where the gain at infinity reaches 1 and there is dead time (a neutral loop: a chain of roots on the right).
    Raises BorderError, a LoopError, for a loop with a root on the imaginary axis (within 1e-9 of its size), as no count
    holds there, also for one that is hidden; and LoopError for a loop transfer with more zeros than poles.

    >>> unstable_roots(LoopTransfer([1.5], [1, 0], 1.0)), unstable_roots(LoopTransfer([1.6], [1, 0], 1.0))
    (0, 2)
    """
    if loop.gain_at_infinity == np.inf:
        raise LoopError("the loop transfer has more zeros than poles: filter the derivative to ask for stability")
    if loop.hidden:
        raise BorderError(0.0, hidden=True)
    inside, time = loop.own_units
    try:
        return _rational(inside) if not inside.delay or not any(inside.num) else _delayed(inside)
    except BorderError as error:
        raise BorderError(error.w / time, error.hidden) from None


def _delayed(loop: LoopTransfer) -> float:
    if loop.gain_at_infinity >= 1:
        return np.inf
    if abs(loop.den[-1] + loop.num[-1]) <= BORDER * (abs(loop.den[-1]) + abs(loop.num[-1])):
        raise BorderError(0.0)
    turns, passed = 0.0, crossings(loop)
    for crossing in passed:
        whole = crossing.phase / (2 * np.pi)
        if abs(abs(whole - round(whole)) - 0.5) < BORDER:
            raise BorderError(crossing.w)
        turns += round(whole) * (1 if crossing.falls else -1)
    if loud_at_start(loop, passed):
        turns -= loop.phase_at_start / (2 * np.pi)
    hidden = _common_on_axis(loop)
    if hidden is not None:
        raise BorderError(hidden, hidden=True)
    return int(np.round((loop.poles.real > 0).sum() - 2 * turns))


def _rational(loop: LoopTransfer) -> int:
    """The roots of d + n themselves, without dead time."""
    total = rounded_sum(loop.den, loop.num)
    if not total[0]:
        raise BorderError(np.inf)
    if clearly_left(total.tolist()):
        return 0
    roots = np.roots(total)
    width = np.abs(np.array(loop.den))
    width[len(width) - len(loop.num) :] += np.abs(loop.num)
    w, certain = undecided(total, width, roots, BORDER)
    if w is not None:
        hidden = _common_on_axis(loop)
        raise BorderError(w if hidden is None else hidden, hidden is not None)
    return int((roots.real > 0).sum()) if certain else count_right(total.tolist())


def _common_on_axis(loop: LoopTransfer) -> float | None:
    """A frequency at which num and den both vanish: a mode that the loop cannot touch."""
    axis = loop.poles[loop.poles.real == 0]
    for p in axis:
        if (abs(loop.zeros - p) <= BORDER * abs(p)).any():
            return abs(float(p.imag))
    return None


def is_stable(loop: LoopTransfer) -> bool:
    """Do all roots of d + n exp(-Ls) lie to the left of the imaginary axis? False on the axis itself."""
    try:
        return unstable_roots(loop) == 0
    except BorderError:
        return False


def shifted(loop: LoopTransfer, sigma: float) -> LoopTransfer:
    """The loop with s replaced by s - sigma: its roots lie sigma [1/s] further to the right."""

    def moved(p: Sequence[float]) -> tuple[float, ...]:
        c = list(p)
        for last in range(len(c), 1, -1):
            for i in range(1, last):
                c[i] -= sigma * c[i - 1]
        return tuple(c)

    growth = math.exp(loop.delay * sigma)
    return LoopTransfer(tuple(growth * c for c in moved(loop.num)), moved(loop.den), loop.delay)


def decay_rate(loop: LoopTransfer) -> float:
    """The largest sigma [1/s] with all roots to the left of -sigma: how fast the slowest mode of a stable loop dies.

    Certain to a relative 1e-6: the argument count holds at the sigma returned and not at 1.000001 times that. A root
    found by Newton's method tells where to count; without one the count is bisected, with the roots of each loop on the
    way as new starts. Raises LoopError for a loop that
    is not stable.
    """
    if unstable_roots(loop):
        raise LoopError("the loop is unstable: nothing decays")
    inside, time = loop.own_units

    def holds(sigma: float) -> bool:
        if inside.delay * sigma > FASTEST:  # exp, squared, would overflow, and no loop with dead time decays so fast
            return False
        try:
            return unstable_roots(shifted(inside, sigma)) == 0
        except (LoopError, ValueError):
            return False

    guess = _slowest_root(inside)
    if guess > 0 and holds(guess * (1 - NARROW)) and not holds(guess * (1 + NARROW)):
        return guess * (1 - NARROW) / time
    return _bisected(inside, holds) / time


def _bisected(loop: LoopTransfer, holds: Callable[[float], bool]) -> float:
    radius = max((abs(r) for r in (*loop.poles, *loop.zeros)), default=0.0)
    high = max(radius, 1 / loop.delay if loop.delay else 0.0) or 1.0
    for _ in range(60):
        if not holds(high):
            break
        high *= 2
    low = high
    for _ in range(200):
        low /= 2
        if holds(low):
            break
    else:
        raise LoopError("the loop decays too slowly to be told from the border of stability")
    high = 2 * low if low < high else high
    while high - low > 1e-6 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
        starts = [-middle, *(1j * shifted(loop, middle).gain_crossovers - middle).tolist()] if loop.delay else []
        guess = _rightmost(loop, starts)
        if low < guess < high and holds(guess * (1 - NARROW)) and not holds(guess * (1 + NARROW)):
            return guess * (1 - NARROW)
    return low


def _slowest_root(loop: LoopTransfer) -> float:
    """-Re of the rightmost root of d + n exp(-Ls) among those to which Newton's method leads; inf without any.

    It starts from the gain crossovers on the imaginary axis and from the zeros and poles of the loop transfer; without
    dead time from the roots themselves.
    """
    starts = (*(1j * loop.gain_crossovers).tolist(), *loop.zeros.tolist(), *loop.poles.tolist())
    return _rightmost(loop, starts if loop.delay else np.roots(rounded_sum(loop.den, loop.num)).tolist())


def _rightmost(loop: LoopTransfer, starts: Iterable[complex]) -> float:
    found = math.inf
    for s in starts:
        for _ in range(40):
            if loop.delay * s.real <= -FASTEST:
                break
            (n, dn), (d, dd) = horner.with_slope(loop.num, s), horner.with_slope(loop.den, s)
            turn = cmath.exp(-loop.delay * s)
            slope = dd + (dn - loop.delay * n) * turn
            if not slope or not cmath.isfinite(slope):
                break
            change = (d + n * turn) / slope
            s -= change
            if abs(change) <= 1e-13 * abs(s):
                found = min(found, -s.real)
                break
    return found
