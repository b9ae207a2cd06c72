"""A sine on the input (pid-report, section 5.2.5), figure 5.5: gain and phase at one frequency, sought at -180 degrees.

    K180 = ya/ua,   T180: the period at which y lags u by half a turn

Amplitudes and phases come from a least-squares fit of a sine and a level over whole periods at the end of the record,
so noise averages out and what an actuator clips counts with its first harmonic.
"""

import math

import numpy as np

from loopbook.experiments.data import FrequencyData
from loopbook.experiments.plant import Estimate, ExperimentError, Plant
from loopbook.records.record import Record
from loopbook.records.steps import noise_level

PERIODS = 4  # fitted at the end of the record
STRIDE = 1.4  # from one frequency tried to the next
TREMOR = 0.05  # of the amplitude: what it may change between the two halves of the fitted periods


def apply_sine(plant: Plant, frequency: float, amplitude: float = 1.0, horizon: float | None = None) -> Record:
    """Make the experiment at one frequency [rad/s], long enough for the start to die out."""
    if plant.process.den[-1] == 0 or (plant.process.poles.real > 0).any():
        raise ExperimentError("the process has no steady answer to a sine; use the relay experiment, which holds it")
    period = 2 * math.pi / frequency
    lag = sum(1 / abs(p.real) for p in plant.process.poles)
    horizon = horizon or plant.process.delay + 12 * lag + (PERIODS + 1) * period
    return plant.play_sine(amplitude, frequency, horizon)


def fit(record: Record, frequency: float, first: float, last: float) -> tuple[complex, complex]:
    """Complex amplitudes of u and y at the frequency between two instants.

    A complex amplitude a stands for the signal Im(a e^(i w t)).
    """
    keep = (record.time >= first) & (record.time <= last)
    t = record.time[keep]
    basis = np.column_stack([np.sin(frequency * t), np.cos(frequency * t), np.ones_like(t)])
    both = np.column_stack([record.u[keep], record.y[keep]])
    sines, cosines, _ = np.linalg.lstsq(basis, both, rcond=None)[0]
    return complex(sines[0], cosines[0]), complex(sines[1], cosines[1])


def estimate(record: Record, frequency: float) -> Estimate:
    """Gain and phase at one frequency. data is None unless the phase is within 2 degrees of -180.

    Raises ExperimentError where the record is too short or too sparse, or the output has not settled into the sine.
    """
    period, end = 2 * math.pi / frequency, float(record.time[-1])
    if end < (PERIODS + 0.5) * period:
        raise ExperimentError(f"the record holds {end / period:.1f} periods; {PERIODS + 1} are needed")
    if period < 8 * record.sampling:
        raise ExperimentError(f"{period / record.sampling:.1f} samples a period are too few: sample faster")
    half = PERIODS / 2 * period
    u, y = fit(record, frequency, end - 2 * half, end)
    earlier, later = fit(record, frequency, end - 2 * half, end - half)[1], fit(record, frequency, end - half, end)[1]
    blur = 6 * noise_level(record.y) / math.sqrt(half / record.sampling)
    if abs(later - earlier) > TREMOR * abs(y) + blur:
        raise ExperimentError(
            f"the output is no steady sine: it changed by {abs(later - earlier) / abs(y):.0%} over the last {PERIODS} "
            "periods; record longer"
        )
    gain, angle = abs(y) / abs(u), float(np.angle(y / u))
    angle -= 2 * math.pi if angle > 0 else 0.0
    marks = {"gain": gain, "phase": math.degrees(angle), "y_a": abs(y), "u_a": abs(u), "w": frequency}
    data = FrequencyData(gain, period) if abs(marks["phase"] + 180) < 2 else None
    assumed = [f"the start has died out: the last {PERIODS} periods are a steady sine"]
    if abs(u) < 0.999 * np.abs(record.u).max():
        assumed.append("the actuator clips the sine: its first harmonic counts")
    return Estimate(data, marks, tuple(assumed), record)


def search(plant: Plant, lowest: float, highest: float, amplitude: float = 1.0) -> tuple[Estimate, list[float]]:
    """Repeat the experiment from the lowest frequency [rad/s] up until the phase passes -180 degrees, then close in.

    Returns the last experiment and all frequencies tried. Raises ExperimentError where the phase does not pass -180
    degrees on the way.
    """
    from scipy.optimize import brentq

    tried: list[float] = []

    def phase(w: float, near: float) -> float:
        tried.append(w)
        angle = estimate(apply_sine(plant, w, amplitude), w).marks["phase"]
        return angle + 360 * round((near - angle) / 360)

    low, here = lowest, phase(lowest, -90.0)
    while here > -180:
        low, before = tried[-1], here
        if low * STRIDE > highest or len(tried) > 60:
            raise ExperimentError(
                f"the phase does not pass -180 degrees between {lowest:.4g} and {highest:.4g} rad/s, it gets to "
                f"{here:.0f} degrees: try a wider range"
            )
        here = phase(low * STRIDE, before)
    if low == tried[-1]:
        raise ExperimentError(f"the phase is {here:.0f} degrees at {lowest:.4g} rad/s already: start lower")
    found = float(brentq(lambda w: phase(w, -180.0) + 180, low, low * STRIDE, xtol=1e-5 * low))
    tried.append(found)
    return estimate(apply_sine(plant, found, amplitude), found), tried
