"""Rise, settling and overshoot of whatever has a step response, in a named convention."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from loopbook.loop.cascade import CascadeLoop
from loopbook.loop.continuous import Loop
from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.feedforward import FeedforwardLoop
from loopbook.loop.general import GeneralLoop
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.step_response import StepResponse
from loopbook.loop.without_dead_time import time_to_settle
from loopbook.numerics.characteristic_roots import zeros_in
from loopbook.numerics.real_numbers import real_array
from loopbook.numerics.signals import Signal
from loopbook.numerics.step_response import open_loop_step
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.sampled import SampledProcess
from loopbook.process.transfer_function import Process, simplest
from loopbook.response.simulation import Simulation
from loopbook.response.step_metrics import BAND, StepMetrics, StepMetricsError, exact_metrics, sampled_metrics

POINTS = 1000
LONG = 25.0  # time constants after which nothing is left
FINER = 20.0  # rise times that are looked at more closely
SETTLED = 1e-6  # what is left of the slowest mode of a sampled loop


def step_info(
    system: Any, t: Sequence[float] | None = None, *, convention: str = "exact", final: float | None = None,
    band: float = BAND,
) -> StepMetrics:  # fmt: skip
    """Step metrics of a process, a loop, a response or of samples.

    system: a transfer function, a regulator or a loop of any kind (its step response; of a loop that to the reference),
    a `StepResponse`, a `Simulation`, or samples of y at the times t [s]. convention: "exact" (continuous response, true
    final value) or "sampled" (MATLAB's stepinfo; of a continuous response at t, by default 1,000 intervals up to twice
    the exact settling time and 1,000 while it rises); samples and plants in z are always "sampled". final: the
    final value in that convention, by default the true one of a system and the last one of samples. band: of the
    settling time, as a part of the step.
    Raises StepMetricsError where there is no such response or it does not settle.

    >>> info = step_info(Process.fopdt(2, 10, 3))
    >>> round(info.rise, 4), round(info.settling, 4), info.overshoot
    (21.9722, 42.1202, 0.0)
    """
    if convention not in ("exact", "sampled"):
        raise StepMetricsError(f"convention = {convention!r}: exact or sampled")
    if isinstance(system, Simulation):
        return sampled_metrics(system.y, system.t, final, band)
    if isinstance(system, DiscreteLoop):
        system = system.closed()
    if isinstance(system, DiscreteProcess | SampledProcess):
        return _of_samples(system, t, final, band)
    if isinstance(system, CascadeLoop | FeedforwardLoop):
        if not system.is_stable:
            raise StepMetricsError("the loop is not stable: its step response does not settle")
        system = system.closed()
    if hasattr(system, "fraction"):
        system = simplest(*system.fraction) if not isinstance(system, TransferAlgebra) else system
    if not isinstance(system, TransferAlgebra | Loop | GeneralLoop | SampledLoop | StepResponse):
        return sampled_metrics(system, t, final, band)
    y, value = _response(system)
    found = exact_metrics(y, value, y.end, band=band)
    if convention == "exact":
        return found
    times = _grid(found, y.end) if t is None else real_array(t, "t", StepMetricsError)
    return sampled_metrics(y(times), times, value if final is None else final, band, rest=0.0)


def _of_samples(
    system: DiscreteProcess | SampledProcess, t: Sequence[float] | None, final: float | None, band: float
) -> StepMetrics:
    """Of the samples of a plant in z, until its slowest pole has died out."""
    if t is not None:
        raise StepMetricsError("a plant in z is measured at its own samples: give no t")
    plant = DiscreteProcess.of(system)
    slowest = float(abs(plant.poles).max(initial=0.0))
    if not slowest < 1:
        raise StepMetricsError(f"the plant has a pole at |z| = {slowest:.6g}: it does not settle")
    decay = int(np.ceil(np.log(SETTLED) / np.log(slowest))) if slowest else 0
    y = plant.response(np.ones(2 + decay + len(plant.den) + len(plant.num)))
    end = plant.static_gain if final is None else final
    return sampled_metrics(y, plant.h * np.arange(len(y)), end, band, rest=0.0)


def _grid(found: StepMetrics, end: float) -> np.ndarray:
    """Times on which nothing of the response is missed: so long as it moves, and finer while it rises."""
    until = min(2 * max(found.settling, found.peak_time), end)
    rising = min(FINER * max(found.rise, min(found.peak_time, found.settling) / FINER), until)
    return np.unique(np.concatenate([np.linspace(0.0, last, POINTS + 1) for last in (rising, until)]))


def _response(system: Any) -> tuple[Signal, float]:
    """The step response until it has settled, and its final value."""
    if isinstance(system, Process):
        return open_loop_step(system, time_to_settle(system)).delayed(system.delay), system.static_gain
    if isinstance(system, TransferAlgebra):
        num, den = system.fraction
        slowest = -float(np.asarray(zeros_in(den)[0].values).real.max(initial=-np.inf))
        if not slowest > 0:
            raise StepMetricsError("the transfer function has a pole that is not on the left: it does not settle")
        horizon = LONG / slowest + 3 * max(*num.delays, *den.delays)
        return system.step_signal(horizon), system.static_gain
    if isinstance(system, SampledLoop):
        if not system.is_stable:
            raise StepMetricsError("the loop is not stable: its step response does not settle")
        slowest = max(abs(system.poles).max(initial=0.0), 0.1)
        steps = 30 + 2 * system.sampled.whole + int(np.ceil(np.log(SETTLED) / np.log(slowest)))
        n, d = (float(np.sum(row)) for row in system.transfer)
        gain = float(np.sum(system.regulator.T) * np.sum(system.sampled.num))
        return system.step("reference", steps).between, gain / (n + d)
    response = system if isinstance(system, StepResponse) else system.step("reference")
    return response.y.until(min(response.horizon, response.y.end)), response.final[0]
