"""A process: a rational transfer function times an exact dead time; sums of them, and what algebra makes of them.

    G(s) = (b_0 s^m + ... + b_m) / (a_0 s^n + ... + a_n) * exp(-L s),   m <= n, L >= 0

Coefficients are real and in descending powers of s, time is in seconds. The dead time is never approximated; the only
function that writes a Padé approximation is `Process.to_control`, on request.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.numerics import horner
from loopbook.numerics.characteristic_roots import zeros_in
from loopbook.numerics.exponential_polynomial import SAME_DELAY, ExponentialPolynomial, same_delay
from loopbook.numerics.real_numbers import in_a_sentence, plain_number, positive, real
from loopbook.numerics.several_delays import step_response
from loopbook.numerics.signals import Signal
from loopbook.numerics.step_response import open_loop_step
from loopbook.numerics.units import rounded_sum
from loopbook.plots.curves import curves
from loopbook.plots.shown import shown_once
from loopbook.process import formulas
from loopbook.process.algebra import Fraction, TransferAlgebra, added
from loopbook.process.horizon import default_horizon
from loopbook.process.interchange import Interchange
from loopbook.process.rows import ProcessError, checked_coefficients, roots_in_own_time

PAST_THE_END = 1e-9
"""Of a horizon: a response that jumps at its end has jumped there."""

__all__ = ["DelayedSum", "Process", "ProcessError", "TransferFunction", "checked_coefficients"]

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class _Transfer(TransferAlgebra):
    def simplest(
        self, num: ExponentialPolynomial, den: ExponentialPolynomial
    ) -> "Process | DelayedSum | TransferFunction":
        return simplest(num, den)

    def latex(self) -> str:
        """The formula in LaTeX."""
        raise NotImplementedError

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    @property
    def poles(self) -> np.ndarray:
        """The poles [1/s], multiple ones repeated; of a loop with dead time the rightmost (see `loop.roots`)."""
        return _repeated(self.fraction[1])

    @property
    def zeros(self) -> np.ndarray:
        """The zeros [1/s], as the poles."""
        return _repeated(self.fraction[0])

    def plot(self, horizon: float | None = None) -> "Figure":
        """The unit step response as a matplotlib figure, up to the horizon [s]."""
        y = self.step_signal(default_horizon(*self.fraction) if horizon is None else horizon)
        t = np.linspace(0.0, y.end, 600)
        return shown_once(curves({"output $y$": {"step response": (t, y(t))}}, "Unit step response"))


@dataclass(frozen=True)
class Process(_Transfer, Interchange):
    """A proper rational transfer function with dead time, y/u.

    num, den: real coefficients in descending powers of s, lengths m+1 <= n+1. delay: dead time L [s], >= 0.
    Calling it evaluates num/den * exp(-delay s) at complex s [rad/s] of any shape.
    Raises ProcessError where num/den is improper, den is zero, a coefficient is not finite or delay is negative.

    >>> tank = Process([1], [35, 12, 1], delay=2)
    >>> tank.static_gain, tank.order
    (1.0, 2)
    >>> round(float(abs(tank(1j * 0.1))), 6)
    0.732743
    """

    num: Sequence[float]
    den: Sequence[float]
    delay: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "num", checked_coefficients(self.num, "num"))
        object.__setattr__(self, "den", checked_coefficients(self.den, "den"))
        if self.den == (0.0,):
            raise ProcessError("den is zero: a transfer function needs a denominator")
        if len(self.num) > len(self.den):
            raise ProcessError(
                f"num has degree {len(self.num) - 1}, den degree {len(self.den) - 1}: an improper transfer function "
                "differentiates its input and is no process; add poles or lower the degree of num"
            )
        delay = real(self.delay, "delay", ProcessError, " s")
        if delay < 0:
            raise ProcessError(f"delay = {delay!r} s is negative: the output would precede its cause")
        object.__setattr__(self, "delay", delay)

    @classmethod
    def fopdt(cls, gain: float, time_constant: float, delay: float) -> "Process":
        """First order plus dead time, G(s) = gain / (time_constant s + 1) * exp(-delay s).

        gain [y/u], time_constant [s] > 0, delay [s] >= 0.
        """
        return cls((gain,), (positive(time_constant, "time_constant", ProcessError, " s"), 1.0), delay)

    @classmethod
    def integrating(cls, gain: float, delay: float = 0.0, time_constant: float = 0.0) -> "Process":
        """Integrator plus dead time, G(s) = gain / (s (time_constant s + 1)) * exp(-delay s); gain in [y/(u s)]."""
        lag = real(time_constant, "time_constant", ProcessError, " s")
        if lag < 0:
            raise ProcessError(f"time_constant = {in_a_sentence(time_constant)} s must not be negative")
        return cls((gain,), (lag, 1.0, 0.0), delay)

    def __call__(self, s: Any) -> Any:
        s = np.asarray(s)
        return horner.value(self.num, s) / horner.value(self.den, s) * np.exp(-self.delay * s)

    def latex(self) -> str:
        """The formula in LaTeX; the denominator as lags where four digits tell them exactly.

        >>> Process([2], [40, 14, 1], 3).latex()
        '\\\\frac{2}{(10 s + 1) (4 s + 1)} e^{-3 s}'
        """
        return formulas.ratio(self.num, self.den, self.delay)

    @property
    def fraction(self) -> Fraction:
        """num exp(-delay s) and den."""
        return ExponentialPolynomial.of(self.num, self.delay), ExponentialPolynomial.of(self.den)

    def __mul__(self, other: Any) -> Any:
        if hasattr(other, "fraction"):
            return super().__mul__(other)
        try:
            factor = real(plain_number(other), "factor", ProcessError)
        except TypeError:
            return NotImplemented
        return Process(tuple(factor * c for c in self.num), self.den, self.delay)

    __rmul__ = __mul__

    def __add__(self, other: Any) -> Any:
        if self.delay and not isinstance(other, TransferAlgebra):
            other = as_process(other)
        if isinstance(other, DelayedSum) or (isinstance(other, Process) and not same_delay(other.delay, self.delay)):
            return DelayedSum((self,)) + other
        return super().__add__(other)

    __radd__ = __add__

    def __repr__(self) -> str:
        return f"Process(num={formulas.short_row(self.num)}, den={formulas.short_row(self.den)}, delay={self.delay!r})"

    @property
    def rational(self) -> "Process":
        """The same process without its dead time."""
        return Process(self.num, self.den)

    def delayed(self, more: float) -> "Process":
        """The same process with `more` seconds of dead time added."""
        return Process(self.num, self.den, self.delay + real(more, "more", ProcessError, " s"))

    @property
    def order(self) -> int:
        """The degree of den."""
        return len(self.den) - 1

    @property
    def relative_degree(self) -> int:
        """The degree of den less that of num; 0 where the input acts on the output at once."""
        return len(self.den) - len(self.num)

    @property
    def static_gain(self) -> float:
        """G(0): infinite where the process integrates, and taken after common factors s are divided out."""
        num, den = list(self.num), list(self.den)
        while len(num) > 1 and len(den) > 1 and num[-1] == den[-1] == 0:
            num.pop(), den.pop()
        return math.copysign(math.inf, num[-1]) if den[-1] == 0 else num[-1] / den[-1]

    @cached_property
    def poles(self) -> np.ndarray:
        """The roots of den, complex, shape (order,)."""
        return roots_in_own_time(self.den)

    @cached_property
    def zeros(self) -> np.ndarray:
        """The roots of num, complex."""
        return roots_in_own_time(self.num)

    def step(self, times: Any, amplitude: float = 1.0) -> np.ndarray:
        """The response to a step of the input at t = 0 from rest, exact to rounding, at any `times` [s].

        Zero for t < delay. Shape of `times`.

        >>> Process.fopdt(2, 3, 1).step([0.5, 4.0])
        array([0.        , 1.26424112])
        """
        return amplitude * super().step(times)

    def step_signal(self, horizon: float) -> Signal:
        """The unit step response on [0, horizon] s as a `Signal`: to be called, integrated, asked for its peak."""
        return open_loop_step(self.rational, max(horizon - self.delay, 0.0)).delayed(self.delay)


@dataclass(frozen=True)
class DelayedSum(_Transfer):
    """A sum of processes with dead times of their own: the path of a disturbance that enters elsewhere.

    Calling it evaluates the sum at complex s.

    >>> float(DelayedSum((Process([1], [1, 1], 2), Process([1], [1], 0)))(0.0))
    2.0
    """

    terms: tuple[Process, ...]

    def __call__(self, s: Any) -> Any:
        return sum(term(s) for term in self.terms)

    @property
    def fraction(self) -> Fraction:
        """All terms over one denominator."""
        total: Any = Process((0.0,), (1.0,)).fraction
        for term in self.terms:
            total = added(total, term.fraction)
        return total

    def __add__(self, other: Any) -> Any:
        """Terms of one dead time and one denominator become one; the others stay as they are."""
        other = other if isinstance(other, TransferAlgebra) else as_process(other)
        if not isinstance(other, Process | DelayedSum):
            return super().__add__(other)
        rows: dict[tuple[Any, float], np.ndarray] = {}
        for term in self.terms + (other.terms if isinstance(other, DelayedSum) else (other,)):
            delay = next((d for _, d in rows if same_delay(d, term.delay)), term.delay)
            key = term.den, delay
            rows[key] = rounded_sum(rows[key].tolist(), term.num) if key in rows else np.asarray(term.num)
        kept = tuple(Process(tuple(num.tolist()), den, delay) for (den, delay), num in rows.items() if num.any())
        return DelayedSum(kept) if len(kept) > 1 else kept[0] if kept else Process((0.0,), (1.0,))

    __radd__ = __add__

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, DelayedSum):
            return DelayedSum(tuple(a * b for a in self.terms for b in other.terms))
        if hasattr(other, "fraction") and not isinstance(other, Process):
            return super().__mul__(other)
        products = tuple(term * other for term in self.terms)
        return NotImplemented if any(p is NotImplemented for p in products) else DelayedSum(products)

    __rmul__ = __mul__

    def latex(self) -> str:
        """The formula in LaTeX, term by term."""
        text = self.terms[0].latex()
        for term in self.terms[1:]:
            negative = term.num[0] < 0
            text += f" {'-' if negative else '+'} {(-term if negative else term).latex()}"
        return text

    def __repr__(self) -> str:
        more = f", ... {len(self.terms)} terms" if len(self.terms) > 2 else ""
        return f"DelayedSum(({', '.join(map(repr, self.terms[:2]))}{more}))"

    def step_signal(self, horizon: float) -> Signal:
        """The unit step response on [0, horizon] s."""
        total: Any = self.terms[0].step_signal(horizon)
        for term in self.terms[1:]:
            total = total + term.step_signal(horizon)
        return total


@dataclass(frozen=True)
class TransferFunction(_Transfer):
    """num(s)/den(s), each a sum of polynomials times exponentials: whatever algebra makes that is no `Process`.

    A closed loop with dead time, a differentiator, the inverse of a process. Calling it evaluates it at complex s.

    >>> s = TransferFunction(ExponentialPolynomial.of([1, 0]), ExponentialPolynomial.of([1]))
    >>> 2 / (3 * s + 1)
    Process(num=(2.0,), den=(3.0, 1.0), delay=0.0)
    >>> closed = Process.fopdt(2, 3, 1).feedback(0.5)
    >>> type(closed).__name__, closed.static_gain
    ('TransferFunction', 1.0)
    """

    num: ExponentialPolynomial
    den: ExponentialPolynomial

    @property
    def fraction(self) -> Fraction:
        """num and den."""
        return self.num, self.den

    def __call__(self, s: Any) -> Any:
        return self.num(s) / self.den(s)

    def latex(self) -> str:
        """The formula in LaTeX."""
        below = formulas.terms(self.den)
        above = formulas.terms(self.num)
        return above if below == "1" else rf"\frac{{{above}}}{{{below}}}"

    def __repr__(self) -> str:
        return f"TransferFunction({formulas.plain(self.num)} over {formulas.plain(self.den)})"

    def step_signal(self, horizon: float) -> Signal:
        """The unit step response on [0, horizon] s.

        Raises ResponseError where the output would precede the input or be an impulse.
        """
        return step_response(self.num, self.den, horizon * (1 + PAST_THE_END))


def simplest(num: ExponentialPolynomial, den: ExponentialPolynomial) -> Process | DelayedSum | TransferFunction:
    """num/den as a `Process` where it is one, as a `DelayedSum` where its terms are, else as a `TransferFunction`.

    Factors s and exp(-d s) that all terms share are divided out.
    """
    if num.is_zero:
        return Process((0.0,), (1.0,))
    num, den = num.delayed(-den.delays[0]), den.delayed(-den.delays[0])
    shared = min(p[::-1].index(next(c for c in reversed(p) if c)) for f in (num, den) for _, p in f.terms)
    num, den = num.over_s(shared), den.over_s(shared)
    (_, below), *others = den.terms
    longest = max(map(abs, num.delays))
    proper = all(delay >= -SAME_DELAY * longest and len(p) <= len(below) for delay, p in num.terms)
    if others or not proper:
        return TransferFunction(num, den)
    if len(below) == 1:
        num, below = num.over(below[0]), (1.0,)
    terms = tuple(Process(p, below, max(delay, 0.0)) for delay, p in num.terms)
    return terms[0] if len(terms) == 1 else DelayedSum(terms)


def _repeated(f: ExponentialPolynomial) -> np.ndarray:
    if f.is_zero:
        return np.zeros(0, complex)
    found = zeros_in(f)[0]
    return np.repeat(found.values.astype(complex), found.multiplicity)


def as_process(number: Any) -> Any:
    """A number as a process of that gain; anything else as it is."""
    try:
        return Process((real(plain_number(number), "gain", ProcessError),), (1.0,))
    except TypeError:
        return number
