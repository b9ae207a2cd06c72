"""On-off control with hysteresis or with a dead zone.

Source: pid-report, chapter 2: u is the maximum for e > 0 and the minimum for e < 0; hysteresis or a dead zone keeps
the switching from becoming too frequent.
"""

import math
from dataclasses import dataclass, field

from loopbook.controllers.pid import BadMeasurement
from loopbook.controllers.settings import SettingError
from loopbook.numerics.real_numbers import Number


@dataclass
class OnOff:
    """A controller with two outputs, or three.

    u_low < u_high: the outputs. hysteresis >= 0 [y]: half width of the band |e| <= hysteresis in which the last output
    stays. dead_zone >= 0 [y]: half width of the band |e| <= dead_zone in which the output is ``u_rest``
    (default the middle of u_low and u_high). Not both. With neither, e = 0 keeps the last output; before the first
    switch that is u_low. Raises SettingError with name, value and range.

    >>> thermostat = OnOff(0, 1, hysteresis=0.5)
    >>> [thermostat.step(y, 20) for y in (19, 20.3, 20.6, 19.7, 19.4)]
    [1, 1, 0, 0, 1]
    """

    u_low: Number
    u_high: Number
    hysteresis: Number = 0
    dead_zone: Number = 0
    u_rest: Number = None
    u: Number = field(default=None, init=False)
    switches: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        if not self.u_low < self.u_high or math.isinf(self.u_low) or math.isinf(self.u_high):
            raise SettingError("u_low", self.u_low, f"u_low < u_high = {self.u_high!r}, both finite")
        for name in ("hysteresis", "dead_zone"):
            if not 0 <= getattr(self, name) < math.inf:
                raise SettingError(name, getattr(self, name), f"{name} >= 0")
        if self.hysteresis and self.dead_zone:
            raise SettingError("dead_zone", self.dead_zone, "0 where hysteresis is given", "use one of the two")
        if self.u_rest is None:
            self.u_rest = (self.u_low + self.u_high) / 2
        elif not self.u_low <= self.u_rest <= self.u_high:
            raise SettingError("u_rest", self.u_rest, "u_low <= u_rest <= u_high")

    def step(self, y: Number, y_sp: Number) -> Number:
        """The output for this sample. Raises BadMeasurement where y or y_sp is not a finite number; u stays."""
        e = y_sp - y
        if e - e != 0:
            raise BadMeasurement("y" if y - y != 0 else "y_sp", y if y - y != 0 else y_sp, self.u)
        if e > self.hysteresis + self.dead_zone:
            u = self.u_high
        elif e < -(self.hysteresis + self.dead_zone):
            u = self.u_low
        elif self.dead_zone:
            u = self.u_rest
        else:
            u = self.u_low if self.u is None else self.u
        self.switches += self.u is not None and u != self.u
        self.u = u
        return u
