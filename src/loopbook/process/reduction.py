"""Poles and zeros that cancel within a stated distance, taken out on request, and said."""

from typing import NamedTuple

import numpy as np

from loopbook.numerics.real_numbers import positive
from loopbook.process.rows import ProcessError
from loopbook.process.transfer_function import Process


class Reduction(NamedTuple):
    """process: without what cancels. cancelled: those poles [1/s], complex, of which some may be unstable."""

    process: Process
    cancelled: np.ndarray


def reduced(process: Process, within: float = 1e-8) -> Reduction:
    """The process without the pairs of a pole and a zero that differ by at most `within` of their size.

    Those at s = 0 must be there exactly. Hidden by the transfer function they are, gone from the plant they are not:
    one with a positive real part grows unseen.

    >>> reduced(Process([1, 1], [1, 3, 2]))
    Reduction(process=Process(num=(1.0,), den=(1.0, 2.0), delay=0.0), cancelled=array([-1.+0.j]))
    """
    positive(within, "within", ProcessError)
    zeros, poles, cancelled = list(process.zeros), list(process.poles), []
    for pole in process.poles:
        if zeros:
            nearest = min(zeros, key=lambda zero: abs(zero - pole))
            if abs(nearest - pole) <= within * abs(pole):
                zeros.remove(nearest)
                poles.remove(pole)
                cancelled.append(pole)
    if not cancelled:
        return Reduction(process, np.zeros(0, complex))
    num, den = (np.atleast_1d(np.real(np.poly(np.array(r)))) for r in (zeros, poles))
    found = Process(tuple(process.num[0] * num), tuple(process.den[0] * den), process.delay)
    return Reduction(found, np.array(cancelled))
