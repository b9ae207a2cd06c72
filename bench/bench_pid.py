"""A million steps of the discrete PID beside simple-pid, on the same recorded measurement.

Both have limits, derivative on the measurement and an integral kept within the limits. simple-pid has no derivative
filter and no set-point weight and adds e to its integral before the output is set; the difference of the outputs is
shown so that the two columns are known to be the same kind of work.
"""

import time
from collections.abc import Callable
from importlib.util import find_spec

import numpy as np

from loopbook.controllers import Pid, PidSettings

STEPS = 1_000_000
SETTINGS = PidSettings(K=2.0, Ti=4.0, Td=0.5, Tf=0.0, h=0.1, u_low=-10.0, u_high=10.0, anti_windup="clamping")


def measurement(steps: int) -> np.ndarray:
    """A slow swing with noise, the same on every run."""
    t = np.arange(steps) * SETTINGS.h
    return np.sin(0.05 * t) + 0.02 * np.random.default_rng(1).standard_normal(steps)


def _loopbook_step(y: list[float]) -> list[float]:
    step = Pid(SETTINGS).step
    return [step(value, 0.5) for value in y]


def _loopbook_run(y: list[float]) -> np.ndarray:
    return Pid(SETTINGS).run(y, 0.5, np.empty(len(y)))


def _simple_pid(y: list[float]) -> list[float]:
    from simple_pid import PID

    s = SETTINGS
    pid = PID(s.K, s.K / s.Ti, s.K * s.Td, setpoint=0.5, sample_time=None, output_limits=(s.u_low, s.u_high))
    return [pid(value, dt=s.h) for value in y]


def rows(steps: int = STEPS) -> list[tuple[str, float | str, str]]:
    """(what, seconds, remark) for each way to run ``steps`` samples; the fastest of three."""
    y = measurement(steps).tolist()
    ways: dict[str, Callable] = {"Pid.step": _loopbook_step, "Pid.run": _loopbook_run}
    found, outputs = [], {}
    if find_spec("simple_pid"):
        ways = {"simple-pid": _simple_pid, **ways}
    else:
        found.append(("simple-pid", "missing", "not installed: pip install simple-pid"))
    for name, way in ways.items():
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            outputs[name] = way(y)
            seconds.append(time.perf_counter() - start)
        first = next(iter(outputs))
        distance = np.sqrt(np.mean((np.asarray(outputs[name]) - np.asarray(outputs[first])) ** 2))
        apart = "" if name == first else f", output differs by {distance:.2g} (rms) from {first}"
        found.append((f"{name}, {steps} steps", min(seconds), f"{min(seconds) / steps * 1e9:.0f} ns a step{apart}"))
    return found
