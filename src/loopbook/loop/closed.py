"""The transfer functions of a closed loop from each input to each signal, dead time exact.

    y = P (u + d) + W w,   u = T/R r - S/R (y + n),   P = B/A exp(-L s),    X = R A + S B exp(-L s)

    from     to y                to u
    r        T B exp(-L s)/X     T A/X
    d        R B exp(-L s)/X     -S B exp(-L s)/X
    n        -S B exp(-L s)/X    -S A/X
    w        R A W/X             -S A W/X

r reference, d load at the process input, n noise on the measurement, w what enters elsewhere.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.process.rows import over_one_denominator
from loopbook.process.transfer_function import DelayedSum, Process, TransferFunction, simplest
from loopbook.response.closed_loop import INPUTS, ResponseError

OUTPUTS = ("y", "u")

Row = Sequence[float]


class LoopRows(NamedTuple):
    """The polynomials of a loop, descending coefficients, and its dead time [s]."""

    B: Row
    A: Row
    T: Row
    S: Row
    R: Row
    delay: float

    @property
    def characteristic(self) -> ExponentialPolynomial:
        """X = R A + S B exp(-L s), whose zeros are the poles of the closed loop."""
        return _of(self.R, self.A) + _of(self.S, self.B, delay=self.delay)


def _of(*factors: Row, delay: float = 0.0, sign: float = 1.0) -> ExponentialPolynomial:
    product = np.ones(1)
    for factor in factors:
        product = np.convolve(product, factor)
    return ExponentialPolynomial.of((sign * product).tolist(), delay)


def closed(
    loop: LoopRows, source: str, output: str, path: Process | DelayedSum | None = None
) -> Process | DelayedSum | TransferFunction:
    """From "reference", "load", "noise" or "disturbance" to "y" or "u".

    Raises ResponseError for another name, and for a disturbance without its path W.

    >>> closed(LoopRows([2.0], [3.0, 1.0], [0.5], [0.5], [1.0], 0.0), "reference", "y")
    Process(num=(1.0,), den=(3.0, 2.0), delay=0.0)
    """
    if source not in INPUTS:
        raise ResponseError(f"source = {source!r}; one of {', '.join(INPUTS)}")
    if output not in OUTPUTS:
        raise ResponseError(f"output = {output!r}; one of {', '.join(OUTPUTS)}")
    B, A, T, S, R, L = loop
    below, to_y = loop.characteristic, output == "y"
    if source == "reference":
        return simplest(_of(T, B, delay=L) if to_y else _of(T, A), below)
    if source == "load":
        return simplest(_of(R, B, delay=L) if to_y else _of(S, B, delay=L, sign=-1.0), below)
    if source == "noise":
        return simplest(_of(S, B, delay=L, sign=-1.0) if to_y else _of(S, A, sign=-1.0), below)
    if path is None:
        raise ResponseError("a disturbance needs the path it takes to the output: Loop(process, regulator, path)")
    return _through(path, A, R if to_y else S, 1.0 if to_y else -1.0, below)


def _through(path: Process | DelayedSum, A: Row, row: Row, sign: float, below: ExponentialPolynomial) -> Any:
    """sign row A W/X: factors that A and the denominator of W share stand once."""
    num, den = path.fraction
    ((_, d),) = den.terms
    beside, quotient, _ = over_one_denominator(A, d)
    return simplest(num * _of(row, quotient.tolist(), sign=sign), below * _of(beside.tolist()))
