"""The response of a loop to a step: y and u as signals, what measures them, and any staircase made of such steps."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.loop.transfer import LoopError
from loopbook.numerics.signals import HorizonError, Signal
from loopbook.plots.curves import curves
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.plots.shown import shown_once
from loopbook.response.step_metrics import StepMetricsError, exact_metrics

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SETTLED, SEEN, MORE = 1e-9, 0.01, 1.3


@dataclass(frozen=True, repr=False)
class StepResponse(ShortRepr, ShownAsTable):
    """The response of a loop to a unit step of `source` at t = 0. y, u: signals, to be called with times [s].

    settled: was the horizon chosen so long that both are at rest? A plot then shows what happens before.
    Times beyond the horizon raise HorizonError.
    """

    loop: Any
    source: str
    horizon: float
    y: Signal
    u: Signal
    settled: bool = False

    @cached_property
    def final(self) -> tuple[float, float]:
        """(y, u) for t to infinity. Raises LoopError for an unstable loop."""
        return self.loop.final_values(self.source)

    def metrics(self) -> Any:
        """Rise time, settling time, overshoot and peak of y, convention `exact`: see `loopbook.response.step_metrics`.

        Raises LoopError for an unstable loop, NotSettled for a horizon that is too short.
        """
        return exact_metrics(self.y, self.final[0], min(self.horizon, self.y.end))

    def table(self) -> PlainTable:
        """The metrics of y where it settles elsewhere than at rest, the peaks of both, the integrals of the error."""
        y, u = self.y.until(min(self.horizon, self.y.end)), self.peak_input()
        rows = [["peak of y", y.peak()[1], y.peak()[0]], ["peak of u", u[1], u[0]]]
        notes = []
        try:
            m = self.metrics()
            rows += [["overshoot [%]", m.overshoot, ""], ["rise [s]", m.rise, ""], ["settling [s]", m.settling, ""]]
        except (LoopError, StepMetricsError) as error:
            notes.append(str(error))
        try:
            rows += [["IAE", self.iae(), ""], ["ISE", self.ise(), ""]]
        except (LoopError, HorizonError) as error:
            notes.append(str(error))
        return PlainTable([f"unit step of the {self.source}", "value", "at [s]"], rows, list(dict.fromkeys(notes)))

    @cached_property
    def error(self) -> Signal:
        """What regulation should bring to zero: 1 - y for a reference step, -y for the others."""
        settled = self.y.until(min(self.horizon, self.y.end))
        return 1.0 - settled if self.source == "reference" else -settled

    def _vanishing_error(self) -> Signal:
        left = (1.0 if self.source == "reference" else 0.0) - self.final[0]
        largest = max(abs(self.error.peak()[1]), abs(left))
        if abs(left) > SETTLED * largest:
            raise LoopError(
                f"the error tends to {left:.6g}, not to zero, so that its integral is infinite: the regulator has no "
                "integral action that removes it"
            )
        rest = abs(float(self.error(self.error.end)))
        if rest > SETTLED * largest:
            raise HorizonError(
                f"not settled at t = {self.horizon:g} s: the error is still {rest / largest:.2g} of its peak; take a "
                "longer horizon, or none to have it chosen"
            )
        return self.error

    def iae(self) -> float:
        """The integral of |error| [y s]. Raises LoopError where it is infinite, HorizonError where it is cut short."""
        return self._vanishing_error().integral_of_magnitude()

    def ise(self) -> float:
        """The integral of error^2 [y^2 s]. Raises as `iae`."""
        return self._vanishing_error().integral_of_square()

    def peak_input(self) -> tuple[float, float]:
        """(time [s], value [u]) of the largest |u|; the value keeps its sign."""
        return self.u.until(min(self.horizon, self.u.end)).peak()

    def plot(self) -> "Figure":
        """y and u as a matplotlib figure."""
        until = min(self.horizon, self.y.end, self.u.end)
        if self.settled:
            until = min(until, MORE * max(_moving(self.y), _moving(self.u)) or until)
        t = np.linspace(0.0, until, 1000)
        panels = {"output $y$": {"y": (t, self.y(t))}, "input $u$": {"u": (t, self.u(t))}}
        return shown_once(curves(panels, f"Unit step of the {self.source}"))

    def after(self, changes: Any, times: Any) -> tuple[np.ndarray, np.ndarray]:
        """(y, u) at `times` [s] for an input that changes in steps: changes = ((time, size), ...), from rest.

        The loop is linear, so this is the sum of shifted step responses: exact for any staircase of the input.
        """
        times = np.asarray(times, dtype=float)
        y, u = np.zeros(times.shape), np.zeros(times.shape)
        for when, size in changes:
            y += size * self.y(times - when)
            u += size * self.u(times - when)
        return y, u


def _moving(signal: Signal) -> float:
    """When [s] it comes within one per cent of its range from where it ends, to stay."""
    t = signal.edges
    values = signal(t)
    away = np.flatnonzero(np.abs(values - values[-1]) > SEEN * max(np.ptp(values), TINY))
    return float(t[min(away[-1] + 1, len(t) - 1)]) if away.size else 0.0


TINY = float(np.finfo(float).tiny)
