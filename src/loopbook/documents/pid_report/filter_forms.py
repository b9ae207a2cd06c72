"""What the choice of a difference costs: poles, step responses and frequency responses of derived recursions.

Each form is an equation of `derivations.pid.pid_updates` or `derivations.pid.exact_filters`: newest = sum of gain *
sample.
"""

from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import numpy as np
from sympy import Eq, Integer, lambdify

from derivations.algebra import differences
from derivations.algebra.differences import at, by_signals
from derivations.pid import exact_filters as exact
from derivations.pid import pid_updates as term
from derivations.pid import rc_filter
from derivations.pid.pid_laws import K, Td

FILTERS = ("backward (4.9)", "Tustin", "exact, newest y", "exact, straight y")


@cache
def _gains(name: str) -> dict[str, Any]:
    """Gains (pole, on the newest y, on the y before) as functions of h and T_f."""
    if name not in FILTERS:
        raise ValueError(f"{name!r} is not a form of the filter; one of {', '.join(FILTERS)}")
    derive: dict[str, Callable[[], Any]] = {
        "backward (4.9)": lambda: term.low_pass().full(),
        "Tustin": term.low_pass_tustin,
        "exact, newest y": exact.low_pass_current,
        "exact, straight y": exact.low_pass_line,
    }
    gains = by_signals(derive[name]().rhs)
    symbols = (differences.h, rc_filter.Tf)
    samples = {"pole": at("y_f", -1), "now": at("y"), "before": at("y", -1)}
    return {key: lambdify(symbols, gains.get(s, Integer(0)), "math") for key, s in samples.items()}


def pole(name: str, h: float, Tf: float) -> float:
    """The pole of one form; the exact ones have exp(-h/Tf). h, Tf [s] > 0."""
    return float(_gains(name)["pole"](h, Tf))


def filtered(name: str, y: np.ndarray, h: float, Tf: float) -> np.ndarray:
    """The filtered samples of y, from rest at 0."""
    a, now, before = (float(_gains(name)[key](h, Tf)) for key in ("pole", "now", "before"))
    out, last, filtered = np.empty(len(y)), 0.0, 0.0
    for k, value in enumerate(np.asarray(y, float).tolist()):
        filtered = a * filtered + now * value + before * last
        out[k], last = filtered, value
    return out


def response(name: str, omega: float, h: float, Tf: float) -> complex:
    """The frequency response at omega [rad/s] < pi/h, between samples and samples."""
    a, now, before = (float(_gains(name)[key](h, Tf)) for key in ("pole", "now", "before"))
    z = np.exp(1j * omega * h)
    return complex((now + before / z) / (1 - a / z))


def error(name: str, omega: float, h: float, Tf: float) -> float:
    """Distance of the frequency response from the continuous filter's 1/(1 + i omega Tf)."""
    return abs(response(name, omega, h, Tf) - 1 / (1 + 1j * omega * Tf))


def time_constant(name: str, h: float, Tf: float) -> float:
    """The continuous time constant that has the same pole: -h/log(pole) [s]; NaN for a pole that is not positive."""
    p = pole(name, h, Tf)
    return -h / np.log(p) if p > 0 else float("nan")


def newest_gain(law: Eq, ratios: Iterable[float]) -> list[float]:
    """What a step of the measurement makes at once of a filtered derivative, in units of K Td/Tf, by h/Tf.

    law: a recursion for D_f, of `pid_updates` or `exact_filters`.

    >>> newest_gain(term.filtered_derivative().full(), [1.0])
    [0.5]
    """
    gain = -by_signals(law.rhs)[at("y")].subs({K: 1, Td: 1, rc_filter.Tf: 1})
    return [float(gain.subs(differences.h, ratio)) for ratio in ratios]
