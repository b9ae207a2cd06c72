"""A process or a z-domain plant from its state space, coefficients correctly rounded.

    x' = A x + B u,  y = C x + D u        G(s) = C (s I - A)^-1 B + D

By Faddeev and LeVerrier in whole numbers: what cancels cancels exactly, so that a strictly proper system has no leading
coefficients of rounding. Larger systems of floats are converted in double precision.
"""

import math
from operator import mul
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
    if isinstance(values, np.ndarray) and values.dtype.kind == "f" and values.size and np.isfinite(values).all():
        return np.atleast_2d(values.astype(float)).astype(object)
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
    """In whole numbers: the matrices over one denominator each; every coefficient is rounded once."""
    (a, q), (b, r), (c, t) = map(_over_one, (A, B, C))
    (over, under), n = D.as_integer_ratio(), len(A)
    adjugate = [[int(i == j) for j in range(n)] for i in range(n)]
    den, num = [1], [0]
    for k in range(1, n + 1):
        through = [sum(map(mul, row, b)) for row in adjugate]
        num.append(sum(map(mul, c, through)))
        columns = list(zip(*adjugate, strict=True))
        adjugate = [[sum(map(mul, a[i * n : i * n + n], column)) for column in columns] for i in range(n)]
        den.append(-sum(adjugate[i][i] for i in range(n)) // k)
        for i in range(n):
            adjugate[i][i] += den[k]
    s = r * t  # num_k of the strictly proper part stands over s q^(k - 1), den_k over q^k
    above = [(x * q * under + over * y * s) / (s * under * q**k) for k, (x, y) in enumerate(zip(num, den, strict=True))]
    return above, [y / q**k for k, y in enumerate(den)]


def _over_one(matrix: np.ndarray) -> tuple[list[int], int]:
    """Whole numbers, row by row, and the number that divides all of them."""
    ratios = [x.as_integer_ratio() for x in matrix.flat]
    common = math.lcm(*(below for _, below in ratios))
    return [above * (common // below) for above, below in ratios], common


def _rounded(A: np.ndarray, B: np.ndarray, C: np.ndarray, D: Any) -> tuple[list[float], list[float]]:
    """det(s I - A + B C) - (1 - D) det(s I - A) over det(s I - A)."""
    a, b, c = (np.asarray(m, dtype=float) for m in (A, B, C))
    den = np.atleast_1d(np.real(np.poly(a)))
    shifted = np.atleast_1d(np.real(np.poly(a - np.outer(b, c))))
    num = shifted + (float(D) - 1) * den
    num = np.where(np.abs(num) <= LOST * (np.abs(shifted) + np.abs(den)), 0.0, num)
    return num.tolist(), den.tolist()
