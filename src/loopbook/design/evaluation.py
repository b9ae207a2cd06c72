"""One loop in numbers: robustness with exact dead time, responses from the exact solution, effort and noise."""

import math
from dataclasses import dataclass

import numpy as np

from loopbook.design.candidates import Candidate
from loopbook.design.model import Model
from loopbook.loop.continuous import Loop
from loopbook.loop.sensitivity_peaks import sensitivity_peak
from loopbook.loop.step_response import StepResponse
from loopbook.loop.transfer import LoopError
from loopbook.numerics.collocation import ResponseError
from loopbook.numerics.signals import Signal


@dataclass(frozen=True)
class Evaluation:
    """How one candidate does on one model.

    Ms, Mt: sensitivity peaks. gain_margin: factor, the smallest above 1. phase_margin [degrees]. delay_margin [s].
    iae_reference, iae_load [y s]: integral of |error| after a unit step of the reference and of the load at the input.
    overshoot [%], settling [s]: of the reference step. peak_input [u]: largest |u| after it; variation [u]: total
    variation of u after it. noise_gain [u/y]: of the controller at high frequencies, K (1 + N).
    An unstable loop has none of these: `stable` is False and the numbers are NaN. So has one that rounding keeps from
    being judged (a process of very high order); `reason` then says so.
    """

    candidate: Candidate
    loop: Loop
    stable: bool
    Ms: float = math.nan
    Mt: float = math.nan
    gain_margin: float = math.nan
    phase_margin: float = math.nan
    delay_margin: float = math.nan
    iae_reference: float = math.nan
    iae_load: float = math.nan
    overshoot: float = math.nan
    settling: float = math.nan
    peak_input: float = math.nan
    variation: float = math.nan
    noise_gain: float = math.nan
    reference: StepResponse | None = None
    load: StepResponse | None = None
    reason: str = ""


def total_variation(signal: Signal) -> float:
    """How far a signal travels up and down in all, the jump at its start from zero included.

    >>> total_variation(Signal(np.array([0.0, 1.0]), np.array([[2.0]])))
    2.0
    """
    times, values = signal.extremes()
    order = np.lexsort((np.arange(len(times)) < len(times) - len(signal.edges) + 1, times))
    path = np.concatenate([[0.0], values[order]])
    return float(np.abs(np.diff(path)).sum())


def noise_gain(candidate: Candidate) -> float:
    """|C(i w)| for w to infinity: K (1 + N) with derivative action, else K [u/y]."""
    pid = candidate.pid
    return abs(pid.K) * (1 + (pid.N if pid.Td else 0.0))


def evaluate(model: Model, candidate: Candidate) -> Evaluation:
    """Close the loop and measure it."""
    loop = Loop(model.process, candidate.pid)
    try:
        return _measured(candidate, loop)
    except (LoopError, ResponseError) as error:
        return Evaluation(candidate, loop, False, noise_gain=noise_gain(candidate), reason=str(error))


def _measured(candidate: Candidate, loop: Loop) -> Evaluation:
    if not loop.is_stable:
        return Evaluation(candidate, loop, False, noise_gain=noise_gain(candidate))
    margins = loop.margins()
    reference, load = loop.step("reference"), loop.step("load")
    metrics = reference.metrics()
    return Evaluation(
        candidate,
        loop,
        True,
        Ms=margins.Ms.value,
        Mt=margins.Mt.value,
        gain_margin=margins.gain,
        phase_margin=margins.phase,
        delay_margin=margins.delay,
        iae_reference=reference.iae(),
        iae_load=load.iae(),
        overshoot=metrics.overshoot,
        settling=metrics.settling,
        peak_input=abs(reference.peak_input()[1]),
        variation=total_variation(reference.u),
        noise_gain=noise_gain(candidate),
        reference=reference,
        load=load,
    )


@dataclass(frozen=True)
class Robustness:
    """How a candidate bears the identification's uncertainty.

    models: how many were drawn from the confidence region. stable: how many loops are. Ms: the 95 % quantile of the
    stable ones, NaN where none is.
    """

    models: int
    stable: int
    Ms: float


def robustness(
    model: Model, candidate: Candidate, number: int = 20, seed: int = 0, other: Model | None = None
) -> Robustness:
    """Close the loop on models drawn from the confidence region, and on a model of the other direction."""
    drawn = [*model.variations(number, seed), *([other] if other else [])]
    loops = [Loop(m.process, candidate.pid) for m in drawn]
    peaks = [sensitivity_peak(loop.transfer).value for loop in loops if loop.is_stable]
    return Robustness(len(drawn), len(peaks), _peak(peaks, other is not None))


def _peak(peaks: list[float], has_other: bool) -> float:
    """The 95 % quantile; the last one, of the other direction, counts in full."""
    if not peaks:
        return math.nan
    return float(max(np.quantile(peaks, 0.95), peaks[-1] if has_other else 0.0))
