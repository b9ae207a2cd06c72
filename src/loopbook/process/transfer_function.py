"""A process: a rational transfer function times an exact dead time.

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

from derivations.errors import LoopbookError
from loopbook.extras import needed
from loopbook.numerics import horner, polynomial_text
from loopbook.numerics.multiple_roots import roots_of
from loopbook.numerics.real_numbers import in_a_sentence, plain_number, positive, real
from loopbook.numerics.step_response import open_loop_step
from loopbook.numerics.units import characteristic_time, in_units
from loopbook.plots.curves import curves
from loopbook.plots.shown import shown_once

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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


def _roots(p: Sequence[float]) -> np.ndarray:
    time = characteristic_time((1.0,), p, 0.0)
    return roots_of(in_units(p, time)) / time


@dataclass(frozen=True)
class Process:
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

    @classmethod
    def from_control(cls, system: Any, delay: float = 0.0) -> "Process":
        """From a continuous single-input single-output `control.TransferFunction`, which holds no dead time itself."""
        if getattr(system, "ninputs", None) != 1 or system.noutputs != 1:
            raise ProcessError("from_control takes a system with one input and one output")
        if system.dt not in (0, None):
            raise ProcessError(f"from_control takes a continuous system, got one with dt = {system.dt}")
        return cls(tuple(system.num[0][0]), tuple(system.den[0][0]), delay)

    def to_control(self, pade: int | None = None) -> Any:
        """As a `control.TransferFunction`.

        pade: order of the Padé approximation of the dead time. Without it a process with dead time is refused, as
        python-control has no form for it.
        """
        control = needed("control", "control")
        rational = control.tf(list(self.num), list(self.den))
        if not self.delay:
            return rational
        if pade is None:
            raise ProcessError(
                f"python-control cannot hold the dead time {self.delay} s: ask for pade=order, or take .rational"
            )
        return rational * control.tf(*control.pade(self.delay, pade))

    def __call__(self, s: Any) -> Any:
        s = np.asarray(s)
        return horner.value(self.num, s) / horner.value(self.den, s) * np.exp(-self.delay * s)

    def latex(self) -> str:
        """The formula in LaTeX; the denominator as lags where four digits tell them exactly.

        >>> Process([2], [40, 14, 1], 3).latex()
        '\\\\frac{2}{(10 s + 1) (4 s + 1)} e^{-3 s}'
        """
        below = polynomial_text.lags(self.den)
        above = polynomial_text.descending(self.num)
        ratio = above if below == "1" else rf"\frac{{{above}}}{{{below}}}"
        return ratio + (rf" e^{{-{polynomial_text.number(self.delay)} s}}" if self.delay else "")

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def plot(self, horizon: float | None = None) -> "Figure":
        """The unit step response as a matplotlib figure, up to the horizon [s]."""
        if horizon is None:
            horizon = self.delay * 2 + 7 * float(sum(1 / abs(p.real) for p in self.poles if p.real)) or 10.0
        t = np.linspace(0.0, horizon, 600)
        return shown_once(curves({"output $y$": {"step response": (t, self.step(t))}}, "Unit step response"))

    def __mul__(self, other: "Process | float") -> "Process":
        if isinstance(other, Process):
            num, den = np.convolve(self.num, other.num), np.convolve(self.den, other.den)
            return Process(tuple(num.tolist()), tuple(den.tolist()), self.delay + other.delay)
        try:
            factor = real(plain_number(other), "factor", ProcessError)
        except TypeError:
            return NotImplemented
        return Process(tuple(factor * c for c in self.num), self.den, self.delay)

    __rmul__ = __mul__

    def __add__(self, other: "Process | DelayedSum") -> "DelayedSum":
        return DelayedSum((self,)) + other

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
        return _roots(self.den)

    @cached_property
    def zeros(self) -> np.ndarray:
        """The roots of num, complex."""
        return _roots(self.num)

    def step(self, times: Any, amplitude: float = 1.0) -> np.ndarray:
        """The response to a step of the input at t = 0 from rest, exact to rounding, at any `times` [s].

        Zero for t < delay. Shape of `times`.

        >>> Process.fopdt(2, 3, 1).step([0.5, 4.0])
        array([0.        , 1.26424112])
        """
        times = np.asarray(times, dtype=float)
        horizon = max(float(times.max(initial=0.0)) - self.delay, 0.0)
        return amplitude * open_loop_step(self.rational, horizon).delayed(self.delay)(times)


@dataclass(frozen=True)
class DelayedSum:
    """A sum of processes with dead times of their own: the path of a disturbance that enters elsewhere.

    Calling it evaluates the sum at complex s.

    >>> float(DelayedSum((Process([1], [1, 1], 2), Process([1], [1], 0)))(0.0))
    2.0
    """

    terms: tuple[Process, ...]

    def __call__(self, s: Any) -> Any:
        return sum(term(s) for term in self.terms)

    def __add__(self, other: "Process | DelayedSum") -> "DelayedSum":
        if isinstance(other, Process):
            return DelayedSum((*self.terms, other))
        if isinstance(other, DelayedSum):
            return DelayedSum(self.terms + other.terms)
        return NotImplemented
