"""What sampling makes of a frequency, and what a converter makes of a value.

Source: pid-report, section 4.1.
"""

import math

from derivations.algebra import differences
from derivations.pid import rc_filter
from derivations.pid.rc_filter import time_constant_for


def alias(frequency: float, h: float) -> float:
    """The frequency [Hz] in 0 ... 1/(2h) that a sine of a given frequency shows when it is sampled every h seconds.

    >>> alias(9.0, 0.1), alias(4.0, 0.1), alias(10.0, 0.1)
    (1.0, 4.0, 0.0)
    """
    if not h > 0:
        raise ValueError(f"h = {h!r}: the sampling interval must be > 0 s")
    return round(abs(frequency - round(frequency * h) / h), 12)


def resolution(low: float, high: float, bits: int) -> float:
    """The step of a converter with 2^bits levels from low to high.

    >>> resolution(0.0, 3.0, 2)
    1.0
    """
    if bits < 1 or not low < high:
        raise ValueError(f"bits = {bits!r}, range {low!r} ... {high!r}: at least one bit and low < high")
    return (high - low) / (2**bits - 1)


def samples_of_delay(attenuation: float, order: int = 1) -> float:
    """Delay, in samples at low frequency, of filters that attenuate so many times at half the sampling frequency.

    ``order`` equal first-order filters in series; each has the time constant of `derivations.pid.rc_filter`, and at low
    frequency a filter delays by its time constant.
    """
    if not attenuation > 1 or order < 1:
        raise ValueError(f"attenuation = {attenuation!r}, order = {order!r}: more than 1, and at least one filter")
    return order * float(time_constant_for(order).subs({rc_filter.attenuation: attenuation, differences.h: 1}))


def phase_at(frequency: float, time_constant: float) -> float:
    """Phase [degrees] of one first-order filter at a frequency [Hz]."""
    return -math.degrees(math.atan(2 * math.pi * frequency * time_constant))
