"""Stability margins with exact dead time: what a loop bears in gain, phase and delay, on both sides.

Every gain and phase crossover that counts is found (see `loop_transfer`), so a conditionally stable loop shows its
lower gain margin and a loop with a long dead time the crossover on the turn of the Nyquist curve that decides.
"""

from dataclasses import dataclass

import numpy as np

from loopbook.loop.sensitivity_peaks import Peak, complementary_peak, sensitivity_peak
from loopbook.loop.stability import unstable_roots
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr


@dataclass(frozen=True)
class GainCrossover:
    """A frequency w [rad/s] with |G| = 1. phase_margin: angle of G above -180 degrees, in (-180, 180] [degrees].

    delay_margin: the dead time [s] that turns G to -1 here.
    """

    w: float
    phase_margin: float
    delay_margin: float


@dataclass(frozen=True)
class PhaseCrossover:
    """A frequency w [rad/s] where G is real and negative. gain: the factor [-] that takes G to -1, 1/|G|."""

    w: float
    gain: float

    @property
    def decibels(self) -> float:
        """The factor in dB."""
        return float(20 * np.log10(self.gain))


@dataclass(frozen=True, repr=False)
class Margins(ShortRepr, ShownAsTable):
    """The margins of a stable loop.

    gain: the smallest factor above 1 that makes the loop unstable (inf if none). gain_low: the largest below 1 (0 if
    none). The loop is stable for every factor between the two. phase [degrees]: the smallest of all gain crossovers in
    magnitude; inf without one. delay [s]: the smallest added dead time that makes the loop unstable; inf if none, 0
    where the loop gain does not fall below 1 at high frequency, which no dead time leaves stable.
    Ms, Mt: sensitivity peaks with their frequencies. gain_crossovers, phase_crossovers: all that were compared.
    """

    gain: float
    gain_low: float
    phase: float
    delay: float
    Ms: Peak
    Mt: Peak
    gain_crossovers: tuple[GainCrossover, ...]
    phase_crossovers: tuple[PhaseCrossover, ...]

    @property
    def gain_decibels(self) -> float:
        """The upper gain margin in dB."""
        return float(20 * np.log10(self.gain))

    def table(self) -> PlainTable:
        """Each margin with the frequency at which it is taken."""
        gain = next((c.w for c in self.phase_crossovers if c.gain == self.gain), "")
        low = next((c.w for c in self.phase_crossovers if c.gain == self.gain_low), "")
        phase = next((c.w for c in self.gain_crossovers if c.phase_margin == self.phase), "")
        delay = next((c.w for c in self.gain_crossovers if c.delay_margin == self.delay), "")
        rows = [["gain", self.gain, gain], ["gain, lower", self.gain_low, low], ["phase [°]", self.phase, phase]]
        rows += [["delay [s]", self.delay, delay], ["Ms", self.Ms.value, self.Ms.w], ["Mt", self.Mt.value, self.Mt.w]]
        return PlainTable(["margin", "value", "at [rad/s]"], [r for r in rows if r[:2] != ["gain, lower", 0.0]])


def gain_crossovers(loop: LoopTransfer) -> tuple[GainCrossover, ...]:
    """All gain crossovers with the margin at each, ascending in w. Of any loop, also an unstable one."""
    found = []
    for w in loop.gain_crossovers:
        angle = float(np.angle(-loop(1j * w)))
        found.append(GainCrossover(float(w), float(np.degrees(angle)), (angle % (2 * np.pi)) / float(w)))
    return tuple(found)


def phase_crossovers(loop: LoopTransfer, floor: float | None = None) -> tuple[PhaseCrossover, ...]:
    """The phase crossovers with |G| >= floor, ascending in w; w = 0 where G(0) is finite and negative.

    Without a floor: all with |G| > 1 and, below it, as many turns as show the largest |G| < 1.
    """
    at_zero = _at_zero(loop)
    if floor is not None:
        return tuple(c for c in (*at_zero, *_at(loop, loop.phase_crossovers(floor))) if c.gain <= 1 / floor)
    if not loop.delay:
        found = (*at_zero, *_at(loop, loop.phase_crossovers(1e-15)))
        return tuple(c for c in found if c.gain < 1e12)
    limit = loop.gain_at_infinity
    for floor in (0.5, 0.1, 0.02, 1e-3, 1e-5, 1e-8, 1e-12):
        floor = max(floor, limit * (1 + 1e-6))
        found = (*at_zero, *_at(loop, loop.phase_crossovers(floor)))
        if any(1 < c.gain <= 1 / floor for c in found) or floor > 0.5:
            break
    return found


def _at(loop: LoopTransfer, frequencies: np.ndarray) -> list[PhaseCrossover]:
    return [PhaseCrossover(float(w), float(1 / loop.magnitude(w))) for w in frequencies]


def _at_zero(loop: LoopTransfer) -> list[PhaseCrossover]:
    if loop.den[-1] == 0 or loop.num[-1] == 0:
        return []
    gain = loop.num[-1] / loop.den[-1]
    return [PhaseCrossover(0.0, -1 / gain)] if gain < 0 else []


def margins(loop: LoopTransfer) -> Margins:
    """All margins of a stable loop.

    Raises LoopError where the loop is unstable: a margin says how far a stable loop is from instability, and numbers
    read off an unstable one would mislead. `gain_crossovers` and `phase_crossovers` answer for any loop.
    """
    count = unstable_roots(loop)
    if count:
        raise LoopError(f"the loop is unstable ({count} roots in the right half plane) and has no margins")
    at_gain, at_phase = gain_crossovers(loop), phase_crossovers(loop)
    limit = _at_infinity(loop)
    above = [c.gain for c in at_phase if c.gain > 1] + [g for g in limit if g > 1]
    below = [c.gain for c in at_phase if c.gain < 1] + [g for g in limit if g < 1]
    return Margins(
        gain=min(above, default=np.inf),
        gain_low=max(below, default=0.0),
        phase=min((c.phase_margin for c in at_gain), key=abs, default=np.inf),
        delay=0.0 if loop.gain_at_infinity >= 1 else min((c.delay_margin for c in at_gain), default=np.inf),
        Ms=sensitivity_peak(loop),
        Mt=complementary_peak(loop),
        gain_crossovers=at_gain,
        phase_crossovers=at_phase,
    )


def _at_infinity(loop: LoopTransfer) -> list[float]:
    """The gain that makes the loop's limit at infinite frequency reach 1 (with dead time) or -1 (without)."""
    if len(loop.num) < len(loop.den):
        return []
    limit = loop.num[0] / loop.den[0]
    if loop.delay:
        return [1 / abs(limit)]
    return [-1 / limit] if limit < 0 else []
