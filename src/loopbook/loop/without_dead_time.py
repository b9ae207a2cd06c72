"""The closed loop of a process without dead time as one minimal transfer function, an ideal derivative allowed.

    Y/R = T B/(R A + S B)        no common factor of regulator and process is multiplied in twice

A regulator that differentiates the error without a filter answers a step of the reference with an impulse, so its
control signal cannot be drawn; the output can, where the process has a relative degree of two or more.
"""

from typing import Any

import numpy as np
from scipy.linalg import expm

from loopbook.controllers.regulator import Regulator
from loopbook.loop.stability import is_stable
from loopbook.loop.transfer import LoopTransfer
from loopbook.numerics import units
from loopbook.numerics.state_space import observer_form
from loopbook.numerics.step_response import open_loop_step
from loopbook.process.transfer_function import Process, ProcessError
from loopbook.response.step_metrics import StepMetrics, exact_metrics

DIED_OUT = 1e-11


def reference_to_output(process: Process, regulator: Any) -> Process:
    """Y/R = T B/(R A + S B) as a `Process`, whose `step` is exact.

    process: without dead time. regulator: anything that `Regulator.of` takes, T/R and S/R may be improper by one.
    Raises ProcessError for a process with dead time (use `loopbook.loop.continuous.Loop`) and where the closed loop is
    improper.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> closed = reference_to_output(Process([2], [6, 5, 1]), PidStandard(2.0, 5.4, 0.4, c=1.0))
    >>> closed.order, round(closed.static_gain, 12)
    (3, 1.0)
    """
    if process.delay:
        raise ProcessError(f"the process has a dead time of {process.delay} s: use loopbook.loop.continuous.Loop")
    r = Regulator.of(regulator)
    below = np.polyadd(np.polymul(r.R, process.den), np.polymul(r.S, process.num))
    return Process(tuple(np.polymul(r.T, process.num)), tuple(below))


def time_to_settle(process: Process) -> float:
    """A time [s] after which every mode of num/den has fallen by eleven decades, equal ones too.

    Raises ProcessError for poles that are not on the left.

    >>> 25 < time_to_settle(Process([1], [1, 1])) < 60
    True
    """
    if not is_stable(LoopTransfer((0.0,), process.den)):
        worst = float(process.poles.real.max())
        raise ProcessError(f"the transfer function has a pole with real part {worst:.4g} 1/s: it does not settle")
    time = units.characteristic_time(process.num, process.den, process.delay)
    A = observer_form(units.in_units(process.den, time), [(1.0,)]).A
    span = 1.0
    if len(A):
        span = 1 / float(abs(np.linalg.eigvals(A)).max())
        modes = expm(A * span)
        while np.abs(modes).sum(axis=1).max() > DIED_OUT:
            modes, span = modes @ modes, 2 * span
    return span * time


def metrics(closed: Process) -> StepMetrics:
    """Step metrics, convention `exact`, of a stable transfer function, its dead time included.

    From rest: a response that jumps at once has risen at once. The response is followed until all modes have died out.
    Raises ProcessError for poles that are not on the left.

    >>> round(metrics(Process.fopdt(1, 10, 5)).settling, 2)      # 5 + 10 ln 50
    44.12
    """
    horizon = time_to_settle(closed)
    y = open_loop_step(closed, horizon).delayed(closed.delay)
    return exact_metrics(y, closed.static_gain, y.end)
