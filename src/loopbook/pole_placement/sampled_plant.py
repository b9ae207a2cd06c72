"""A plant as a program sees it: A(z) y = B(z) u with numbers, sampled exactly or rounded as a tool displays it."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from derivations.algebra.delay_polynomials import coefficients, polynomial
from derivations.sampling.zero_order_hold import dead_time_in_samples, two_lags, zero_order_hold
from loopbook.numerics.rational_numbers import decimal, rational


@dataclass(frozen=True)
class SampledPlant:
    """y(k) + a1 y(k-1) + ... = b1 u(k-1) + b2 u(k-2) + ..., exact numbers.

    a: (a1, a2, ...). b: (b1, b2, ...), with the zeros of the dead time. h: sampling interval, s.
    """

    a: tuple[Fraction, ...]
    b: tuple[Fraction, ...]
    h: Fraction

    @property
    def A(self) -> Any:
        """1 + a1 z^-1 + ... as a SymPy expression."""
        return _polynomial((1, *self.a))

    @property
    def B(self) -> Any:
        """b1 z^-1 + b2 z^-2 + ... as a SymPy expression."""
        return _polynomial((0, *self.b))

    @property
    def values(self) -> dict[str, Fraction]:
        """a_1, ..., and those b_i that are not zero, by name."""
        named = {f"a_{i}": c for i, c in enumerate(self.a, 1)} | {f"b_{i}": c for i, c in enumerate(self.b, 1) if c}
        return named

    @property
    def static_gain(self) -> Fraction:
        """B(1)/A(1), output per input. Raises ZeroDivisionError for an integrating plant."""
        return sum(self.b, Fraction()) / (1 + sum(self.a))

    def rounded(self, digits: int = 4) -> "SampledPlant":
        """The same plant with every coefficient rounded to significant digits, as MATLAB displays it.

        >>> SampledPlant((Fraction(-2, 3),), (Fraction(1, 3),), Fraction(1)).rounded().values
        {'a_1': Fraction(-6667, 10000), 'b_1': Fraction(3333, 10000)}
        """
        a, b = (tuple(Fraction(f"{float(c):.{digits}g}") for c in values) for values in (self.a, self.b))
        return SampledPlant(a, b, self.h)


def _polynomial(values: Sequence[Fraction | int]) -> Any:
    from sympy import Rational

    return polynomial([Rational(c.numerator, c.denominator) for c in map(Fraction, values)])


def sample_two_lags(T1: Any, T2: Any, gain: Any, dead_time: Any, h: Any, digits: int = 40) -> SampledPlant:
    """Zero-order-hold sampling of gain e^(-dead_time s) / ((T1 s + 1)(T2 s + 1)).

    T1, T2 > 0, dead_time >= 0, h > 0: s, as written decimals or fractions; gain: output per input. The coefficients
    are exact to ``digits`` digits. Source: `derivations.sampling.zero_order_hold`. Raises ValueError for h <= 0 and
    lags <= 0, SamplingError for a negative dead time.

    >>> plant = sample_two_lags(5, 7, Fraction(1, 8360), 2, 1)
    >>> [f"{float(c):.4g}" for c in plant.values.values()]
    ['-1.686', '0.7097', '1.526e-06', '1.361e-06']
    """
    from sympy import Rational

    given = {"T1": T1, "T2": T2, "gain": gain, "dead_time": dead_time, "h": h}
    exact = {name: decimal(value) for name, value in given.items()}
    for name in ("T1", "T2", "h"):
        if exact[name] <= 0:
            what = "the sampling interval" if name == "h" else "a time constant"
            raise ValueError(f"{name} = {given[name]}: {what} must be > 0 s")
    T1, T2, gain, dead_time, h = (Rational(v.numerator, v.denominator) for v in exact.values())
    model = zero_order_hold(two_lags(T1, T2, gain), h, *dead_time_in_samples(dead_time, h))
    a, b = ([rational(c, digits) for c in coefficients(p)[1:]] for p in (model.A, model.B))
    return SampledPlant(tuple(a), tuple(b), exact["h"])
