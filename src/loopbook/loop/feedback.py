"""A loop closed by algebra: P/(1 + P C) as a transfer function."""

from typing import Any

from loopbook.controllers.regulator import Regulator
from loopbook.loop.loop_algebra import opened
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.transfer_function import as_process, simplest


def feedback(process: Any, regulator: Any = 1.0, sign: float = -1.0) -> Any:
    """P/(1 + P C): a process with a regulator from its output back to its input, exact dead time.

    process, regulator: transfer functions or numbers; the regulator may be a PID form, whose feedback path -u/y counts.
    sign: -1 for negative feedback. Without dead time a `Process`, else a `TransferFunction`; no pole is doubled.
    Raises ProcessError for what is no transfer function, and for an algebraic loop without a solution.

    >>> from loopbook.process.transfer_function import Process
    >>> feedback(Process([1], [5, 1]), 4)
    Process(num=(1.0,), den=(5.0, 5.0), delay=0.0)
    """
    return transfer_of(process).feedback(transfer_of(regulator), sign)


def transfer_of(system: Any) -> TransferAlgebra:
    """The transfer function of a process, a number, a loop (y/r), a PID form or another regulator (-u/y).

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> transfer_of(PidStandard(2.0, 4.0))
    Process(num=(2.0, 0.5), den=(1.0, 0.0), delay=0.0)
    """
    system = opened(system)
    system = system if isinstance(system, TransferAlgebra) else as_process(system)
    if isinstance(system, TransferAlgebra):
        return system
    regulator = Regulator.of(system)
    found: TransferAlgebra = simplest(ExponentialPolynomial.of(regulator.S), ExponentialPolynomial.of(regulator.R))
    return found
