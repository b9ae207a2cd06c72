"""Transfer functions add, multiply, divide and close loops: the operators, for every kind of them.

    P + Q    P - Q    P * Q    P / Q    2 * P    P / 2    1 / P    -P    P ** 2    P ** -1    feedback

Dead times enter exactly: those of factors add up, a sum keeps those of its terms. Polynomials that stand above and
below and are the same number for number cancel, so that P / P is 1; nothing else is cancelled but on request
(`loopbook.process.reduction`).
"""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.real_numbers import plain_number, real, real_array
from loopbook.numerics.signals import Signal
from loopbook.process.rows import ProcessError, over_one_denominator

Fraction = tuple[ExponentialPolynomial, ExponentialPolynomial]
ONE = ExponentialPolynomial.of((1.0,))
TINY = float(np.finfo(float).tiny)
LAPLACE = ExponentialPolynomial.of((1.0, 0.0))


class TransferAlgebra(ABC):
    """What has a numerator and a denominator, each a sum of polynomials times exponentials."""

    __array_ufunc__ = None  # a NumPy number on the left leaves the operation to us

    @property
    @abstractmethod
    def fraction(self) -> Fraction:
        """(numerator, denominator)."""

    @abstractmethod
    def simplest(self, num: ExponentialPolynomial, den: ExponentialPolynomial) -> Any:
        """The simplest transfer function that num/den is: a `Process` where it can be one."""

    def __add__(self, other: Any) -> Any:
        other = _fraction(other)
        return NotImplemented if other is None else self.simplest(*added(self.fraction, other))

    __radd__ = __add__

    def __neg__(self) -> Any:
        return self * -1.0

    def __pos__(self) -> Any:
        return self

    def __sub__(self, other: Any) -> Any:
        return NotImplemented if _fraction(other) is None else self + other * -1.0

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __mul__(self, other: Any) -> Any:
        other = _fraction(other)
        return NotImplemented if other is None else self.simplest(*multiplied(self.fraction, other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        other = _fraction(other)
        if other is None:
            return NotImplemented
        if other[0].is_zero:
            raise ProcessError("division by zero: the transfer function below is zero")
        return self.simplest(*multiplied(self.fraction, other[::-1]))

    def __rtruediv__(self, other: Any) -> Any:
        other = _fraction(other)
        if other is None:
            return NotImplemented
        if self.fraction[0].is_zero:
            raise ProcessError("division by zero: the transfer function below is zero")
        return self.simplest(*multiplied(other, self.fraction[::-1]))

    def __pow__(self, power: Any) -> Any:
        if not isinstance(power, int | np.integer):
            return NotImplemented
        once = self if power >= 0 else 1 / self
        total = self.simplest(ONE, ONE)
        for _ in range(abs(int(power))):
            total = total * once
        return total

    def feedback(self, other: Any = 1.0, sign: float = -1.0) -> Any:
        """P/(1 + P H): this one with `other` from its output back to its input, turned by `sign` (1: positive).

        No pole is doubled, and dead times stay exact: with dead time in the loop it is a `TransferFunction`.
        """
        back = _fraction(other)
        if back is None:
            raise ProcessError(f"{type(other).__name__} is no transfer function: give one, or a number")
        (n, d), (m, e) = self.fraction, back
        below = d * e - n * m * float(sign)
        if below.is_zero:
            raise ProcessError("an algebraic loop: 1 + P H is zero everywhere")
        return self.simplest(n * e, below)

    @abstractmethod
    def step_signal(self, horizon: float) -> Signal:
        """The unit step response from rest on [0, horizon] s."""

    def step(self, times: Any) -> np.ndarray:
        """The response to a unit step of the input at t = 0 from rest, exact to rounding, at any `times` [s]."""
        times = real_array(times, "t", ProcessError)
        return self.step_signal(max(float(times.max(initial=0.0)), TINY))(times)

    @property
    def static_gain(self) -> float:
        """The gain at s = 0, after common factors s are divided out: infinite where it integrates."""
        num, den = self.fraction
        if num.is_zero:
            return 0.0
        (above, n), (below, d) = num.order_at_zero(), den.order_at_zero()
        return 0.0 if above > below else n / d if above == below else float(np.copysign(np.inf, n / d))

    def impulse(self, times: Any) -> np.ndarray:
        """The response to a unit impulse of the input at t = 0 from rest, at any `times` [s].

        Raises ProcessError where the input acts on the output at once: the response then begins with an impulse.

        >>> from loopbook.process.transfer_function import Process
        >>> Process.fopdt(6, 3, 1).impulse([0.5, 1.0, 4.0]).round(8)
        array([0.        , 2.        , 0.73575888])
        """
        num, den = self.fraction
        if num.degree >= den.degree and not num.is_zero:
            raise ProcessError(
                "the input acts on the output at once: its impulse response begins with an impulse; take the step "
                "response, or subtract the gain at infinite frequency"
            )
        return np.asarray(self.simplest(num * LAPLACE, den).step(times))

    def ramp(self, times: Any) -> np.ndarray:
        """The response to u = t from rest, at any `times` [s].

        >>> from loopbook.process.transfer_function import Process
        >>> Process.fopdt(2, 3, 1).ramp([1.0, 4.0]).round(8)
        array([0.        , 2.20727665])
        """
        num, den = self.fraction
        return np.asarray(self.simplest(num, den * LAPLACE).step(times))


def _fraction(other: Any) -> Fraction | None:
    """Of a transfer function, a regulator (its feedback path -u/y) or a number; None for anything else."""
    if hasattr(other, "fraction"):
        found: Fraction = other.fraction
        return found
    try:
        number = real(plain_number(other), "factor", ProcessError)
    except TypeError:
        return None
    return ExponentialPolynomial.of((number,)), ONE


def added(first: Fraction, second: Fraction) -> Fraction:
    """n/d + m/e over one denominator."""
    (n, d), (m, e) = first, second
    if d == e:
        return n + m, d
    if len(d.terms) == len(e.terms) == 1 and d.delays == e.delays:
        ((delay, p),), ((_, q),) = d.terms, e.terms
        a, b, common = over_one_denominator(p, q)
        of = ExponentialPolynomial.of
        return n * of(a.tolist()) + m * of(b.tolist()), of(common.tolist(), delay)
    return n * e + m * d, d * e


def multiplied(first: Fraction, second: Fraction) -> Fraction:
    """n/d m/e, where n and e or m and d are the same without them."""
    (n, d), (m, e) = first, second
    (n, e), (m, d) = _cancelled(n, e), _cancelled(m, d)
    if m is ONE and e.degree == 0 and e.delays == (0.0,):  # divided by a number
        return n.over(e.terms[0][1][0]), d
    return n * m, d * e


def _cancelled(above: ExponentialPolynomial, below: ExponentialPolynomial) -> Fraction:
    """1/1, or exp(-d s)/1, for two that are the same but for a dead time."""
    if above.is_zero or above is ONE:
        return above, below
    lead = above.delays[0] - below.delays[0]
    return (ONE.delayed(lead), ONE) if above == below.delayed(lead) else (above, below)
