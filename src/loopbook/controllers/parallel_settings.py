"""The settings of a discrete PID controller by its three gains, each of which may be zero: I or D alone.

    u = P (b y_sp - y) + I/s (y_sp - y) + D s/(1 + s Tf) (c y_sp - y)

The same program runs as for `PidSettings`; a standard form has no I or D without P, this one has.
"""

import math
from dataclasses import dataclass, fields, replace
from typing import Any

from loopbook.controllers import generated
from loopbook.controllers.settings import ANTI_WINDUP, SettingError, exact_beside_fractions, tracking_time
from loopbook.numerics.real_numbers import plain_number


@dataclass(frozen=True, kw_only=True)
class ParallelSettings:
    """P [u/y], I [u/(y s)], D [u s/y]: any sign, not all zero. The others as in `PidSettings`.

    Tt: tracking time [s] > h/2; None takes sqrt(Ti Td) or Ti/2 of the equal standard form, and h where P is zero, which
    sets the integral back to the limit within one sample.
    Raises SettingError with the name, the value and the range.

    >>> from loopbook.controllers.pid import Pid
    >>> pid = Pid(ParallelSettings(I=1.0, h=1.0, Tt=1.0, u_low=-5.0, u_high=5.0))
    >>> [pid.step(0.0, e) for e in (1.0, 2.0, 3.0, 1.0, 2.0, -1.0, 1.0)]
    [0.0, 1.0, 3.0, 5.0, 5.0, 5.0, 4.0]
    """

    P: Any = 0
    I: Any = 0
    D: Any = 0
    Tf: Any = 0
    b: Any = 1
    c: Any = 0
    h: Any
    Tt: Any = None
    u_low: Any = -math.inf
    u_high: Any = math.inf
    rate: Any = None
    anti_windup: str = "tracking"

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name != "anti_windup" and value is not None:
                object.__setattr__(self, field.name, self._number(field.name, value))
        if not (self.P or self.I or self.D):
            raise SettingError("P", self.P, "P, I or D not zero", "all zero controls nothing")
        for name, holds, range_ in (
            ("h", self.h > 0, "h > 0 s"),
            ("Tf", self.Tf >= 0, "Tf >= 0 s"),
            ("b", 0 <= self.b <= 1, "0 <= b <= 1"),
            ("c", 0 <= self.c <= 1, "0 <= c <= 1"),
            ("u_low", self.u_low < self.u_high, f"u_low < u_high = {self.u_high!r}"),
            ("rate", self.rate is None or self.rate > 0, "rate > 0 per second, or None"),
            ("anti_windup", self.anti_windup in ANTI_WINDUP, f"one of {', '.join(ANTI_WINDUP)}"),
        ):
            if not holds:
                raise SettingError(name, getattr(self, name), range_)
        if self.Tt is None:
            object.__setattr__(self, "Tt", self._default_tracking() if self.I else None)
        elif 2 * self.Tt <= self.h:
            raise SettingError("Tt", self.Tt, f"Tt > h/2 = {self.h / 2!r} s", "below it tracking diverges")

    @staticmethod
    def _number(name: str, value: Any) -> Any:
        try:
            number = plain_number(value)
        except TypeError:
            number = math.nan
        if number != number or (abs(number) == math.inf and name not in ("u_low", "u_high")):
            raise SettingError(name, value, "a finite real number")
        return number

    def _default_tracking(self) -> Any:
        if not self.P:
            return self.h
        return max(tracking_time(abs(self.P / self.I), abs(self.D / self.P)), self.h)

    @property
    def K(self) -> Any:
        """The proportional gain, by the name of the standard form."""
        return self.P

    def gains(self) -> tuple[Any, ...]:
        """The coefficients of the program."""
        I = self.I if self.I else None
        given = exact_beside_fractions(self.P, I, self.D, self.Tf, self.b, self.c, self.h, self.Tt)
        found: tuple[Any, ...] = generated.parallel_gains()(*given)
        return found

    def changed(self, **settings: Any) -> "ParallelSettings":
        """The same settings with some replaced; Tt stays as it is. SettingError for an unknown name."""
        known = [field.name for field in fields(self)]
        for name in settings:
            if name not in known:
                raise SettingError(name, settings[name], "one of " + ", ".join(known), "there is no such setting")
        return replace(self, **settings)

    @classmethod
    def of(cls, form: Any, h: Any, **more: Any) -> "ParallelSettings":
        """From any PID form; also a `PidParallel` without P.

        >>> from loopbook.controllers.pid_forms import PidParallel
        >>> ParallelSettings.of(PidParallel(0.0, 0.5), 0.1).I
        0.5
        """
        p = form.parallel()
        return cls(P=p.P, I=p.I, D=p.D, Tf=p.Tf if p.D else 0, b=p.b, c=p.c, h=h, **more)
