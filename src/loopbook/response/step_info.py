"""Rise, settling and overshoot of whatever has a step response, in a named convention."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from loopbook.loop.continuous import Loop, StepResponse
from loopbook.loop.sampled import SampledLoop
from loopbook.numerics.signals import Signal
from loopbook.numerics.step_response import open_loop_step
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation
from loopbook.response.step_metrics import BAND, StepMetrics, StepMetricsError, exact, sampled

POINTS = 1000
LAGS = 15  # of the sum of all time constants: what a stable process needs to settle


def step_info(
    system: Any, t: Sequence[float] | None = None, *, convention: str = "exact", final: float | None = None,
    band: float = BAND,
) -> StepMetrics:  # fmt: skip
    """Step metrics of a process, a loop, a response or of samples.

    system: a `Process` or `Loop` (its step response; of a loop that to the reference), a `SampledLoop`, a
    `StepResponse`, a `Simulation`, or samples of y at the times t [s]. convention: "exact" (continuous response, true
    final value) or "sampled" (MATLAB's stepinfo; of a continuous response at t, by default 1,000 intervals until it has
    settled); samples are always "sampled". final: the final value of samples, by default the last. band: of the
    settling time, as a part of the step.
    Raises StepMetricsError where there is no such response or it does not settle.

    >>> info = step_info(Process.fopdt(2, 10, 3))
    >>> round(info.rise, 4), round(info.settling, 4), info.overshoot
    (21.9722, 42.1202, 0.0)
    """
    if convention not in ("exact", "sampled"):
        raise StepMetricsError(f"convention = {convention!r}: exact or sampled")
    if isinstance(system, Simulation):
        return sampled(system.y, system.t, final, band)
    if not isinstance(system, Process | Loop | SampledLoop | StepResponse):
        return sampled(system, t, final, band)
    y, value, horizon, corners = _response(system)
    if convention == "exact":
        return exact(y, value, horizon, breakpoints=corners, band=band)
    times = np.linspace(0.0, horizon, POINTS + 1) if t is None else np.asarray(t, dtype=float)
    return sampled(y(times), times, final, band)


def _response(system: Any) -> tuple[Signal, float, float, np.ndarray]:
    """(y, its final value, the horizon, where it has corners) of the step response."""
    if isinstance(system, Process):
        if not np.isfinite(system.static_gain) or (system.poles.real >= 0).any():
            raise StepMetricsError("the process integrates or is unstable: its step response does not settle")
        span = LAGS * float(sum(1 / abs(system.poles.real))) or max(system.delay, 1.0)
        y = open_loop_step(system.rational, span).delayed(system.delay)
        return y, system.static_gain, system.delay + span, np.array([system.delay])
    if isinstance(system, SampledLoop):
        if not system.is_stable:
            raise StepMetricsError("the loop is not stable: its step response does not settle")
        slowest = abs(system.poles).max(initial=0.0)
        steps = 30 + int(np.ceil(np.log(1e-4) / np.log(slowest))) if slowest > 0 else 30
        run = system.step("reference", steps + 2 * system.sampled.whole)
        n, d = system.transfer
        y = run.between
        gain = float(np.sum(system.regulator.T)) * float(np.sum(system.sampled.polynomials[0]))
        return y, gain / float(np.sum(n) + np.sum(d)), y.end, y.edges[1:-1]
    response = system.step("reference") if isinstance(system, Loop) else system
    return response.y, response.final[0], min(response.horizon, response.y.end), response.breakpoints
