"""Sums of polynomials times exponentials, what a transfer function with dead times is made of.

    f(s) = p_0(s) exp(-d_0 s) + p_1(s) exp(-d_1 s) + ...        d_0 < d_1 < ...

Real coefficients in descending powers of s, d_k [s]. They are closed under addition and multiplication.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.numerics import horner
from loopbook.numerics.units import in_units, octaves, power_of_two, rounded_sum

SAME_DELAY = 1e-13
"""Of the longest delay: sums of the same delays in another order differ by that much."""


def same_delay(first: float, second: float) -> bool:
    """Are two dead times [s] the same within rounding?"""
    return abs(first - second) <= SAME_DELAY * max(abs(first), abs(second))


@dataclass(frozen=True)
class ExponentialPolynomial:
    """terms: (d_k, p_k), ascending in d_k, which all differ; no p_k is zero. Make it with `of`.

    >>> f = ExponentialPolynomial.of([1, 1]) + ExponentialPolynomial.of([2], 3)          # s + 1 + 2 exp(-3 s)
    >>> float(f(0.0)), (f * f).delays
    (3.0, (0.0, 3.0, 6.0))
    """

    terms: tuple[tuple[float, tuple[float, ...]], ...]

    @classmethod
    def of(cls, p: Sequence[float], delay: float = 0.0) -> "ExponentialPolynomial":
        """p(s) exp(-delay s)."""
        return cls._collected([(float(delay), tuple(map(float, p)))])

    @classmethod
    def _collected(cls, terms: Iterable[tuple[float, Sequence[float]]]) -> "ExponentialPolynomial":
        ordered = sorted(terms, key=lambda term: term[0])
        longest = max((abs(delay) for delay, _ in ordered), default=0.0)
        merged: list[tuple[float, tuple[float, ...]]] = []
        for delay, p in ordered:
            if merged and delay - merged[-1][0] <= SAME_DELAY * longest:
                merged[-1] = merged[-1][0], tuple(rounded_sum(merged[-1][1], p).tolist())
            else:
                merged.append((delay, tuple(p)))
        return cls(tuple((delay, stripped) for delay, p in merged if any(stripped := _stripped(p))))

    @property
    def delays(self) -> tuple[float, ...]:
        """The d_k."""
        return tuple(delay for delay, _ in self.terms)

    @property
    def is_zero(self) -> bool:
        """Is there no term?"""
        return not self.terms

    @cached_property
    def degree(self) -> int:
        """The highest power of s in any term; -1 for zero."""
        return max((len(p) - 1 for _, p in self.terms), default=-1)

    def __add__(self, other: "ExponentialPolynomial") -> "ExponentialPolynomial":
        return self._collected((*self.terms, *other.terms))

    def __neg__(self) -> "ExponentialPolynomial":
        return self * -1.0

    def __sub__(self, other: "ExponentialPolynomial") -> "ExponentialPolynomial":
        return self + -other

    def __mul__(self, other: "ExponentialPolynomial | float") -> "ExponentialPolynomial":
        if not isinstance(other, ExponentialPolynomial):
            return self._collected((delay, [other * c for c in p]) for delay, p in self.terms)
        return self._collected((d + e, np.convolve(p, q).tolist()) for d, p in self.terms for e, q in other.terms)

    def over(self, number: float) -> "ExponentialPolynomial":
        """f(s)/number."""
        return self._collected((delay, [c / number for c in p]) for delay, p in self.terms)

    def __call__(self, s: Any) -> Any:
        s = np.asarray(s)
        total = 0.0 * s
        for delay, p in self.terms:
            total = total + horner.value(p, s) * (np.exp(-delay * s) if delay else 1.0)
        return total

    def delayed(self, more: float) -> "ExponentialPolynomial":
        """f(s) exp(-more s); more may be negative."""
        return self._collected((delay + more, p) for delay, p in self.terms)

    def mirrored(self) -> "ExponentialPolynomial":
        """f(-s) exp(-d s) with the longest delay d: its zeros are those of f with the sign turned."""
        longest = self.delays[-1]
        return self._collected(
            (longest - delay, [c * (-1) ** (len(p) - 1 - i) for i, c in enumerate(p)]) for delay, p in self.terms
        )

    def over_s(self, power: int) -> "ExponentialPolynomial":
        """f(s)/s^power, where that many last coefficients of each term are zero."""
        return ExponentialPolynomial(tuple((delay, p[: len(p) - power]) for delay, p in self.terms))

    def in_units(self, time: float, gain: float = 1.0) -> "ExponentialPolynomial":
        """f(s/time)/gain: f as a function of s time. time, gain: powers of two, which round nothing."""
        return ExponentialPolynomial(tuple((delay / time, in_units(p, time, gain)) for delay, p in self.terms))

    def derivative(self) -> "ExponentialPolynomial":
        """df/ds."""
        return self._collected(
            (delay, np.polysub(np.polyder(p) if len(p) > 1 else [0.0], delay * np.asarray(p)).tolist())
            for delay, p in self.terms
        )

    def taylor(self, s: Any) -> list[tuple[np.ndarray, np.ndarray]]:
        """Of each term its exponential exp(-d s) and the Taylor coefficients of p at s, from s^0 up.

        Shapes: that of s, and (degree + 1, *shape of s).
        """
        s = np.asarray(s)
        return [(np.exp(-delay * s), _taylor(p, s)) for delay, p in self.terms]

    def order_at_zero(self) -> tuple[int, float]:
        """(k, c) with f(s) = c s^k + O(s^(k + 1)) at s = 0; (0, 0) for zero.

        >>> (ExponentialPolynomial.of([1]) - ExponentialPolynomial.of([1], 2)).order_at_zero()
        (1, 2.0)
        """
        for k in range(2 * (self.degree + len(self.terms)) + 1):
            parts = [
                c * (-delay) ** (k - i) / math.factorial(k - i)
                for delay, p in self.terms
                for i, c in enumerate(reversed(p))
                if i <= k
            ]
            total = math.fsum(parts)
            if abs(total) > 8 * np.finfo(float).eps * math.fsum(map(abs, parts)):
                return k, total
        return 0, 0.0


def _stripped(p: Sequence[float]) -> tuple[float, ...]:
    first = next((i for i, c in enumerate(p) if c), len(p))
    return tuple(p[first:])


def _taylor(p: Sequence[float], s: np.ndarray) -> np.ndarray:
    """By repeated synthetic division."""
    rows = [np.full(s.shape, c, dtype=np.result_type(s, float)) for c in p]
    for last in range(len(rows), 1, -1):
        for i in range(1, last):
            rows[i] = rows[i] + s * rows[i - 1]
    return np.array(rows[::-1])


def characteristic_time_of(*functions: ExponentialPolynomial) -> float:
    """A power of two near the time [s] in which quotients of such sums move, from their roots' sizes and their delays.

    >>> characteristic_time_of(ExponentialPolynomial.of([1e-3, 1.0])) == 2.0**-10
    True
    """
    terms = [term for f in functions for term in f.terms]
    found = sorted(octave for _, p in terms for octave in octaves(p))
    if found:
        return math.ldexp(1.0, -round((found[len(found) // 2] + found[(len(found) - 1) // 2]) / 2))
    return power_of_two(max((abs(delay) for delay, _ in terms), default=1.0) or 1.0)
