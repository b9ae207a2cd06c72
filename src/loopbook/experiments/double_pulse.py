"""Double pulse: a first-order model from the two extremes of the output (pid-report, section 5.2.3), figure 5.3.

    Kp = -ymax^2/(ua ymin),   T = -Tp/log(1 + ymin/ymax),   L = tmax - Tp = tmin - 2 Tp

The formulas come from `derivations.experiments.double_pulse.estimate` (the report prints the quotient in T upside
down).
"""

from collections.abc import Callable
from functools import cache

import numpy as np

from derivations.experiments import double_pulse as d
from loopbook.experiments.data import StepData
from loopbook.experiments.plant import Estimate, ExperimentError, Plant, settling_horizon, smooth
from loopbook.records.record import Record
from loopbook.records.steps import noise_level

ALIKE = 1e-3  # of the height: what the two pulses may differ by


@cache
def _functions() -> list[Callable[..., float]]:
    import sympy

    found = d.estimate()
    arguments = (d.u_a, d.T_p, d.y_max, d.y_min, d.t_max, d.t_min)
    return [sympy.lambdify(arguments, e, "math") for e in (found.K_p, found.T, found.L_from_max, found.L_from_min)]


def solve(
    u_a: float, T_p: float, y_max: float, y_min: float, t_max: float, t_min: float
) -> tuple[float, float, float, float]:
    """Kp, T and the two L from what was read off; times count from the first pulse.

    Raises ExperimentError unless 0 < -y_min < y_max, which a first-order process with dead time always gives.

    >>> Kp, T, *L = solve(1.0, 2.0, 0.8646647, -0.7476450, 3.0, 5.0)
    >>> round(Kp, 4), round(T, 4), L
    (1.0, 1.0, [1.0, 1.0])
    """
    if not 0 < -y_min < y_max:
        raise ExperimentError(
            f"y_max = {y_max:.4g}, y_min = {y_min:.4g}: a first-order process gives 0 < -y_min < y_max; make the "
            "pulses longer than the dead time, or use the step or relay experiment"
        )
    K_p, T, *L = (float(f(u_a, T_p, y_max, y_min, t_max, t_min)) for f in _functions())
    return K_p, T, L[0], L[1]


def apply_double_pulse(plant: Plant, width: float, amplitude: float = 1.0, horizon: float | None = None) -> Record:
    """Make the experiment: +amplitude for `width` seconds, -amplitude for as long, then zero."""
    horizon = horizon or 2 * width + settling_horizon(plant.process, 5.0)
    start = horizon / 19
    return plant.play([(start, amplitude), (start + width, -amplitude), (start + 2 * width, 0.0)], horizon * 20 / 19)


def estimate(record: Record) -> Estimate:
    """Kp, T and L from a recorded double pulse; L is the mean of its two estimates.

    marks hold both, L_from_max and L_from_min: they agree where the process is of first order.
    Raises ExperimentError where the input is no double pulse.
    """
    changes = np.flatnonzero(np.diff(record.u))
    if len(changes) != 3:
        raise ExperimentError(f"the input changes {len(changes)} times; a double pulse changes three times")
    t = record.time[changes + 1]
    up, down, end = (float(record.u[i + 1]) for i in changes)
    rest = float(record.u[0])
    height = abs(up - rest)
    if abs(up + down - 2 * rest) > ALIKE * height or abs(end - rest) > ALIKE * height:
        raise ExperimentError("the two pulses differ in height, or the input does not return to where it was")
    if abs((t[2] - t[1]) - (t[1] - t[0])) > 2.5 * record.sampling:
        raise ExperimentError(f"the two pulses differ in width: {t[1] - t[0]:.4g} s and {t[2] - t[1]:.4g} s")
    width = float(t[2] - t[0]) / 2
    noisy = noise_level(record.y) > 1e-6 * np.ptp(record.y)
    y = smooth(record.y, 2 * (len(record.y) // 400) + 1) if noisy else record.y
    y = (y - np.mean(record.y[: changes[0] + 1])) * np.sign(up - rest)
    top, bottom = int(np.argmax(y)), int(np.argmin(y))
    marks = {"y_max": float(y[top]), "y_min": float(y[bottom])}
    marks |= {"t_max": float(record.time[top] - t[0]), "t_min": float(record.time[bottom] - t[0])}
    Kp, T, from_max, from_min = solve(abs(up - rest), width, **marks)
    data = StepData(Kp, T, max((from_max + from_min) / 2, 0.0))
    assumed = (
        "the process is of first order with dead time: the extremes lie where the pulses end, seen L later",
        f"the two dead times, {from_max:.4g} s and {from_min:.4g} s, differ by {abs(from_max - from_min):.2g} s",
    )
    marks |= {"L_from_max": from_max, "L_from_min": from_min, "T_p": width, "u_a": abs(up - rest), "t0": float(t[0])}
    return Estimate(data, marks, assumed, record)
