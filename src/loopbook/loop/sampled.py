"""A continuous process under a sampled regulator R u = T r - S y: poles, margins, responses between the samples.

The margins are those of the loop transfer on the unit circle z = exp(jwh), all crossovers found (`circle_transfer`).
The delay margin is a delay of the continuous process, resampled with the dead time it adds: not an angle divided by a
frequency.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.controllers.rst import Rst
from loopbook.loop.circle_margins import circle_margins
from loopbook.loop.discrete import DiscreteLoop, circle_of_sampled
from loopbook.loop.frequency_curves import of_circle
from loopbook.loop.inside_circle import is_stable_in_z, row_sum
from loopbook.loop.margins import Margins
from loopbook.loop.sampled_delay_margin import delay_margin
from loopbook.loop.shown_loop import ShownLoop, said_of
from loopbook.loop.transfer import LoopError
from loopbook.loop.unit_circle import CircleTransfer
from loopbook.plots.frequency import Curve
from loopbook.plots.stairs import stairs
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.sampled import SampledProcess, sample
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation, simulate


@dataclass(frozen=True, repr=False)
class SampledLoop(ShownLoop):
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
        return np.roots(row_sum(*self.transfer)).astype(complex)

    @cached_property
    def is_stable(self) -> bool:
        """All poles inside the unit circle, also those that process and regulator cancel.

        Where poles crowd around the circle, as under fast sampling and long dead times, they are counted by the turning
        of the loop transfer, which needs no root of a long polynomial.
        """
        return is_stable_in_z(*self.transfer, lambda: self.on_circle)

    def closed(self, source: str = "reference", output: str = "y") -> DiscreteProcess:
        """At the samples: from "reference", "load" (held) or "noise" to "y" or "u"."""
        return DiscreteLoop(self.sampled, self.regulator).closed(source, output)

    def with_delay(self, more: float) -> "SampledLoop":
        """The same regulator on a process with `more` seconds of dead time added."""
        return SampledLoop(self.process.delayed(more), self.regulator)

    def with_gain(self, factor: float) -> "SampledLoop":
        """The same regulator on a process with `factor` times the gain."""
        return SampledLoop(self.process * factor, self.regulator)

    @cached_property
    def on_circle(self) -> CircleTransfer:
        """The loop transfer at z = exp(j angle)."""
        return circle_of_sampled(self.sampled, self.regulator)

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

    @property
    def h(self) -> float:
        """The sampling interval [s]."""
        return self.regulator.h

    def margins(self) -> Margins:
        """All margins, each with its frequency [rad/s]. Raises LoopError for an unstable loop, which has none.

        delay [s]: the smallest dead time that, added to the continuous process, makes the loop unstable; inf if none.
        """
        if not self.is_stable:
            raise LoopError(f"the loop is unstable (a pole at |z| = {abs(self.poles).max():.6g}) and has no margins")
        found = circle_margins(self.on_circle, self.h)
        late = delay_margin(self.process, self.regulator, lambda more: self.with_delay(more).is_stable)
        return replace(found, delay=late)

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        return [["process", said_of(self.process)], ["regulator", said_of(self.regulator)], ["h [s]", self.h]]

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """Gain and phase of the loop transfer at w [rad/s], with its margins: what a diagram draws."""
        return of_circle(self.on_circle, self.h, w, self.is_stable)

    def default_horizon(self) -> float:
        """Three times ln(50) over the slowest pole's decay [s], at least sixty samples and the dead time twice."""
        slowest = float(abs(self.poles).max(initial=0.0))
        if not slowest < 1:
            raise LoopError("the loop is unstable: its steps have no end; give a horizon")
        settled = 12 * self.h / max(-np.log(max(slowest, 1e-9)), 1e-9)
        return max(settled, 60 * self.h) + 2 * self.process.delay

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)) at the samples after a unit step of the reference at 0, of the load at half the horizon."""
        steps = int(np.ceil(horizon / self.h))
        one, two, later = self.step("reference", steps), self.step("load", steps), steps // 2
        y, u = one.y.copy(), one.u.copy()
        y[later:] += two.y[: steps + 1 - later]
        u[later:] += two.u[: steps + 1 - later]
        return (one.t, y), stairs(one.t, u)

    def step(self, source: str, steps: int, low: float = -np.inf, high: float = np.inf) -> Simulation:
        """A unit step at t = 0 of "reference", "load" (at the process input), "noise" (on the measurement) or "output"
        (added to the process output), over `steps` sampling intervals, with the actuator's limits low, high known to
        the regulator.
        """
        if source not in ("reference", "load", "noise", "output"):
            raise LoopError(f"source = {source!r}; one of reference, load, noise, output")
        unit: dict[str, Any] = {source: 1.0}
        return simulate(self.process, self.regulator.controller(low, high), self.regulator.h, steps, **unit)
