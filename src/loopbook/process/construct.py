"""A process from what is written down: coefficients or factors, and a dead time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from loopbook.process.transfer_function import Process


def tf(num: Any, den: Any = 1.0, delay: float = 0.0) -> Process:
    """num(s)/den(s) exp(-delay s).

    num, den: a number, descending coefficients, or several rows of them that are multiplied out. delay [s] >= 0, exact.
    Raises ProcessError for what is no process: improper, not finite, a negative dead time.

    >>> tf(2, [[10, 1], [4, 1]], delay=3)
    Process(num=(2.0,), den=(40.0, 14.0, 1.0), delay=3.0)
    """
    return Process(_multiplied(num), _multiplied(den), delay)


def _multiplied(rows: Any) -> Any:
    if not (isinstance(rows, Sequence) and rows and all(isinstance(row, Sequence) for row in rows)):
        return rows
    product = np.array([1.0])
    for row in rows:
        product = np.polymul(product, row)
    return product.tolist()
