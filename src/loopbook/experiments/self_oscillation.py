"""Self-oscillation under a P regulator (pid-report, section 5.2.4), figure 5.4.

The gain is raised until the loop oscillates steadily. That gain is Ku, K180 = 1/Ku, and the period is T180.
"""

import math
from itertools import pairwise

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.experiments.data import FrequencyData
from loopbook.experiments.plant import Estimate, ExperimentError, Plant, smooth
from loopbook.loop.ultimate_point import NoSuchFrequency, ultimate
from loopbook.records.record import Record
from loopbook.records.steps import noise_level
from loopbook.response.closed_loop import closed_loop_step

STEADY = 0.05  # what the amplitude may change from one period to the next


def apply_gain(plant: Plant, gain: float, step: float = 1.0, horizon: float | None = None) -> Record:
    """The loop u = gain (r - y) after a step of r, exact with dead time.

    Raises ExperimentError where the actuator's limits are reached, for then the amplitude is the actuator's: make the
    step smaller.
    """
    horizon = horizon or _horizon(plant)
    y, u = closed_loop_step(plant.process, Regulator.of(float(gain)), "reference", horizon)
    (_, most), (_, least) = u.maximum(), u.minimum()
    if step * most > plant.high or step * least < plant.low:
        raise ExperimentError(
            f"the input would go from {step * least:.4g} to {step * most:.4g}, beyond the actuator's limits: "
            "make the step smaller, or use the relay experiment, which chooses its own amplitude"
        )
    time = np.linspace(0.0, horizon, plant.samples)
    return Record(time, step * u(time), plant.measured(step * y(time)), source="simulated")


def _horizon(plant: Plant) -> float:
    try:
        return 12 * ultimate(plant.process).T180
    except NoSuchFrequency as error:
        raise ExperimentError(f"a P regulator does not make this process oscillate: {error}") from None


def turning_points(record: Record) -> tuple[np.ndarray, np.ndarray]:
    """Instants and values of the maxima and minima of y, by parabolas through three samples."""
    noisy = noise_level(record.y) > 1e-6 * np.ptp(record.y)
    y = smooth(record.y, 2 * (len(record.y) // 300) + 1) if noisy else record.y
    crossings = _crossings(record.time, y)
    times, values = [], []
    for a, b in pairwise(crossings):
        part = slice(a, b + 1)
        middle = y[part] - y[a]
        i = a + int(np.argmax(abs(middle)))
        if 0 < i < len(y) - 1:
            left, here, right = y[i - 1 : i + 2]
            bend = left - 2 * here + right
            shift = 0.5 * (left - right) / bend if bend else 0.0
            times.append(record.time[i] + shift * (record.time[i + 1] - record.time[i]))
            values.append(here - 0.25 * (left - right) * shift)
    return np.array(times), np.array(values)


def _crossings(time: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Samples before which y crosses its level: the mean of the second half."""
    level = float(np.mean(y[len(y) // 2 :]))
    return np.flatnonzero(np.diff(np.sign(y - level)))


def growth(record: Record) -> float:
    """By what factor the amplitude changes in one period, over the last four; 1 where it is steady.

    Raises ExperimentError where there are fewer than six swings.
    """
    _, values = turning_points(record)
    if len(values) < 6:
        raise ExperimentError(f"the output swings {len(values)} times: no oscillation; raise the gain or record longer")
    swings = abs(np.diff(values))[-6:]
    return float((swings[-1] / swings[0]) ** (2 / (len(swings) - 1)))


def estimate(record: Record, gain: float) -> Estimate:
    """K180 = 1/gain and T180 from a record in which the loop with this gain oscillates steadily.

    Raises ExperimentError where the amplitude grows or shrinks by more than 5 % a period, and says which way to turn.
    """
    factor = growth(record)
    if abs(factor - 1) > STEADY:
        what, how = ("grows", "lower") if factor > 1 else ("shrinks", "raise")
        raise ExperimentError(f"the oscillation {what} by {abs(factor - 1):.0%} a period: {how} the gain {gain:.4g}")
    times, values = turning_points(record)
    used = min(8, 2 * ((len(times) - 1) // 2))
    period = 2 * float(times[-1] - times[-1 - used]) / used
    assumed = (
        f"the oscillation is steady: its amplitude changes by {factor - 1:+.2%} a period",
        "the actuator stayed within its limits, so the loop was linear",
    )
    marks = {"K_u": gain, "growth": factor, "amplitude": float(abs(np.diff(values))[-1] / 2), "t_end": float(times[-1])}
    return Estimate(FrequencyData(1 / gain, period), marks | {"t_begin": float(times[-1 - used])}, assumed, record)


def search(plant: Plant, gain: float, step: float = 1.0) -> tuple[Estimate, list[float]]:
    """Raise (or lower) the gain from a first guess until the oscillation is steady, as a person would.

    Returns the last experiment and all gains tried. Raises ExperimentError where no gain between a thousandth and a
    thousand times the guess does it.
    """
    from scipy.optimize import brentq

    tried: list[float] = []

    def drift(log_gain: float) -> float:
        tried.append(math.exp(log_gain))
        try:
            return math.log(growth(apply_gain(plant, tried[-1], step)))
        except ExperimentError as error:
            if "swings" not in str(error):
                raise
            return -1.0

    low = high = math.log(gain)
    while drift(high) < 0:
        low, high = high, high + math.log(1.5)
        if high > math.log(1000 * gain):
            raise ExperimentError("no gain makes the loop oscillate")
    while low == high or drift(low) > 0:
        low -= math.log(1.5)
        if low < math.log(gain / 1000):
            raise ExperimentError("the loop oscillates at every gain: the process is unstable by itself")
    found = math.exp(brentq(drift, low, high, xtol=1e-6))
    tried.append(found)
    return estimate(apply_gain(plant, found, step), found), tried
