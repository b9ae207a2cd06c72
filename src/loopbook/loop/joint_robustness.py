"""The joint M of a loop: one number for both sensitivities, from the Nyquist curve with exact dead time.

    M = (1 + sqrt(1 - 4 Re L/|1 + L|^2))/2     at each point L of the curve with Re L < 0; the largest counts

The joint circle of that M (`derivations.loop.robustness.joint_circle`) is the largest the curve stays out of, so both
|1/(1 + L)| and |L/(1 + L)| stay below M. `loopbook.loop.continuous.Loop` has each of them alone.
"""

import math
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

import numpy as np

from loopbook.lazy import late
from loopbook.loop.process_phase import NoSuchFrequency, frequency_at
from loopbook.loop.stability import unstable_roots
from loopbook.loop.transfer import LoopTransfer
from loopbook.numerics import horner
from loopbook.numerics.units import characteristic_time
from loopbook.printed.store import kept_for, lambda_text, run_text
from loopbook.process.transfer_function import Process

d = late("derivations.loop.robustness")


@cache
def _at_point() -> Callable[..., Any]:
    return run_text(_text(), "numpy")


@kept_for()
def _text() -> str:
    return lambda_text((d.a, d.b), d.joint_M(), "numpy")


def joint_M(process: Process, regulator: Any) -> float:
    """The joint M of a process under a PID form of `loopbook.controllers.pid_forms`; inf where the loop is unstable.

    On a grid 0.3 % apart and 0.05 rad apart in dead-time phase, the largest value refined by a parabola through three
    points, which leaves an error below 1e-6 of M.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> round(joint_M(Process((1.0,), (1.0, 2.0, 1.0, 0.0)), PidStandard(K=0.5)), 4)
    1.971
    """
    num, den = regulator.transfer()
    loop = LoopTransfer(tuple(np.convolve(num, process.num)), tuple(np.convolve(den, process.den)), process.delay)
    if unstable_roots(loop):
        return math.inf
    w, response = _response(process)
    curve = response * horner.value(num, 1j * w) / horner.value(den, 1j * w)
    return _peak(np.where(curve.real < 0, _at_point()(np.minimum(curve.real, 0.0), curve.imag), 1.0))


@lru_cache(maxsize=160)
def _response(process: Process) -> tuple[np.ndarray, np.ndarray]:
    """The grid and the process's frequency response on it, kept for the other regulators of the same process."""
    w = _grid(process)
    return w, process(1j * w)


def _grid(process: Process) -> np.ndarray:
    try:
        middle = frequency_at(process, -2.5)
    except NoSuchFrequency:
        middle = 1 / characteristic_time(process.num, process.den, process.delay)
    coarse = middle * np.geomspace(1e-4, 1e3, 5400)
    return np.union1d(coarse, np.arange(0.05, 60, 0.05) / process.delay) if process.delay else coarse


def _peak(values: np.ndarray) -> float:
    """The largest value, by a parabola through the three samples around it."""
    i = int(np.argmax(values))
    if not 0 < i < len(values) - 1:
        return float(values[i])
    left, top, right = values[i - 1 : i + 2]
    bend = left - 2 * top + right
    return float(top - (right - left) ** 2 / (8 * bend) if bend < 0 else top)
