"""A process or a z-domain plant from its state space, coefficients correctly rounded.

    x' = A x + B u,  y = C x + D u        G(s) = C (s I - A)^-1 B + D

By Faddeev and LeVerrier in whole numbers: what cancels cancels exactly, so that a strictly proper system has no leading
coefficients of rounding. Larger systems of floats are converted in double precision.
"""

import math
from fractions import Fraction
from typing import Any

import numpy as np

from loopbook.numerics.real_numbers import plain_number
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.rows import ProcessError
from loopbook.process.transfer_function import Process

EXACT_UP_TO = 6
LOST = 1e-13


def ss(
    A: Any, B: Any, C: Any, D: Any = 0.0, delay: float = 0.0, *, h: float | None = None
) -> Process | DiscreteProcess:
    """The transfer function from u to y. A (n, n), B n numbers, C n numbers, D one.

    delay [s]: the dead time, which a state space does not hold. h [s]: of x(k+1) = A x + B u; the result is then a
    `DiscreteProcess`. Raises ProcessError for shapes that do not fit, several inputs or outputs, entries that are no
    finite numbers.

    >>> ss([[0, 1], [-2, -3]], [0, 1], [1, 0], delay=1)
    Process(num=(1.0,), den=(1.0, 3.0, 2.0), delay=1.0)
    """
    a, b, c, d = (_matrix(m, name) for m, name in ((A, "A"), (B, "B"), (C, "C"), (D, "D")))
    n = len(a)
    if a.shape != (n, n) or b.size != n or c.size != n or d.size != 1:
        raise ProcessError(
            f"A {a.shape}, B {b.shape}, C {c.shape}, D {d.shape}: a square A and as many numbers in B and in C are "
            "expected, one in D: one input, one output"
        )
    transfer = _exact if n <= EXACT_UP_TO or not any(isinstance(x, float) for x in a.flat) else _rounded
    num, den = transfer(a, b.ravel(), c.ravel(), d.item())
    if h is not None:
        if delay:
            raise ProcessError("a dead time in the z domain is whole samples: add it as states, or multiply by z^-k")
        return DiscreteProcess.in_z(num, den, h)
    return Process(num, den, delay)


def _matrix(values: Any, name: str) -> np.ndarray:
    """The entries as floats where they are floats, else as they are, in an array of objects."""
    array = np.atleast_2d(np.asarray(values, dtype=object))
    array = array if array.size else np.empty((0, 0), dtype=object)
    found = np.empty(array.shape, dtype=object)
    try:
        for index, value in np.ndenumerate(array):
            found[index] = plain_number(value)
            if not math.isfinite(found[index]):
                raise TypeError
    except TypeError:
        raise ProcessError(f"{name} = {values!r}: a matrix of finite real numbers is expected") from None
    return found


def _exact(A: np.ndarray, B: np.ndarray, C: np.ndarray, D: Any) -> tuple[list[float], list[float]]:
    """In whole numbers: the matrices over one denominator each."""
    (a, q), (b, r), (c, t) = map(_over_one, (A, B, C))
    n, identity = len(A), _identity(len(A))
    adjugate, den, num = identity, [1], []
    for k in range(1, n + 1):
        num.append(int(c @ adjugate @ b))
        product = a @ adjugate
        den.append(-sum(product.diagonal()) // k)
        adjugate = product + den[k] * identity
    below = [Fraction(x, q**k) for k, x in enumerate(den)]
    above = [Fraction(0), *(Fraction(x, r * t * q**k) for k, x in enumerate(num))]
    return [float(x + Fraction(D) * y) for x, y in zip(above, below, strict=True)], [float(x) for x in below]


def _over_one(matrix: np.ndarray) -> tuple[np.ndarray, int]:
    """Whole numbers and the number that divides all of them."""
    exact = [Fraction(x) for x in matrix.flat]
    common = math.lcm(*(x.denominator for x in exact))
    whole = np.empty(len(exact), dtype=object)
    whole[:] = [int(x * common) for x in exact]
    return whole.reshape(matrix.shape), common


def _identity(n: int) -> np.ndarray:
    found = np.zeros((n, n), dtype=object)
    found[np.diag_indices(n)] = 1
    return found


def _rounded(A: np.ndarray, B: np.ndarray, C: np.ndarray, D: Any) -> tuple[list[float], list[float]]:
    """det(s I - A + B C) - (1 - D) det(s I - A) over det(s I - A)."""
    a, b, c = (np.asarray(m, dtype=float) for m in (A, B, C))
    den = np.atleast_1d(np.real(np.poly(a)))
    shifted = np.atleast_1d(np.real(np.poly(a - np.outer(b, c))))
    num = shifted + (float(D) - 1) * den
    num = np.where(np.abs(num) <= LOST * (np.abs(shifted) + np.abs(den)), 0.0, num)
    return num.tolist(), den.tolist()
