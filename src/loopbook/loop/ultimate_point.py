"""The ultimate point of a process: where a proportional loop just keeps oscillating, its gain and its frequency.

1 + Ku G(j w180) = 0,   K180 = 1/Ku = |G(j w180)|,   T180 = 2 pi/w180
"""

import math
from dataclasses import dataclass
from itertools import pairwise

from loopbook.loop.process_phase import BESIDE, NoSuchFrequency, first_passing, frequency_at, never, upright
from loopbook.loop.stability import is_stable
from loopbook.loop.transfer import LoopTransfer
from loopbook.process.transfer_function import Process

__all__ = ["FrequencyPoint", "NoSuchFrequency", "ultimate"]

TURNS = (1 + 1e-9, 30.0, 1e3)
NEGLIGIBLE = 1e12


@dataclass(frozen=True)
class FrequencyPoint:
    """The process where its phase is -180 degrees: K180 = |G| [y/u], w180 [rad/s], T180 = 2 pi/w180 [s]."""

    K180: float
    w180: float

    @property
    def T180(self) -> float:
        return 2 * math.pi / self.w180


def ultimate(process: Process) -> FrequencyPoint:
    """The ultimate point: a proportional regulator with the gain 1/K180 just keeps the process oscillating at w180.

    The phase is -180 degrees there (or that less whole turns). Of several such frequencies it is the one with the least
    gain at which the proportional loop, stable just below, becomes unstable; for a process that only a large gain
    holds, the one at which it becomes stable.
    Raises NoSuchFrequency for a process that never lags so far, such as one of first or second order without dead time,
    and for one that no proportional gain holds.

    >>> point = ultimate(Process((1.0,), (1.0, 3.0, 3.0, 1.0)))
    >>> round(point.K180, 9), round(point.T180, 6)
    (0.125, 3.627599)
    >>> round(1 / ultimate(Process((1.0,), (1.0, -1.0), 0.2)).K180, 3)
    7.23
    """
    transfer, start = upright(process)
    if not transfer.zeros.size and (abs(transfer.poles.imag) <= -transfer.poles.real).all():
        w = frequency_at(process, -math.pi)  # phase and magnitude fall all the way: the first is the only one
        return FrequencyPoint(float(transfer.magnitude(w)), w)
    first = first_passing(transfer, _odd_turns)
    if first is None:
        raise never(transfer, start, -math.pi)
    begins = None
    for turns in TURNS if transfer.delay else (NEGLIGIBLE,):
        found = _borders(transfer, float(transfer.magnitude(first)) / turns)
        gains = [gain for gain, _ in found]
        between = [gains[0] / 2, *(math.sqrt(a * b) for a, b in pairwise(gains)), 2 * gains[-1]] if gains else []
        held = False
        for i, K in enumerate(between):
            holds = is_stable(LoopTransfer(tuple(K * c for c in transfer.num), transfer.den, transfer.delay))
            gain, w = found[i - 1]
            if i and w and held and not holds:
                return FrequencyPoint(1 / gain, w)
            if i and w and holds and not held and begins is None:
                begins = FrequencyPoint(1 / gain, w)
            held = holds
    if begins is not None:
        return begins
    raise NoSuchFrequency(
        "no proportional gain holds the process, or only the lowest bounds it: no oscillation ends it"
    )


def _borders(transfer: LoopTransfer, floor: float) -> list[tuple[float, float]]:
    """(gain, w) at which the proportional loop has a root on the axis, ascending in the gain, where |G| >= floor.

    w = 0 also stands for the limit of infinite frequency: what bounds the gain there is no oscillation.
    """
    at_infinity = transfer.gain_at_infinity
    floor = max(floor, at_infinity * (1 + BESIDE)) if transfer.delay else floor
    found = [(1 / float(transfer.magnitude(w)), float(w)) for w in transfer.phase_crossovers(floor)]
    if transfer.num[-1] and transfer.den[-1] and transfer.num[-1] / transfer.den[-1] < 0:
        found.append((-transfer.den[-1] / transfer.num[-1], 0.0))
    if at_infinity and (transfer.delay or transfer.num[0] / transfer.den[0] < 0):
        found.append((1 / at_infinity, 0.0))
    return sorted(found)


def _odd_turns(before: float, after: float) -> list[float]:
    """The lowest and the highest odd multiple of pi between two phases."""
    low, high = sorted((before, after))
    k = math.ceil((low / math.pi - 1) / 2), math.floor((high / math.pi - 1) / 2)
    return [(2 * i + 1) * math.pi for i in k] if k[0] <= k[1] else []
