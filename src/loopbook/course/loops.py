"""Loops in which a student's function takes a part: run sample by sample, outside of the student's notebook."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

IntegralRule = Callable[[float, float, float, float], float]


def with_integral_rule(
    rule: IntegralRule,
    *,
    K: float,
    h: float,
    gain: float,
    T: float,
    reference: float,
    limits: tuple[float, float],
    samples: int,
) -> "np.ndarray":
    """The output, sample by sample, of the lag gain/(T s + 1) under a PI regulator whose integral follows `rule`.

    v = K e + I, u = v within the limits, and I becomes rule(I, v, u, e); e = reference - y; from rest. h, T: s. What
    the rule raises is raised.

    >>> told = {"K": 1, "h": 0.1, "gain": 1, "T": 1, "reference": 1, "limits": (0, 9), "samples": 99}
    >>> y = with_integral_rule(lambda I, v, u, e: I + 0.1 * e, **told)
    >>> round(float(y[-1]), 3)
    1.0
    """
    import numpy as np

    a = math.exp(-h / T)
    y = integral = 0.0
    found = []
    for _ in range(samples):
        error = reference - y
        wish = K * error + integral
        u = min(max(wish, limits[0]), limits[1])
        integral = rule(integral, wish, u, error)
        y = a * y + (1 - a) * gain * u
        found.append(y)
    return np.array(found)
