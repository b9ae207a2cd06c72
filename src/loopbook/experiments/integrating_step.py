"""Step response of an integrating process: the final tangent (pid-report, section 5.2.2), figure 5.2.

    Kv = slope/du,   L: where the tangent cuts the level before the step

The tangent also stands dy = Kv du L below the starting level at the instant of the step, so Kv = dy/(L du)
(`derivations.experiments.reaction_curve.velocity_gain`).
"""

import math

import numpy as np

from loopbook.experiments.data import IntegratingStepData
from loopbook.experiments.plant import Estimate, ExperimentError, Plant, sum_of_lags
from loopbook.experiments.step import single_step
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record
from loopbook.records.steps import noise_level

BENT = 0.02  # relative difference of the slopes in the two halves of the tail that still counts as one line


def slope_data(process: Process) -> IntegratingStepData:
    """What a perfect experiment tells: with G(s) = Kv N(s)/(s D(s)) e^(-Ls), N(0) = D(0) = 1, it is L + D'(0) - N'(0).

    Raises ExperimentError where the process does not integrate exactly once.

    >>> slope_data(Process.integrating(2.0, 1.0, 0.5))
    IntegratingStepData(Kv=2.0, L=1.5)
    """
    if not _integrates_once(process):
        raise ExperimentError("the process does not integrate exactly once: use step.step_data for a stable one")
    num, den = (*(0.0,) * 2, *process.num), (0.0, *process.den)
    gain = num[-1] / den[-2]
    lag = den[-3] / den[-2] - num[-2] / num[-1]
    return IntegratingStepData(gain, process.delay + lag)


def _integrates_once(process: Process) -> bool:
    return len(process.den) >= 2 and process.den[-1] == 0 and process.den[-2] != 0 and process.num[-1] != 0


def apply_long_step(plant: Plant, amplitude: float = 1.0, horizon: float | None = None) -> Record:
    """Make the experiment: a step at a twentieth of the record, long enough for all lags to end."""
    if not _integrates_once(plant.process):
        raise ExperimentError("the process does not integrate: use step.apply_step")
    lags = sum_of_lags(plant.process)
    horizon = horizon or 3 * plant.process.delay + 20 * lags + (0.0 if lags else plant.process.delay)
    return plant.play([(horizon / 19, amplitude)], horizon * 20 / 19)


def estimate(record: Record) -> Estimate:
    """Kv and L from a recorded step.

    Raises ExperimentError where the last third of the output is no straight line (a stable process: use
    step.estimate; or the record is too short).
    """
    start, du = single_step(record)
    before = float(np.mean(record.y[: start + 1]))
    n = len(record.y)
    halves = [
        np.polyfit(record.time[s], record.y[s], 1)[0] for s in (slice(2 * n // 3, 5 * n // 6), slice(5 * n // 6, n))
    ]
    tail = slice(2 * n // 3, n)
    slope, level = np.polyfit(record.time[tail], record.y[tail], 1)
    blur = 12 * noise_level(record.y) / math.sqrt(n / 6) / (record.time[-1] / 6)
    if abs(halves[1] - halves[0]) > BENT * abs(slope) + blur or abs(slope) <= blur:
        raise ExperimentError(
            f"the end of the record is no rising line (slopes {halves[0]:.4g} and {halves[1]:.4g} per second): "
            "the record is too short, or the process settles: then take the tangent and 63 %",
            "use step.estimate",
        )
    if slope / du < 0:
        raise ExperimentError("the gain is negative: record u with the other sign and turn it back later")
    crossing = (before - level) / slope
    L = float(crossing - record.time[start + 1])
    assumed = ("all lags have ended: the last third of the record is one straight line, the final tangent",)
    marks = {"t0": float(record.time[start + 1]), "du": du, "before": before, "slope": float(slope)}
    marks |= {"crossing": float(crossing), "dy": float(slope) * L}
    return Estimate(IntegratingStepData(float(slope / du), max(L, 0.0)), marks, assumed, record)
