"""The phase of a process without jumps, and the frequency at which it passes an angle, certified.

Dead time enters exactly. Frequencies in rad/s, angles in rad.
"""

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np

from loopbook.loop.transfer import LoopTransfer
from loopbook.numerics.real_numbers import real
from loopbook.process.transfer_function import Process
from loopbook.refusal import Refusal

BESIDE = 1e-13
FAR = 1e9


class NoSuchFrequency(Refusal):
    """The phase never gets to the angle asked for."""


def phase(process: Process, w: np.ndarray) -> np.ndarray:
    """The angle of G(i w) without jumps, shape of w: 0 (or -90 degrees an integrator) at w = 0.

    Each zero and pole turns by its own angle, which needs no unwrapping; a real pole in the right half plane begins at
    -180 degrees, as in 1/(s/p - 1), and comes back. A gain that is negative in that sense is taken as positive.

    >>> np.degrees(phase(Process((1.0,), (1.0, 1.0, 0.0)), np.array([1.0])))
    array([-135.])
    """
    transfer, start = upright(process)
    return transfer.phase(np.asarray(w, dtype=float)) + start


@lru_cache(maxsize=64)
def upright(process: Process) -> tuple[LoopTransfer, float]:
    """The process with the sign that makes its gain positive, and what its phase lacks of `LoopTransfer.phase`."""
    transfer = LoopTransfer(process.num, process.den, process.delay)
    beginning = -math.pi * int(((transfer.poles.real > 0) & (transfer.poles.imag == 0)).sum())
    if round((transfer.phase_at_start - beginning) / math.pi) % 2:
        transfer = LoopTransfer(tuple(-c for c in process.num), process.den, process.delay)
    return transfer, beginning - transfer.phase_at_start


def frequency_at(process: Process, angle: float) -> float:
    """The lowest frequency [rad/s] at which the phase passes `angle` [rad], downwards or upwards, to rounding.

    Raises NoSuchFrequency where the phase never gets there.

    >>> round(frequency_at(Process((1.0,), (1.0, 3.0, 3.0, 1.0)), -math.pi), 9)
    1.732050808
    """
    angle = real(angle, "angle")
    transfer, start = upright(process)
    w = first_passing(transfer, lambda before, after: [angle - start])
    if w is None:
        raise never(transfer, start, angle)
    return w


def first_passing(transfer: LoopTransfer, levels: Callable[[float, float], Sequence[float]]) -> float | None:
    """The lowest w [rad/s] at which the phase crosses one of the levels that lie between its values at two ends."""
    from scipy.optimize import brentq

    inside, time = transfer.own_units
    ends = [inside.beginning, *inside.monotone_phase.tolist(), _where_it_ends(inside)]
    for low, high in ((a * (1 + BESIDE), b * (1 - BESIDE)) for a, b in pairwise(ends)):
        before, after = inside.phase_at(low), inside.phase_at(high)
        for level in sorted(levels(before, after), key=lambda x: abs(x - before)):
            if (before - level) * (after - level) < 0:
                gap = lambda x, c=level: inside.phase_at(math.exp(x)) - c  # noqa: E731
                return math.exp(brentq(gap, math.log(low), math.log(high), xtol=1e-15, rtol=1e-15)) / time
    return None


def _where_it_ends(inside: LoopTransfer) -> float:
    """A frequency beyond which the phase turns no more; with dead time, beyond which it has turned once more."""
    corners = [abs(r) for r in (*inside.zeros, *inside.poles)]
    if not inside.delay:
        return FAR * max(corners, default=1.0) or FAR
    w = max([*corners, *inside.monotone_phase, 1 / inside.delay])
    last = inside.phase_at(w)
    while inside.phase_at(w) > min(last, -math.pi) - 2 * math.pi:
        w *= 2
    return w


def never(transfer: LoopTransfer, start: float, angle: float) -> NoSuchFrequency:
    inside, _ = transfer.own_units
    low, high = (math.degrees(inside.phase_at(w) + start) for w in (inside.beginning, _where_it_ends(inside)))
    return NoSuchFrequency(
        f"the phase of the process runs from {low:.0f} to {high:.0f} degrees and does not pass "
        f"{math.degrees(angle):.0f} degrees"
    )
