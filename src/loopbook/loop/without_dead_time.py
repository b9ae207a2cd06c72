"""The closed loop of a process without dead time as one minimal transfer function, an ideal derivative allowed.

    Y/R = T B/(R A + S B)        no common factor of regulator and process is multiplied in twice

A regulator that differentiates the error without a filter answers a step of the reference with an impulse, so its
control signal cannot be drawn; the output can, where the process has a relative degree of two or more.
"""

from typing import Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.process.transfer_function import Process, ProcessError


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


def metrics(closed: Process) -> Any:
    """Step metrics, convention `exact`, of a stable transfer function; see `loopbook.response.step_metrics`.

    The horizon is twelve times the slowest time constant. Raises ProcessError for poles that are not on the left.
    """
    from loopbook.numerics.step_response import open_loop_step
    from loopbook.response.step_metrics import exact

    slowest = -closed.poles.real.max()
    if not slowest > 0:
        raise ProcessError(f"the closed loop has a pole with real part {-slowest:.4g} 1/s: it does not settle")
    horizon = float(12 / slowest)
    return exact(open_loop_step(closed, horizon), closed.static_gain, horizon)
