"""A continuous process under a sampled regulator R u = T r - S y: poles, margins, responses between the samples.

The margins are those of the loop transfer on the unit circle z = exp(jwh), all crossovers found (`circle_transfer`).
The delay margin is a delay of the continuous process, resampled with the dead time it adds: not an angle divided by a
frequency.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.controllers.rst import Rst, zeros_of
from loopbook.loop.sampled_delay_margin import delay_margin
from loopbook.loop.sensitivity_peaks import Peak, sampled_peaks
from loopbook.loop.transfer import LoopError
from loopbook.loop.unit_circle import CircleTransfer
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.process.near_one import zeros_near_one
from loopbook.process.sampled import SampledProcess, sample
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation, simulate

BORDER = 1e-9
LONGEST, ROUNDED = 40, 4 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class SampledMargins(ShownAsTable):
    """Margins of a stable sampled loop. gain, gain_low [-], phase [degrees], delay [s], Ms, Mt as in `margins.Margins`.

    delay is the smallest dead time that, added to the continuous process, makes the loop unstable; inf if none does.
    """

    gain: float
    gain_low: float
    phase: float
    delay: float
    Ms: Peak
    Mt: Peak

    @property
    def gain_decibels(self) -> float:
        return float(20 * np.log10(self.gain))

    def table(self) -> PlainTable:
        """Each margin, and the peaks with their frequencies."""
        rows = [["gain", self.gain, ""], ["gain, lower", self.gain_low, ""], ["phase [°]", self.phase, ""]]
        rows += [["delay [s]", self.delay, ""], ["Ms", self.Ms.value, self.Ms.w], ["Mt", self.Mt.value, self.Mt.w]]
        return PlainTable(["margin", "value", "at [rad/s]"], [r for r in rows if r[:2] != ["gain, lower", 0.0]])


@dataclass(frozen=True)
class SampledLoop:
    """process: continuous, with dead time. regulator: an `Rst`; its h is the sampling interval.

    >>> loop = SampledLoop(Process([0.5], [1, 0], 0.4), Rst(R=(1.0,), S=(0.5,), T=(0.5,), h=1.0))
    >>> loop.is_stable, round(loop.margins().gain, 3)
    (True, 10.0)
    """

    process: Process
    regulator: Rst

    @cached_property
    def sampled(self) -> SampledProcess:
        return sample(self.process, self.regulator.h)

    @cached_property
    def transfer(self) -> tuple[np.ndarray, np.ndarray]:
        """(n, d) of the loop transfer S B/(R A), in z^-1."""
        B, A = self.sampled.polynomials
        return np.convolve(self.regulator.S, B), np.convolve(self.regulator.R, A)

    @cached_property
    def poles(self) -> np.ndarray:
        """The zeros of A R + B S, the loop's poles in the z plane; those at the origin left out."""
        n, d = self.transfer
        return np.roots(_sum(n, d)).astype(complex)

    @cached_property
    def is_stable(self) -> bool:
        """All poles inside the unit circle, also those that process and regulator cancel.

        Where poles crowd around the circle, as under fast sampling and long dead times, they are counted by the turning
        of the loop transfer, which needs no root of a long polynomial.
        """
        n, d = self.transfer
        certain = _inside(_sum(n, d), float(_sum(abs(n), abs(d)).max()))
        if certain is not None:
            return certain
        if not n.any():
            return bool((abs(self.on_circle.poles) < 1 - BORDER).all())
        try:
            return self.on_circle.roots_outside() == 0
        except ValueError:
            return False

    def with_delay(self, more: float) -> "SampledLoop":
        """The same regulator on a process with `more` seconds of dead time added."""
        return SampledLoop(self.process.delayed(more), self.regulator)

    def with_gain(self, factor: float) -> "SampledLoop":
        """The same regulator on a process with `factor` times the gain."""
        return SampledLoop(self.process * factor, self.regulator)

    @cached_property
    def on_circle(self) -> CircleTransfer:
        """The loop transfer at z = exp(j angle)."""
        n, d = self.transfer
        zeros = np.concatenate([zeros_of(self.regulator.S), zeros_near_one(self.sampled)])
        poles = np.concatenate([zeros_of(self.regulator.R), np.exp(self.process.poles * self.regulator.h)])
        return CircleTransfer(n, d, zeros, poles)

    def at(self, angle: np.ndarray) -> np.ndarray:
        """The loop transfer at z = exp(j angle), angle = w h [rad]."""
        return self.on_circle(angle)

    @cached_property
    def gain_crossovers(self) -> np.ndarray:
        """The w in (0, pi/h) [rad/s] with |G| = 1, ascending."""
        return self.on_circle.gain_crossovers / self.regulator.h

    @cached_property
    def phase_crossovers(self) -> np.ndarray:
        """The w in [0, pi/h] [rad/s] where G is real and negative, ascending; both ends where they are."""
        return self.on_circle.phase_crossovers / self.regulator.h

    def margins(self) -> SampledMargins:
        """All margins. Raises LoopError for an unstable loop, which has none."""
        if not self.is_stable:
            raise LoopError(f"the loop is unstable (a pole at |z| = {abs(self.poles).max():.6g}) and has no margins")
        h = self.regulator.h
        Ms, Mt = sampled_peaks(self.on_circle)
        factors = 1 / abs(self.at(self.phase_crossovers * h))
        factors[factors < BORDER] = 0.0  # an integrator: the loop transfer is infinite at z = 1
        at_gain = np.degrees(np.angle(-self.at(self.gain_crossovers * h)))
        return SampledMargins(
            gain=float(factors[factors > 1].min(initial=np.inf)),
            gain_low=float(factors[factors < 1].max(initial=0.0)),
            phase=float(min(at_gain, key=abs, default=np.inf)),
            delay=delay_margin(self.process, self.regulator, lambda more: self.with_delay(more).is_stable),
            Ms=Peak(Ms.value, Ms.w / h),
            Mt=Peak(Mt.value, Mt.w / h),
        )

    def step(self, source: str, steps: int, low: float = -np.inf, high: float = np.inf) -> Simulation:
        """A unit step at t = 0 of "reference", "load" (at the process input), "noise" (on the measurement) or "output"
        (added to the process output), over `steps` sampling intervals, with the actuator's limits low, high known to
        the regulator.
        """
        if source not in ("reference", "load", "noise", "output"):
            raise LoopError(f"source = {source!r}; one of reference, load, noise, output")
        unit: dict[str, Any] = {source: 1.0}
        return simulate(self.process, self.regulator.controller(low, high), self.regulator.h, steps, **unit)


def _sum(n: np.ndarray, d: np.ndarray) -> np.ndarray:
    total = np.zeros(max(len(n), len(d)))
    total[: len(n)] += n
    total[: len(d)] += d
    return total


def _inside(p: np.ndarray, size: float) -> bool | None:
    """Do all roots lie in the unit circle, by Schur's and Cohn's recursion? None where rounding leaves that open, or
    where the polynomial is long.

    p: descending coefficients; size: what they are made of at most, so that their rounding is a fraction of that.
    """
    if len(p) > LONGEST:
        return None
    row, error = p.tolist(), ROUNDED * size
    while len(row) > 1:
        largest = max(map(abs, row))
        if abs(row[0]) <= error:
            return None
        k = row[-1] / row[0]
        of_k = error * (1 + abs(k)) / (abs(row[0]) - error)
        if abs(abs(k) - 1) <= of_k + ROUNDED:
            return None
        if abs(k) > 1:
            return False
        row = [a - k * b for a, b in zip(row[:-1], row[:0:-1], strict=True)]
        error = error * (1 + abs(k) + of_k) + (of_k + ROUNDED) * largest
    return True
