"""Padé's approximation of a dead time: the rational function of given degrees that touches exp(-L s) at s = 0 best.

    exp(-x) = N(x)/D(x) + O(x^(m + n + 1)),    x = L s
    N(x) = sum_k (m + n - k)! m!/((m + n)! k! (m - k)!) (-x)^k

and D(x) the same with m and n exchanged, of -x.
"""

from dataclasses import dataclass
from math import comb, perm
from typing import Any

import numpy as np

from loopbook.numerics.real_numbers import plain_number, positive, whole
from loopbook.process.approximation import Approximates
from loopbook.process.rows import ProcessError
from loopbook.process.transfer_function import Process

MOST = 60


@dataclass(frozen=True, repr=False)
class ApproximateProcess(Approximates, Process):
    """A rational `Process` in place of one with dead time, with its name and its error. Make it with `pade`."""

    method: str = ""
    exact: Process | None = None

    def frequency_response(self, w: Any) -> Any:
        """The value at s = jw."""
        return self(1j * w)


def pade(process: Any, order: int | tuple[int, int]) -> ApproximateProcess:
    """A process, or a dead time alone [s], with Padé's approximation in the place of its dead time.

    order: of both polynomials, or (degree of the numerator, degree of the denominator), the first at most the second;
    60 at most. The result is a `Process` that knows its `error` and how far it is `good_to`.
    Raises ProcessError for other orders, and where there is no dead time.

    >>> approximate = pade(1.5, (2, 5))
    >>> [round(c, 6) for c in approximate.num]
    [0.053571, -0.428571, 1.0]
    >>> round(approximate.good_to(0.01), 3)
    2.139
    """
    m, n = order if isinstance(order, tuple | list) else (order, order)
    m, n = (whole(degree, "order", ProcessError) for degree in (m, n))
    if not (0 <= m <= n <= MOST and n > 0):
        raise ProcessError(
            f"order = {order!r}: a whole number from 1 to {MOST}, or (degree above, degree below), the first at "
            "most the second"
        )
    exact = process if isinstance(process, Process) else _dead_time(process)
    if not exact.delay:
        raise ProcessError("there is no dead time to approximate")
    p, q = exact.delay.as_integer_ratio()
    above = [comb(m, k) * (-p) ** k / (perm(m + n, k) * q**k) for k in range(m, -1, -1)]
    below = [comb(n, k) * p**k / (perm(m + n, k) * q**k) for k in range(n, -1, -1)]
    num, den = (tuple(np.convolve(p, q).tolist()) for p, q in ((exact.num, above), (exact.den, below)))
    name = f"Padé of order {n}" if m == n else f"Padé of order ({m}, {n})"
    return ApproximateProcess(num, den, 0.0, name, exact)


def _dead_time(value: Any) -> Process:
    try:
        return Process((1.0,), (1.0,), positive(plain_number(value), "delay", ProcessError, " s"))
    except TypeError:
        raise ProcessError(f"{type(value).__name__} has no dead time: give a Process or seconds") from None
