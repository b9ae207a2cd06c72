"""Feedforward from a disturbance that is measured: u = feedback + F w, y = P u + W w, dead times exact.

F = -W/P would take the disturbance away. It can be built where W is later than P and falls off as fast; elsewhere what
is nearest to it can: without the lead in time, behind a filter, or its static gain alone.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from loopbook.loop.continuous import Loop
from loopbook.loop.feedback import transfer_of
from loopbook.loop.general import GeneralLoop
from loopbook.loop.margins import Margins
from loopbook.loop.roots import poles
from loopbook.loop.shown_loop import ShownLoop, said_of
from loopbook.loop.step_response import StepResponse
from loopbook.loop.transfer import LoopError
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.real_numbers import positive
from loopbook.plots.frequency import Curve
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.transfer_function import DelayedSum, Process


class Feedforward(NamedTuple):
    """transfer: F. exact: is it -W/P? said: what was given up where it is not."""

    transfer: Process
    exact: bool
    said: str


def feedforward(process: Process, path: Process, filter: float | None = None) -> Feedforward:
    """F = -W/P, or what can be built that is nearest to it.

    filter [s]: the time constant of the lags that it gets where W falls off more slowly than P; without one it is then
    refused. Where P is later than W the difference of the dead times is left out, and `said` says so.
    Raises LoopError for a process with zeros on the right, whose inverse would be unstable, and for a zero gain.

    >>> feedforward(Process([2], [10, 1], 1), Process([3], [10, 1], 4)).transfer
    Process(num=(-1.5,), den=(1.0,), delay=3.0)
    >>> feedforward(Process([2], [10, 1], 4), Process([3], [5, 1], 1)).said
    'the disturbance arrives 3 s before the input can act: that part stays'
    """
    if not any(process.num):
        raise LoopError("the process has no gain: no input takes a disturbance away")
    right = float(process.zeros.real.max(initial=-np.inf))
    if right >= 0:
        raise LoopError(
            f"the process has a zero with real part {right:.4g} 1/s, and its inverse would be unstable: take the "
            "static gain, Process([-W(0)/P(0)], [1])"
        )
    said = []
    late = path.delay - process.delay
    if late < 0:
        said.append(f"the disturbance arrives {-late:g} s before the input can act: that part stays")
    short = process.relative_degree - path.relative_degree
    lags = Process([1.0], [1.0])
    if short > 0:
        if filter is None:
            raise LoopError(
                f"-W/P differentiates {short} times: give the time constant of a filter [s], or take its static gain"
            )
        lags = Process([1.0], [positive(filter, "filter", LoopError, " s"), 1.0]) ** short
        said.append(f"behind {short} lag{'s' * (short > 1)} of {float(filter):g} s")
    found = (path.rational * lags) / process.rational * -1.0
    assert isinstance(found, Process)
    return Feedforward(found.delayed(max(late, 0.0)), not said, "; ".join(said))


@dataclass(frozen=True, repr=False)
class FeedforwardLoop(ShownLoop):
    """A `Loop` with a measured disturbance. path: W; forward: F, a transfer function or a number.

    Stability, poles and margins are those of the loop, as long as F and W are stable.

    >>> P, W = Process([2], [10, 1], 1), Process([3], [10, 1], 4)
    >>> loop = FeedforwardLoop(P, 0.5, W, feedforward(P, W).transfer)
    >>> loop.closed("disturbance", "y")
    Process(num=(0.0,), den=(1.0,), delay=0.0)
    """

    half_way: ClassVar[str] = "disturbance"

    process: Process
    regulator: Any
    path: Process | DelayedSum
    forward: Any

    @cached_property
    def loop(self) -> Loop:
        """The feedback alone, with the disturbance's path."""
        return Loop(self.process, self.regulator, self.path)

    @cached_property
    def forwarded(self) -> TransferAlgebra:
        """F as a transfer function."""
        return transfer_of(getattr(self.forward, "transfer", self.forward))

    @property
    def characteristic(self) -> ExponentialPolynomial:
        """Of the loop; F and W have poles of their own."""
        return self.loop.characteristic

    @property
    def is_stable(self) -> bool:
        """Is the loop, and are F and W?"""
        outside = (self.forwarded, self.path)
        return self.loop.is_stable and all((np.asarray(poles(one)).real < 0).all() for one in outside)

    def margins(self) -> Margins:
        """Those of the loop."""
        return self.loop.margins()

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        return [*self.loop.parts(), ["feedforward of w", said_of(self.forwarded)]]

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """That of the feedback loop."""
        return self.loop.frequency_curve(w)

    def default_horizon(self) -> float:
        """Three times the settling time [s]."""
        return self.loop.default_horizon()

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)) after a unit step of the reference at 0 and of the disturbance w at half the horizon [s]."""
        t = np.linspace(0.0, horizon, 800)
        y, u = (
            self.closed("reference", output).step(t) + self.closed("disturbance", output).step(t - horizon / 2)
            for output in ("y", "u")
        )
        return (t, y), (t, u)

    def closed(self, source: str = "reference", output: str = "y") -> TransferAlgebra:
        """As of the loop; from "disturbance" with the feedforward."""
        if source != "disturbance":
            return self.loop.closed(source, output)
        remains = self.path + self.process * self.forwarded
        around = GeneralLoop(self.process, self.regulator, remains)
        if output == "y" or remains.fraction[0].is_zero:
            return around.closed("disturbance", "y") if output == "y" else self.forwarded
        found: TransferAlgebra = around.closed("disturbance", "u") + self.forwarded
        return found

    def step(self, source: str = "disturbance", horizon: float | None = None) -> StepResponse:
        """y and u after a unit step of one input, exact to rounding."""
        until = self.loop.settling_horizon() if horizon is None else float(horizon)
        y, u = (self.closed(source, output).step_signal(until) for output in ("y", "u"))
        return StepResponse(self, source, until, y, u)

    def final_values(self, source: str) -> tuple[float, float]:
        """What (y, u) tend to after a unit step of one input."""
        y, u = (self.closed(source, output).static_gain for output in ("y", "u"))
        return y, u
