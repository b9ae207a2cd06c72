"""Step response of a stable process: tangent and 63 % (pid-report, section 5.2.1), figure 5.1.

    Kp = dy/du,   L: where the steepest tangent cuts the level before the step,   T = T63 - L

T63 counts from the step to the instant at which 1 - 1/e of the way is made; `derivations.experiments.reaction_curve`
shows that a first-order process with dead time gives its own Kp, T and L so.
"""

import math

import numpy as np

from loopbook.experiments.data import StepData
from loopbook.experiments.exact_response import ExactResponse
from loopbook.experiments.plant import Estimate, ExperimentError, Plant, settling_horizon, smooth
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record
from loopbook.records.steps import noise_level

REACHED = 1 - math.exp(-1)
KNOWN = 1e-12  # of the time to 63 %: a tangent that starts so near the step starts at it
STILL = 0.02  # of the change: what the output may move over the last fifth of a record that has settled


def step_data(process: Process) -> StepData:
    """What a perfect step experiment tells: tangent and 63 % of the exact response, no samples.

    Raises ExperimentError for an integrating or unstable process.

    >>> found = step_data(Process.fopdt(2.0, 3.0, 1.0))
    >>> found.Kp, round(found.T, 9), round(found.L, 9)
    (2.0, 3.0, 1.0)
    """
    if math.isinf(process.static_gain):
        raise ExperimentError("the process integrates: its step response has no final level; use integrating_step")
    gain = process.static_gain
    if gain < 0:
        raise ExperimentError(f"the gain is {gain:.4g}: negative; turn the sign of the process and of u")
    response = ExactResponse(process, settling_horizon(process, 6.0))
    t, slope = response.steepest()
    tangent, T63 = t - response.value(t) / slope, response.reaches(REACHED * gain)
    L = process.delay + (tangent if tangent > KNOWN * T63 else 0.0)
    return StepData(gain, max(process.delay + T63 - L, 0.0), L)


def apply_step(plant: Plant, amplitude: float = 1.0, horizon: float | None = None) -> Record:
    """Make the experiment: a step of the input at a twentieth of the record."""
    horizon = horizon or settling_horizon(plant.process)
    return plant.play([(horizon / 19, amplitude)], horizon * 20 / 19)


def estimate(record: Record, window: int | None = None) -> Estimate:
    """Kp, T and L from a recorded step.

    window: samples in the moving average that tames noise; by default as many as the noise asks for.
    Raises ExperimentError where the input is no single step, or the output has not settled (an integrating process:
    use integrating_step.estimate).
    """
    start, du = single_step(record)
    window = window or _window(record)
    y = smooth(record.y, window)
    before = float(np.mean(record.y[: start + 1]))
    tail = slice(int(0.9 * len(y)), None)
    after = float(np.mean(record.y[tail]))
    _require_steady(record, start, before, after)
    t0, slopes = float(record.time[start + 1]), np.gradient(y, record.time) * np.sign(after - before)
    steepest = int(np.argmax(slopes[start:])) + start
    crossing = record.time[steepest] - abs(y[steepest] - before) / slopes[steepest]
    way = (y - before) / (after - before)
    first = int(np.argmax(way >= REACHED))
    t63 = np.interp(REACHED, way[first - 1 : first + 1], record.time[first - 1 : first + 1])
    L = max(crossing - t0, 0.0)
    gain = (after - before) / du
    if gain < 0:
        raise ExperimentError(f"the gain is {gain:.4g}: negative; record u with the other sign and turn it back later")
    assumed = [
        "the process was at rest before the step and its end level is the mean of the last tenth of the record",
        "T is the time to 63.2 % less the dead time, L where the steepest tangent cuts the starting level",
    ]
    if window > 1:
        assumed.append(f"noise was averaged over {window} samples, which flattens the tangent a little")
    marks = {"t0": t0, "du": du, "before": before, "after": after, "t_tangent": float(record.time[steepest])}
    marks |= {"y_tangent": float(y[steepest]), "slope": float(slopes[steepest] * np.sign(after - before))}
    return Estimate(StepData(gain, float(t63 - t0 - L), float(L)), {**marks, "t63": float(t63)}, tuple(assumed), record)


def single_step(record: Record) -> tuple[int, float]:
    """The last sample before the input's step, and the step's height; ExperimentError for any other input."""
    changes = np.flatnonzero(np.diff(record.u))
    if len(changes) != 1:
        raise ExperimentError(f"the input changes {len(changes)} times; a step experiment has one change")
    return int(changes[0]), float(record.u[-1] - record.u[0])


def _require_steady(record: Record, start: int, before: float, after: float) -> None:
    tail = slice(int(0.8 * len(record.y)), None)
    t, y = record.time[tail], record.y[tail]
    drift = abs(np.polyfit(t - t[0], y, 1)[0]) * (t[-1] - t[0])
    noise = noise_level(record.y)
    if abs(after - before) <= 3 * noise / math.sqrt(len(y)):
        raise ExperimentError("the output does not answer to the step: nothing rises above the noise")
    if drift > STILL * abs(after - before) + 4 * noise / math.sqrt(len(y)):
        raise ExperimentError(
            f"the output has no steady state: it still moves by {drift / abs(after - before):.0%} of the change over "
            "the last fifth of the record; record longer, or take the final tangent if the process integrates",
            "use integrating_step",
        )


def _window(record: Record) -> int:
    """Wide enough to bring noise well below the change, never wider than a fiftieth of the record."""
    noise, change = noise_level(record.y), float(np.ptp(record.y))
    if noise <= 1e-6 * change:
        return 1
    return max(3, min(int(0.02 * len(record.y)), int(4000 * noise / change))) | 1
