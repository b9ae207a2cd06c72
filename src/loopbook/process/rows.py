"""The coefficients of a transfer function, taken from whatever holds a row of numbers."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics.multiple_roots import roots_of
from loopbook.numerics.real_numbers import in_a_sentence, plain_number
from loopbook.numerics.units import characteristic_time, in_units


class ProcessError(LoopbookError):
    """A transfer function that cannot be a process; the message says which number and why."""


def checked_coefficients(values: Sequence[float], name: str) -> tuple[float, ...]:
    """Descending real coefficients without leading zeros; ProcessError for anything else.

    >>> checked_coefficients([0, 2, 1], "num")
    (2.0, 1.0)
    """
    if not (type(values) is tuple and values and all(type(c) is float for c in values)):
        values = _row(values, name)
    if not all(map(math.isfinite, values)):
        raise ProcessError(f"{name} = {in_a_sentence(values)}: the coefficients must be finite")
    row = list(values)
    while len(row) > 1 and not row[0]:
        del row[0]
    return tuple(row) if row != [0.0] else (0.0,)


def _row(values: Any, name: str) -> list[float]:
    """A row of floats from whatever holds one."""
    array = np.atleast_1d(np.asarray(values, dtype=object))
    row = list(array)
    if not row or array.ndim > 1 or isinstance(row[0], list | tuple):
        raise ProcessError(
            f"{name} = {in_a_sentence(values)}: a row of coefficients in descending powers of s is expected"
        )
    try:
        return [float(plain_number(c)) for c in row]
    except (TypeError, OverflowError):
        raise ProcessError(f"{name} = {in_a_sentence(values)}: the coefficients must be real numbers") from None


def roots_in_own_time(p: Sequence[float]) -> np.ndarray:
    """The roots of a row, complex, found in its own unit of time; those that rounding split are put together.

    >>> roots_in_own_time((4.0, 0.0, 1.0)).imag.tolist()
    [0.5, -0.5]
    """
    time = characteristic_time((1.0,), p, 0.0)
    return roots_of(in_units(p, time)) / time


def over_one_denominator(first: Sequence[float], second: Sequence[float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(a, b, d) with first * a = second * b = d, of the least degree that can be told without rounding.

    Equal denominators, one that divides the other, and factors s that both have, stand once.

    >>> [row.tolist() for row in over_one_denominator([1.0, 1.0, 0.0], [2.0, 0.0])]
    [[1.0], [0.5, 0.5], [1.0, 1.0, 0.0]]
    """
    p, q = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    one = np.ones(1)
    if len(p) >= len(q) and (factor := _quotient(p, q)) is not None:
        return one, factor, p
    if (factor := _quotient(q, p)) is not None:
        return factor, one, q
    shared = min(len(p) - 1 - int(np.flatnonzero(p)[-1]), len(q) - 1 - int(np.flatnonzero(q)[-1]))
    short_p, short_q = p[: len(p) - shared], q[: len(q) - shared]
    return short_q, short_p, np.convolve(p, short_q)


def _quotient(p: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """p/q where q divides p within the rounding of its coefficients, else None."""
    rest, divisor, steps = p.tolist(), q.tolist(), len(p) - len(q) + 1
    if steps < 1:
        return None
    for i in range(steps):  # the quotient takes the place of what it explains
        rest[i] /= divisor[0]
        for j, c in enumerate(divisor[1:], i + 1):
            rest[j] -= rest[i] * c
    quotient = np.array(rest[:steps])
    width = np.convolve(np.abs(quotient), np.abs(q))[steps:]
    return quotient if (np.abs(rest[steps:]) <= 4 * np.finfo(float).eps * width).all() else None
