"""A relay in the loop (pid-report, section 5.2.6), figures 5.6 and 5.7: an oscillation near the ultimate frequency.

    K180 = pi ya/(4 ua),   T180: the period of the oscillation

from the relay's describing function (`derivations.experiments.describing_function`). With hysteresis the oscillation
stands where the process's phase is arcsin(epsilon/ya) short of -180 degrees; the estimate says so.
"""

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from derivations.experiments import describing_function as d
from loopbook.experiments.data import FrequencyData
from loopbook.experiments.plant import Estimate, ExperimentError, Plant, sum_of_lags
from loopbook.loop.ultimate_point import NoSuchFrequency, ultimate
from loopbook.records.record import Record
from loopbook.records.steps import noise_level

MOST_SWITCHINGS = 60
ROUNDING = 1e-13
SAME = 0.03  # how much the last periods may differ


@cache
def _process_gain() -> Callable[..., float]:
    import sympy

    return sympy.lambdify((d.y_a, d.u_a), d.process_gain(), "math")


def gain(y_a: float, u_a: float) -> float:
    """K180 = pi ya/(4 ua) from the amplitudes of output and relay.

    >>> round(gain(1.0, 1.0), 6)
    0.785398
    """
    return float(_process_gain()(y_a, u_a))


def apply_relay(plant: Plant, amplitude: float = 1.0, hysteresis: float = 0.0, horizon: float | None = None) -> Record:
    """Close the loop with a relay of levels +-amplitude that switches where y leaves +-hysteresis.

    The output between switchings is exact and each switching instant is found to rounding; with noise the relay sees
    samples, as in a computer. Without dead time a process of low order switches ever faster without hysteresis.
    Raises ExperimentError where the relay does not oscillate.
    """
    from scipy.optimize import brentq

    if not amplitude > 0 or not hysteresis >= 0:
        raise ExperimentError("a relay needs a positive amplitude and a hysteresis that is not negative")
    horizon = horizon or _horizon(plant)
    time = np.linspace(0.0, horizon, plant.samples)
    response = plant.step_response(horizon)
    noise = plant.measured(np.zeros_like(time))
    level = float(plant.clip(amplitude))
    switchings, y = [(0.0, level)], level * response(time)

    def output(t: float) -> float:
        instants, levels = np.array(switchings).T
        return float(np.diff(levels, prepend=0.0) @ response(t - instants))

    rounding = ROUNDING * np.abs(y).max()  # a response that starts at zero may start a rounding error away from it
    while len(switchings) < MOST_SWITCHINGS:
        side = 1.0 if switchings[-1][1] > 0 else -1.0
        later = np.flatnonzero((time > switchings[-1][0]) & (side * (y + noise) - hysteresis > rounding))
        if not later.size:
            break
        i = int(later[0])
        instant = float(time[i])
        if not plant.noise:
            beyond = lambda t: side * output(t) - hysteresis  # noqa: E731, B023
            left = max(float(time[i - 1]), switchings[-1][0])
            if beyond(left) < -rounding:
                instant = float(brentq(beyond, left, instant, xtol=1e-14 * horizon, rtol=1e-14))
        level = float(plant.clip(-side * amplitude))
        y += (level - switchings[-1][1]) * response(np.maximum(time - instant, -1.0))
        switchings.append((instant, level))
    if len(switchings) < 8:
        raise ExperimentError(
            f"the relay switched {len(switchings) - 1} times in {horizon:.4g} s and does not oscillate: the process "
            "answers too slowly for this horizon, or never leaves the hysteresis band"
        )
    if len(switchings) >= MOST_SWITCHINGS:
        raise ExperimentError(
            "the relay switches ever faster: the process has no lag of half a turn; add hysteresis or dead time"
        )
    u = np.zeros_like(time)
    for instant, value in switchings:
        u[time >= instant] = value
    return Record(time, u, y + noise, source="simulated")


def _horizon(plant: Plant) -> float:
    try:
        return 14 * ultimate(plant.process).T180
    except NoSuchFrequency:
        return 10 * (sum_of_lags(plant.process) + plant.process.delay)


def estimate(record: Record, hysteresis: float = 0.0) -> Estimate:
    """K180 and T180 from a recorded relay experiment, by the last four periods.

    Raises ExperimentError where u does not switch between two levels or the last periods differ.
    """
    levels = np.unique(record.u)
    if len(levels) != 2:
        raise ExperimentError(f"the input has {len(levels)} levels; a relay has two")
    switched = np.flatnonzero(np.diff(record.u)) + 1
    if len(switched) < 7:
        raise ExperimentError(f"the relay switches {len(switched)} times; seven are needed for a steady oscillation")
    ups = switched[record.u[switched] > levels.mean()]
    count = min(4, len(ups) - 1)
    last = record.time[ups[-count - 1 :]]
    periods = np.diff(last)
    tick = record.sampling
    if np.ptp(periods) > SAME * periods.mean() + 2 * tick:
        raise ExperimentError(f"the last periods differ, {periods.round(4)} s: the oscillation is not steady yet")
    inside = slice(ups[-count - 1], ups[-1] + 1)
    noise = noise_level(record.y)
    tops = [np.ptp(record.y[a : b + 1]) for a, b in zip(ups[-count - 1 : -1], ups[-count:], strict=True)]
    y_a = float(np.mean(tops)) / 2 - (2 * noise if noise > 1e-6 * np.ptp(record.y) else 0.0)
    u_a = float(np.ptp(levels)) / 2
    if hysteresis >= y_a:
        raise ExperimentError(f"hysteresis {hysteresis:.4g} is not below the amplitude {y_a:.4g} of the output")
    short = math.degrees(math.asin(hysteresis / y_a))
    duty = float(np.mean(record.u[inside] > levels.mean()))
    assumed = [
        "the output is nearly a sine, so the first harmonic of the relay's square wave decides",
        f"the process's phase at this frequency is {short:.1f} degrees short of -180, by the hysteresis",
    ]
    if abs(duty - 0.5) > 0.05:
        assumed.append(f"the relay is on {duty:.0%} of the time: the oscillation is asymmetric, a load is present")
    marks = {"y_a": y_a, "u_a": u_a, "phase": -180 + short, "start": float(last[0]), "end": float(last[-1])}
    return Estimate(FrequencyData(gain(y_a, u_a), float(periods.mean())), marks, tuple(assumed), record)
