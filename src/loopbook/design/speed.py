"""One knob between slow and fast: the wanted closed-loop time constant, or a speed from 0 to 1.

    closed = slow^(1 - speed) fast^speed,   slow = 3 (T1 + T2 + ... + L),   fast = max(dead time that counts, slow/60)
    (60 instead of 3 for an integrating process, whose slow loops are the quiet ones)
    M = 1.1 + 0.9 speed

closed is lambda of lambda tuning and tau_c of SIMC, M the joint robustness of MIGO (which AMIGO's formulas stand for).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from loopbook.design.model import Model, ModelError
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.registry import RULES
from loopbook.tuning.result import Tuning

SLOWEST, SLOWEST_INTEGRATING, SPREAD = 3.0, 60.0, 60.0
M_SLOW, M_FAST = 1.1, 2.0
CURVE = (0.0, 0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True)
class Speed:
    """speed: 0 slow to 1 fast. closed: the wanted time constant [s]. M: MIGO's robustness."""

    speed: float
    closed: float
    M: float


def time_scale(model: Model) -> float:
    """The lags and the dead time together [s]; of a pure integrator without dead time 1/|Kv|, in which an input of one
    moves the output by one: it has no time of its own.
    """
    return sum(model.lags) + model.delay or 1 / abs(model.gain)


def _ends(model: Model) -> tuple[float, float]:
    slow = (SLOWEST_INTEGRATING if model.integrating else SLOWEST) * time_scale(model)
    rest = model.lags if model.integrating else model.lags[1:]
    return slow, max(model.delay + sum(rest) / 2, slow / SPREAD)


def at_speed(model: Model, speed: float) -> Speed:
    """The setting of the knob for a speed from 0 (slow) to 1 (fast). Raises ModelError outside."""
    if not 0 <= speed <= 1:
        raise ModelError(f"speed = {speed:g}: from 0 (slow) to 1 (fast)")
    slow, fast = _ends(model)
    return Speed(speed, slow ** (1 - speed) * fast**speed, M_SLOW + (M_FAST - M_SLOW) * speed)


def at_closed(model: Model, closed: float) -> Speed:
    """The setting of the knob for a wanted closed-loop time constant [s] > 0; the speed is cut to 0..1 for M."""
    if not (math.isfinite(closed) and closed > 0):
        raise ModelError(f"closed loop = {closed:g} s: a positive time is expected")
    slow, fast = _ends(model)
    speed = math.log(slow / closed) / math.log(slow / fast)
    within = min(max(speed, 0.0), 1.0)
    return Speed(speed, closed, M_SLOW + (M_FAST - M_SLOW) * within)


def rules(model: Model, knob: Speed) -> dict[str, Callable[[ProcessData], Tuning]]:
    """The rules that the knob turns, by name, for the upright model."""
    named = ("simc-pi", "simc-pid", *(() if model.integrating else ("lambda-pi", "lambda-pid")))
    suffix = "-integrating" if model.integrating else ""
    chosen = [RULES[name + suffix] for name in named]
    found: dict[str, Callable[[ProcessData], Tuning]] = {
        f"{rule.title}, closed loop {knob.closed:.3g} s": partial(rule, closed=knob.closed) for rule in chosen
    }
    if 0 <= knob.speed <= 1:
        for rule in (RULES["migo-pi"], RULES["migo-pid"]):
            found[f"{rule.title}, M = {knob.M:.3g}"] = partial(rule, M=knob.M)
    return found
