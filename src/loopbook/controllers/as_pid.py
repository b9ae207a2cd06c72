"""A transfer function read as a PID controller, where it is one exactly: P + I/s + D N s/(s + N)."""

from typing import Any

import numpy as np

from loopbook.controllers.pid_forms import FormError, PidParallel
from loopbook.controllers.regulator import Regulator

SAME = 1e-12


def as_pid(system: Any) -> PidParallel:
    """The `PidParallel`, all parts on the error, with this transfer function.

    system: a `Regulator` with T = S, a rational `Process`, or a continuous `control.TransferFunction`; poles at s = 0
    (one at most) and at -N (one at most), no more zeros than poles and one.
    Raises FormError for any other, which no PID controller is.

    >>> as_pid(Regulator.one_dof([6.0, 3.0, 1.0], [0.5, 1.0, 0.0]))
    PidParallel(P=2.5, I=1.0, D=4.75, N=2.0, b=1.0, c=1.0)
    """
    if hasattr(system, "ninputs") and hasattr(system, "num") and not system.dt:
        regulator = Regulator.one_dof(system.num[0][0], system.den[0][0])
    else:
        regulator = Regulator.of(system)
    if regulator.T != regulator.S:
        raise FormError(
            "the reference takes another way than the measurement, which one transfer function does not tell"
        )
    S, R = (np.asarray(row) / regulator.R[0] for row in (regulator.S, regulator.R))
    integrates = len(R) > 1 and R[-1] == 0
    rest = R[:-1] if integrates else R
    if len(rest) > 2 or (len(rest) == 2 and not rest[1] > 0):
        where = ", ".join(f"{p:.4g}" for p in np.roots(R))
        raise FormError(f"poles at {where}: a PID controller has one at 0 and one filter's pole on the left at most")
    if len(S) > len(R) + 1 or (len(rest) == 2 and len(S) > len(R)):
        raise FormError(f"{len(S) - 1} zeros and {len(R) - 1} poles: a PID controller has no more zeros than that")
    a2, a1, a0 = np.concatenate([np.zeros(3), S if integrates else np.append(S, 0.0)])[-3:]
    if len(rest) == 1:
        return PidParallel(float(a1), float(a0), float(a2))
    N = float(rest[1])
    I = a0 / N
    P = (a1 - I) / N
    D = (a2 - P) / N
    D = 0.0 if abs(D * N) <= SAME * (abs(a2) + abs(P)) else D
    return PidParallel(float(P), float(I), float(D), N)
