"""Thiran's all-pass filter for a delay of any number of samples: group delay maximally flat at low frequencies.

    z^-N A(z^-1 -> z)/A,    A = sum_k (-1)^k binomial(N, k) prod_(i=0..N) (D - N + i)/(D - N + k + i) z^-k

D: the delay in samples, N - 1 < D for stability. J.-P. Thiran, IEEE Trans. Circuit Theory 18 (1971) 659.
"""

from fractions import Fraction
from math import ceil, comb, prod

from loopbook.numerics.real_numbers import positive
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.rows import ProcessError
from loopbook.process.transfer_function import Process

WHOLE, MOST = Fraction(1, 10**9), 40


def thiran(delay: float, h: float, order: int | None = None) -> DiscreteProcess:
    """A delay [s] as an all-pass filter sampled every h seconds; it knows its error against exp(-delay s).

    order: N, by default the least whole number that is not below delay/h; 1 <= N < delay/h + 1. A whole number of
    samples is a pure delay and exact. Raises ProcessError for an order that would make it unstable.

    >>> [round(c, 6) for c in thiran(2.4, 1.0).den]
    [1.0, 0.529412, -0.048128, 0.004159]
    """
    exact = Process((1.0,), (1.0,), positive(delay, "delay", ProcessError, " s"))
    D = Fraction(exact.delay) / Fraction(positive(h, "h", ProcessError, " s"))
    whole = round(D)
    if abs(D - whole) <= WHOLE * (D + 1) and order in (None, whole):
        return DiscreteProcess((0.0,) * whole + (1.0,), (1.0,), h, "whole samples", exact)
    N = ceil(D) if order is None else order
    if not (isinstance(N, int) and 1 <= N <= MOST and N < D + 1):
        raise ProcessError(
            f"order = {order!r}: a whole number from 1 to {min(MOST, ceil(D + 1) - 1)} for {float(D):.6g} samples "
            "(above it the filter is unstable)"
        )
    factors = [[(D - N + i) / (D - N + k + i) for i in range(N + 1)] for k in range(N + 1)]
    row = [float((-1) ** k * comb(N, k) * prod(each)) for k, each in enumerate(factors)]
    return DiscreteProcess(tuple(reversed(row)), tuple(row), h, f"Thiran of order {N}", exact)
