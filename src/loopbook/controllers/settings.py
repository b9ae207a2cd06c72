"""The settings of a discrete PID controller, checked.

Source of the ranges and rules: pid-report, Table 5.1 and section 5.1.
"""

import math
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any

from derivations.errors import LoopbookError
from loopbook.controllers import generated
from loopbook.controllers.pid_forms import PidParallel, PidSeries, PidStandard
from loopbook.numerics.real_numbers import Number, plain_number

ANTI_WINDUP = {
    "tracking": "I follows the limited output with the time constant Tt (pid-report, eq. 4.5)",
    "conditional": "I moves only where the output is not limited (figure 4.7); it can lock up",
    "conditional-safe": "the same, but I also moves where that brings the output back from the limit",
    "clamping": "I itself is kept between the output's limits",
    "none": "I always moves: it winds up",
}


class SettingError(LoopbookError):
    """A setting outside its range. Attributes: name, value, range."""

    def __init__(self, name: str, value: Any, range: str, hint: str = ""):
        self.name, self.value, self.range = name, value, range
        super().__init__(f"{name} = {value!r} is outside its range: {range}{'; ' + hint if hint else ''}")


def _number(name: str, value: Any, infinite: bool = False) -> int | float | Fraction:
    """The setting as a Python number, exact where it was. Raises SettingError for anything else."""
    try:
        number = plain_number(value)
    except TypeError:
        number = math.nan
    if number != number or (abs(number) == math.inf and not infinite):
        raise SettingError(name, value, "a real number" if infinite else "a finite real number")
    return number


def exact_beside_fractions(*numbers: Number) -> tuple[Number, ...]:
    """The same numbers; ints as fractions where there is a fraction, as the ratio of two ints would be a float.

    >>> exact_beside_fractions(1, Fraction(1, 3), None)
    (Fraction(1, 1), Fraction(1, 3), None)
    """
    if not any(isinstance(number, Fraction) for number in numbers):
        return numbers
    return tuple(Fraction(number) if isinstance(number, int) else number for number in numbers)


def tracking_time(Ti: Number, Td: Number) -> Number:
    """T_t = sqrt(Ti Td), or 0.5 Ti where Td = 0 [s]. Source: pid-report, section 4.2.3, from its [5] and [7].

    Fractions give a fraction where the root is rational; else SettingError asks for Tt.

    >>> tracking_time(4.0, 1.0), tracking_time(Fraction(3), Fraction(1, 3)), tracking_time(4, 0)
    (2.0, Fraction(1, 1), Fraction(2, 1))
    """
    if Td == 0:
        return Ti / 2 if isinstance(Ti, float) else Fraction(Ti) / 2
    product = Ti * Td
    if isinstance(product, float):
        return math.sqrt(product)
    product = Fraction(product)
    root = Fraction(math.isqrt(product.numerator), math.isqrt(product.denominator))
    if root * root != product:
        if isinstance(Ti, int) and isinstance(Td, int):
            return math.sqrt(product)
        raise SettingError(
            "Tt", None, "Tt > h/2", f"sqrt(Ti Td) = sqrt({product}) is irrational: give Tt as a fraction"
        )
    return root


@dataclass(frozen=True, kw_only=True)
class PidSettings:
    """u = K (b y_sp - y) + I + D in the standard form, all times in seconds.

    K: gain [u/y], not 0, negative where y falls when u rises. Ti: integral time > 0, None or inf: no integral action.
    Td: derivative time >= 0. Tf: time constant of the derivative's filter >= 0. b, c in [0, 1]: set-point weights of
    P and D; c = 0 is derivative on measurement, c = 1 on error. h > 0: sampling interval. u_low < u_high: limits of
    u, may be infinite. rate > 0: largest |du/dt| [u/s], None for none. anti_windup: a key of `ANTI_WINDUP`.
    Tt > h/2: tracking time constant; None takes `tracking_time`, but not less than h (below h/2 the recursion
    I -> (1 - h/Tt) I diverges, below h it alternates).
    Raises SettingError with the name, the value and the range.

    >>> PidSettings(K=2.0, Ti=4.0, Td=1.0, h=0.1).Tt
    2.0
    """

    K: Number
    Ti: Number = None
    Td: Number = 0
    Tf: Number = 0
    b: Number = 1
    c: Number = 0
    h: Number
    Tt: Number = None
    u_low: Number = -math.inf
    u_high: Number = math.inf
    rate: Number = None
    anti_windup: str = "tracking"

    def __post_init__(self) -> None:
        if self.Ti is not None and _number("Ti", self.Ti, infinite=True) == math.inf:
            object.__setattr__(self, "Ti", None)
        for name in ("K", "Td", "Tf", "b", "c", "h", "Ti", "Tt", "rate", "u_low", "u_high"):
            value = getattr(self, name)
            if value is not None or name not in ("Ti", "Tt", "rate"):
                object.__setattr__(self, name, _number(name, value, infinite=name in ("u_low", "u_high")))
        if self.K == 0:
            raise SettingError("K", self.K, "K > 0 or K < 0", "K = 0 controls nothing")
        if self.h <= 0:
            raise SettingError("h", self.h, "h > 0 s")
        if self.Ti is not None and self.Ti <= 0:
            raise SettingError("Ti", self.Ti, "Ti > 0 s", "Ti = None switches the integral action off")
        for name in ("Td", "Tf"):
            if getattr(self, name) < 0:
                raise SettingError(name, getattr(self, name), f"{name} >= 0 s")
        for name in ("b", "c"):
            if not 0 <= getattr(self, name) <= 1:
                raise SettingError(name, getattr(self, name), f"0 <= {name} <= 1")
        if not self.u_low < self.u_high:
            raise SettingError("u_low", self.u_low, f"u_low < u_high = {self.u_high!r}")
        if self.rate is not None and self.rate <= 0:
            raise SettingError("rate", self.rate, "rate > 0 per second, or None")
        if self.anti_windup not in ANTI_WINDUP:
            raise SettingError("anti_windup", self.anti_windup, "one of " + ", ".join(ANTI_WINDUP))
        if self.Tt is None:
            if self.Ti is not None:
                object.__setattr__(self, "Tt", max(tracking_time(self.Ti, self.Td), self.h))
        elif 2 * self.Tt <= self.h:
            raise SettingError("Tt", self.Tt, f"Tt > h/2 = {self.h / 2!r} s", "below it tracking diverges")

    def gains(self) -> tuple[Any, ...]:
        """The coefficients of the program."""
        given = exact_beside_fractions(self.K, self.Ti, self.Td, self.Tf, self.b, self.c, self.h, self.Tt)
        found: tuple[Any, ...] = generated.gains()(*given)
        return found

    def changed(self, **settings: Any) -> "PidSettings":
        """The same settings with some replaced; Tt stays as it is. SettingError for an unknown name."""
        known = [f.name for f in fields(self)]
        for name in settings:
            if name not in known:
                raise SettingError(name, settings[name], "one of " + ", ".join(known), "there is no such setting")
        return replace(self, **settings)

    @classmethod
    def of(cls, form: PidStandard | PidParallel | PidSeries, *, h: Number, **more: Any) -> "PidSettings":
        """From a PID form of `loopbook.controllers.pid_forms` (standard, parallel, series) and the sampling interval h.

        >>> from loopbook.controllers.pid_forms import PidStandard
        >>> PidSettings.of(PidStandard(2.0, 4.0, 1.0, N=10), h=0.1).Tf
        0.1
        """
        standard = form.standard()
        names = ("K", "Ti", "Td", "Tf", "b", "c")
        return cls(h=h, **{name: getattr(standard, name) for name in names}, **more)
