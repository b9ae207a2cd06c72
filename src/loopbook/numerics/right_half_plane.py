"""How far right of a line the zeros of a sum of polynomials times exponentials reach, and how many lie on the right.

    f(s) = p_0(s) + p_1(s) exp(-d_1 s) + ...        0 < d_1 < ...,  no p_k of a higher degree than p_0

They lie in a bounded box, unless the terms of the highest degree make a chain of them (a neutral equation).
"""

import math

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics.argument_principle import BoundaryError, Rectangle, zeros_right
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial, characteristic_time_of

FARTHEST = 1e4


class RootsError(LoopbookError):
    """The region holds infinitely many roots, or they could not be told; the message says what to ask instead."""


def chain(f: ExponentialPolynomial) -> float:
    """The real part that infinitely many zeros of f come near at most; -inf where they go ever farther left."""
    leads = [(delay, abs(p[0] / f.terms[0][1][0])) for delay, p in f.terms[1:] if len(p) - 1 == f.degree]
    if not leads:
        return -math.inf
    from scipy.optimize import brentq

    gap = lambda x: sum(a * math.exp(-delay * x) for delay, a in leads) - 1  # noqa: E731
    width = 1.0
    while gap(-width) < 0 or gap(width) > 0:
        width *= 2
    return float(brentq(gap, -width, width, xtol=1e-15, rtol=1e-14))


def zeros_on_the_right(f: ExponentialPolynomial) -> float:
    """How many zeros have a positive real part; infinitely many for an equation with a chain of them there.

    Raises BoundaryError for one on the imaginary axis.

    >>> zeros_on_the_right(ExponentialPolynomial.of([1.0, -1.0]) + ExponentialPolynomial.of([0.5], 1.0))
    1
    """
    f = f.delayed(-f.delays[0])
    time = characteristic_time_of(f)
    inside = f.in_units(time)
    if len(inside.terms[0][1]) - 1 < inside.degree or chain(inside) >= 0:
        return math.inf
    try:
        return zeros_right(inside, half_plane(inside, 0.0, limit=math.inf).right)
    except BoundaryError as error:
        raise BoundaryError(error.at / time) from None


def half_plane(f: ExponentialPolynomial, right_of: float, unit: float = 1.0, limit: float = FARTHEST) -> Rectangle:
    """The box that holds all zeros with Re s >= right_of. unit [s]: of time, for messages. limit: how many dead times'
    turns it may be high. Raises RootsError.
    """
    line = chain(f)
    if right_of <= line:
        raise RootsError(
            f"infinitely many roots come near Re s = {line / unit:.6g} 1/s, right of {right_of / unit:.6g}: ask for "
            "those right of a line beyond, or in a box"
        )
    size = np.zeros(f.degree + 1)
    for i, (delay, p) in enumerate(f.terms):
        if delay * right_of < -600:
            raise RootsError(f"Re s = {right_of / unit:.6g} 1/s is more than 600 dead times' decay away: ask nearer")
        here = np.abs(p) * math.exp(-delay * right_of)
        size[len(size) - len(p) :] += here if i else -here
    lead, rest = -size[0], size[1:] if len(size) > 1 else size[:0]
    rest = np.abs(f.terms[0][1][1:]) * 2 + rest  # |p_0| >= |a| R^n - the others
    reach = _largest_root(lead, rest)
    if reach * f.delays[-1] > limit:
        raise RootsError(
            f"right of {right_of / unit:.6g} there may be some {reach * f.delays[-1] / math.pi:.2g} roots, up to "
            f"{reach / unit:.4g} rad/s: ask for those farther right, or in a box"
        )
    return Rectangle(right_of, max(reach, right_of) + 1e-3 * reach + 1e-9, -1.001 * reach - 1e-9, 1.001 * reach + 1e-9)


def _largest_root(lead: float, rest: np.ndarray) -> float:
    """The R > 0 with lead R^n = rest_0 R^(n-1) + ... (one change of sign)."""
    if not rest.any():
        return 0.0
    n = len(rest)
    ratio = rest / lead
    high = 2 * max(float(c) ** (1 / (k + 1)) for k, c in enumerate(ratio) if c)  # Fujiwara
    low = 0.0
    for _ in range(60):
        middle = (low + high) / 2
        below = sum(float(c) / middle ** (k + 1) for k, c in enumerate(ratio)) < 1
        low, high = (low, middle) if below else (middle, high)
        if high - low < 1e-3 * high or n == 1:
            break
    return high
