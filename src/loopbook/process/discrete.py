"""A plant in the z domain: a ratio of polynomials in z^-1 with its sampling interval, and the algebra of such.

    G(z) = (b_0 + b_1 z^-1 + ...)/(1 + a_1 z^-1 + ...)

A continuous process that is sampled exactly, with its dead time, is a `loopbook.process.sampled.SampledProcess`; this
is what is known only at the samples: given in z, or an approximation by name.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.numerics import polynomial_text
from loopbook.numerics.real_numbers import plain_number, positive, real_array
from loopbook.plots.curves import curves
from loopbook.plots.shown import shown_once
from loopbook.plots.stairs import stairs
from loopbook.process import formulas
from loopbook.process.approximation import Approximates
from loopbook.process.rows import ProcessError, checked_coefficients
from loopbook.process.transfer_function import Process

SAMPLES = 60


def _row(values: Any, name: str) -> np.ndarray:
    """Ascending coefficients of z^-1 without zeros at the end."""
    reversed_row = np.atleast_1d(np.asarray(values, dtype=object))[::-1]
    return np.asarray(checked_coefficients(tuple(reversed_row), name))[::-1]


@dataclass(frozen=True)
class DiscreteProcess(Approximates):
    """num, den: coefficients of z^0, z^-1, ...; den starts with 1 (it is scaled to). h: sampling interval [s].

    method, exact: the name of the approximation that it is and the continuous process that it stands for, if it does.
    Raises ProcessError where den has no term without delay: y would precede u.

    >>> G = DiscreteProcess((0.0, 0.5), (1.0, -0.5), 0.1)
    >>> G.static_gain, G.response([1, 1, 1]).tolist()
    (1.0, [0.0, 0.5, 0.75])
    """

    num: Sequence[float]
    den: Sequence[float]
    h: float
    method: str = ""
    exact: Process | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "h", positive(self.h, "h", ProcessError, " s"))
        num, den = _row(self.num, "num"), _row(self.den, "den")
        if not den[0]:
            raise ProcessError(f"den = {self.den} has no term without delay: y would precede u")
        object.__setattr__(self, "num", tuple((num / den[0]).tolist()))
        object.__setattr__(self, "den", tuple((den / den[0]).tolist()))

    @classmethod
    def in_z(cls, num: Any, den: Any, h: float) -> "DiscreteProcess":
        """From descending powers of z, as most programs write it.

        >>> DiscreteProcess.in_z([0.5], [1, -0.5], 0.1)
        DiscreteProcess(num=(0.0, 0.5), den=(1.0, -0.5), h=0.1)
        """
        above, below = checked_coefficients(num, "num"), checked_coefficients(den, "den")
        if len(above) > len(below):
            raise ProcessError(f"num has degree {len(above) - 1}, den {len(below) - 1}: y would precede u")
        return cls((0.0,) * (len(below) - len(above)) + above, below, h)

    @classmethod
    def of(cls, system: Any) -> "DiscreteProcess":
        """A `SampledProcess`, or anything with num, den in z^-1 and h, as one."""
        return system if isinstance(system, cls) else cls(tuple(system.num), tuple(system.den), system.h)

    def __call__(self, z: Any) -> Any:
        inverse = 1 / np.asarray(z)
        return np.polyval(self.num[::-1], inverse) / np.polyval(self.den[::-1], inverse)

    def frequency_response(self, w: Any) -> Any:
        """The value at z = exp(jwh), w [rad/s]."""
        return self(np.exp(1j * np.asarray(w) * self.h))

    @property
    def highest_frequency(self) -> float:
        """pi/h [rad/s]: half the sampling frequency."""
        return float(np.pi / self.h)

    @cached_property
    def poles(self) -> np.ndarray:
        """The z where the denominator vanishes, those at the origin included."""
        return self._roots(self.den)

    @cached_property
    def zeros(self) -> np.ndarray:
        """The z where the numerator vanishes, those at the origin included."""
        return self._roots(self.num)

    def _roots(self, row: Sequence[float]) -> np.ndarray:
        length = max(len(self.num), len(self.den))
        return np.roots(np.pad(np.asarray(row), (0, length - len(row)))).astype(complex)

    @property
    def is_stable(self) -> bool:
        """Do all poles lie inside the unit circle?"""
        return bool((abs(self.poles) < 1).all())

    @property
    def static_gain(self) -> float:
        """G(1), infinite for an integrating one."""
        above, below = sum(self.num), sum(self.den)
        return above / below if below else float(np.copysign(np.inf, above))

    def response(self, u: Any) -> np.ndarray:
        """y(k) to the inputs u(k) from rest; arrays of one length."""
        from scipy.signal import lfilter

        return np.asarray(lfilter(self.num, self.den, real_array(u, "u", ProcessError)))

    def plot(self, steps: int = SAMPLES) -> Any:
        """The unit step response as a matplotlib figure."""
        t = self.h * np.arange(steps + 1)
        y = stairs(t, self.response(np.ones(steps + 1)))
        return shown_once(curves({"output $y$": {"y": y}}, f"Unit step response, sampled every {self.h:g} s"))

    def latex(self) -> str:
        """The ratio in LaTeX, in powers of z^-1."""
        above, below = polynomial_text.in_delays(self.num), polynomial_text.in_delays(self.den)
        return above if below == "1" else rf"\frac{{{above}}}{{{below}}}"

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def __repr__(self) -> str:
        named = f", method={self.method!r}" if self.method else ""
        rows = f"num={formulas.short_row(self.num)}, den={formulas.short_row(self.den)}"
        return f"DiscreteProcess({rows}, h={self.h!r}{named})"

    def with_other(self, other: Any) -> "DiscreteProcess | None":
        """What this one can be combined with, as one of its kind; None for what is neither a plant nor a number."""
        if hasattr(other, "num") and hasattr(other, "h"):
            other = DiscreteProcess.of(other)
            if other.h != self.h:
                raise ProcessError(f"h = {self.h:g} s and {other.h:g} s: two sampling intervals have no common z")
            return other
        try:
            return DiscreteProcess((float(plain_number(other)),), (1.0,), self.h)
        except TypeError:
            return None

    def __add__(self, other: Any) -> Any:
        other = self.with_other(other)
        if other is None:
            return NotImplemented
        if self.den == other.den:
            return DiscreteProcess(_sum(self.num, other.num), self.den, self.h)
        num = _sum(np.convolve(self.num, other.den), np.convolve(other.num, self.den))
        return DiscreteProcess(num, tuple(np.convolve(self.den, other.den)), self.h)

    __radd__ = __add__

    def __neg__(self) -> "DiscreteProcess":
        return DiscreteProcess(tuple(-c for c in self.num), self.den, self.h)

    def __sub__(self, other: Any) -> Any:
        other = self.with_other(other)
        return NotImplemented if other is None else self + -other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __mul__(self, other: Any) -> Any:
        other = self.with_other(other)
        if other is None:
            return NotImplemented
        num, den = np.convolve(self.num, other.num), np.convolve(self.den, other.den)
        return DiscreteProcess(tuple(num), tuple(den), self.h)

    __rmul__ = __mul__

    def inverse(self) -> "DiscreteProcess":
        """1/G. Raises ProcessError where G has a delay, which its inverse would have to foresee."""
        if not self.num[0]:
            raise ProcessError("it has a delay, so that its inverse would need the future: multiply it by z first")
        return DiscreteProcess(self.den, self.num, self.h)

    def __pow__(self, power: Any) -> Any:
        if not isinstance(power, int | np.integer):
            return NotImplemented
        once, total = self if power >= 0 else self.inverse(), DiscreteProcess((1.0,), (1.0,), self.h)
        for _ in range(abs(int(power))):
            total = total * once
        return total

    def __truediv__(self, other: Any) -> Any:
        other = self.with_other(other)
        return NotImplemented if other is None else self * other.inverse()

    def __rtruediv__(self, other: Any) -> Any:
        other = self.with_other(other)
        return NotImplemented if other is None else other * self.inverse()

    def feedback(self, other: Any = 1.0, sign: float = -1.0) -> "DiscreteProcess":
        """G/(1 + G H), with `other` from the output back to the input; sign 1 for positive feedback."""
        back = self.with_other(other)
        if back is None:
            raise ProcessError(f"{type(other).__name__} is no z-domain plant: give one, or a number")
        num = np.convolve(self.num, back.den)
        den = _sum(np.convolve(self.den, back.den), -float(sign) * np.convolve(self.num, back.num))
        return DiscreteProcess(tuple(num), den, self.h)


def _sum(p: Any, q: Any) -> tuple[float, ...]:
    total = np.zeros(max(len(p), len(q)))
    total[: len(p)] += p
    total[: len(q)] += q
    return tuple(total.tolist())
