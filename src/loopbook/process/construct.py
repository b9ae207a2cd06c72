"""A process from what is written down: coefficients or factors, and a dead time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from loopbook.process.algebra import LAPLACE, ONE
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.transfer_function import Process, ProcessError, TransferFunction


def tf(num: Any, den: Any = 1.0, delay: float = 0.0, *, h: float | None = None) -> Any:
    """num(s)/den(s) exp(-delay s), a `Process`; tf("s") is the variable s itself, to write formulas with.

    With a sampling interval h [s]: num(z)/den(z), descending powers of z, a `DiscreteProcess`.

    num, den: a number, descending coefficients, or several rows of them that are multiplied out. delay [s] >= 0, exact.
    Raises ProcessError for what is no process: improper, not finite, a negative dead time.

    >>> tf(2, [[10, 1], [4, 1]], delay=3)
    Process(num=(2.0,), den=(40.0, 14.0, 1.0), delay=3.0)
    >>> s = tf("s")
    >>> 2 / (10 * s + 1) * tf(1, delay=3)
    Process(num=(2.0,), den=(10.0, 1.0), delay=3.0)
    """
    if isinstance(num, str):
        if num != "s" or den != 1 or delay:
            raise ProcessError(f'tf({num!r}, ...): the only text is tf("s"), the variable s; else give coefficients')
        return TransferFunction(LAPLACE, ONE)
    if h is not None:
        if delay:
            raise ProcessError("a dead time in the z domain is a power of z: write it into den")
        return DiscreteProcess.in_z(_multiplied(num), _multiplied(den), h)
    return Process(_multiplied(num), _multiplied(den), delay)


def _multiplied(rows: Any) -> Any:
    if not (isinstance(rows, Sequence) and rows and all(isinstance(row, Sequence) for row in rows)):
        return rows
    product = np.array([1.0])
    for row in rows:
        product = np.polymul(product, row)
    return product.tolist()
