"""Regulators side by side: the same measures, in the same convention, for continuous and sampled loops.

Every number is taken from the response in continuous time (between the samples too), with its true final value and the
step at t = 0; margins are those of the loop with its exact dead time.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loopbook.loop.continuous import Loop
from loopbook.loop.margins import Margins
from loopbook.loop.sampled import SampledLoop
from loopbook.numerics.signals import Signal
from loopbook.response.step_metrics import StepMetrics, exact_metrics


@dataclass(frozen=True)
class ComparedLoop:
    """A regulator on its process, under a name. loop: `Loop` or `SampledLoop`, stable. horizon [s]: long enough to
    settle; load: the size of the load step [u] whose response is measured.
    """

    name: str
    loop: Loop | SampledLoop
    horizon: float
    load: float = 1.0

    @property
    def sampled(self) -> bool:
        return isinstance(self.loop, SampledLoop)

    def _run(self, source: str) -> tuple[Signal, Signal]:
        if isinstance(self.loop, Loop):
            response = self.loop.step(source, self.horizon)
            return response.y.until(self.horizon), response.u.until(self.horizon)
        run = self.loop.step(source, int(np.ceil(self.horizon / self.loop.regulator.h)))
        return run.between, run.held_input

    @cached_property
    def reference(self) -> tuple[Signal, Signal]:
        """(y, u) after a unit step of the reference."""
        return self._run("reference")

    @cached_property
    def disturbance(self) -> tuple[Signal, Signal]:
        """(y, u) after a load step of the size `load` at the process input."""
        y, u = self._run("load")
        return self.load * y, self.load * u

    @cached_property
    def step(self) -> StepMetrics:
        """Rise, settling, overshoot and peak of the reference response, convention `exact`."""
        y, _ = self.reference
        return exact_metrics(y, 1.0, y.end)

    @cached_property
    def peak_input(self) -> float:
        """The largest |u| at the reference step [u]."""
        return abs(self.reference[1].peak()[1])

    @cached_property
    def input_span(self) -> tuple[float, float]:
        """(smallest, largest) u at the reference step [u]."""
        u = self.reference[1]
        return u.minimum()[1], u.maximum()[1]

    @cached_property
    def disturbance_peak(self) -> float:
        """The largest |y| after the load step [y]."""
        return abs(self.disturbance[0].peak()[1])

    @cached_property
    def disturbance_iae(self) -> float:
        """The integral of |y| after the load step up to the horizon [y s]."""
        return self.disturbance[0].integral_of_magnitude()

    def back_within(self, band: float) -> float:
        """The last time [s] at which |y| after the load step exceeds `band` [y]."""
        y = self.disturbance[0]
        leaves = np.concatenate([y.roots(band), y.roots(-band)])
        return float(leaves.max(initial=0.0))

    @cached_property
    def margins(self) -> Margins:
        """Those of the loop."""
        return self.loop.margins()

    @property
    def regulator_is_stable(self) -> bool:
        """Is the regulator stable by itself (an integrator allowed)?"""
        if isinstance(self.loop, SampledLoop):
            return self.loop.regulator.is_stable
        return not self.loop.polynomials.unstable_poles.size

    def survives(self, delay: float) -> bool:
        """Is the loop stable with `delay` seconds of dead time more?"""
        return self.loop.with_delay(delay).is_stable


def turns(values: np.ndarray, threshold: float = 0.0) -> int:
    """How often a staircase turns from rising to falling or back; steps of at most `threshold` do not count.

    >>> turns(np.array([0.0, 3.0, 1.0, 2.0, 2.0, 2.1]))
    2
    """
    changes = np.diff(values)
    signs = np.sign(changes[abs(changes) > threshold])
    return int((signs[1:] != signs[:-1]).sum())
