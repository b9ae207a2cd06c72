"""What a filter of the derivative gives and costs: quiet against lag, and a loop's robustness.

The loop is one that needs its derivative: e^(-0.1 s)/(s (s + 1)) with K = 2, Ti = 10 s, Td = 1 s.
Source of the question: pid-report, section 4.2.4.1.
"""

import math
from dataclasses import dataclass

from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.continuous import Loop
from loopbook.process.construct import tf

TD = 1.0


@dataclass(frozen=True)
class Price:
    """noise: standard deviation of the slope per unit of white noise in the samples [1/s].

    late: how much later a ramp's slope is right [s]. phase_margin [degrees] and Ms: of the loop with the filter; NaN
    and infinity where it is not stable.
    """

    noise: float
    late: float
    phase_margin: float
    Ms: float


def noise(Tf: float, h: float) -> float:
    """Standard deviation of the filtered backward difference of white noise of 1: sqrt(2/(1 + a))/(Tf + h).

    a = Tf/(Tf + h) is the filter's pole; Tf [s] >= 0, h [s] > 0.
    """
    pole = Tf / (Tf + h)
    return math.sqrt(2 / (1 + pole)) / (Tf + h)


def loop(Tf: float, h: float) -> Loop:
    """The loop with a filter of the time constant Tf [s] >= 0; the hold of a program that samples every h [s] >= 0 is
    counted as half an interval of dead time."""
    return Loop(tf(1, [1, 1, 0], delay=0.1), PidStandard(2.0, 10.0, TD, Tf=Tf)).with_delay(h / 2)


def price(Tf: float, h: float) -> Price:
    """Of a filter with the time constant Tf [s] >= 0 in a program that samples every h [s] > 0.

    >>> one = price(0.3, 0.1)
    >>> round(one.noise, 2), one.late, round(one.Ms, 2)
    (2.67, 0.35, 1.95)
    """
    closed, late = loop(Tf, h), Tf + h / 2
    if not closed.is_stable:
        return Price(noise(Tf, h), late, math.nan, math.inf)
    margins = closed.margins()
    return Price(noise(Tf, h), late, margins.phase, margins.Ms.value)
