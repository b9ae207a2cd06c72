"""Skogestad's half rule: one lag or two and a dead time for a process of more lags.

Source: S. Skogestad, J. Process Control 13 (2003), section 2.
"""

import math
from collections.abc import Sequence
from typing import Any

from loopbook.numerics.real_numbers import plain_number
from loopbook.process.transfer_function import Process
from loopbook.tuning.result import RuleDoesNotApply

REAL = 1e-3  # |imag|/|pole| below which a pole counts as real: what rounding makes of a multiple one


def half_rule(
    lags: Sequence[float], T0: float, inverse: Sequence[float] = (), order: int = 1
) -> tuple[tuple[float, ...], float]:
    """One lag (order 1) or two (order 2) and a dead time for more lags: (lags, T0).

        order 1    T1 + T2/2                T0 + T2/2 + T3 + T4 + ... + inverse
        order 2    T1, T2 + T3/2            T0 + T3/2 + T4 + ...      + inverse

    The largest neglected lag is split in halves between the last lag that stays and the dead time; all that is
    smaller is dead time. lags [s]: of 1/((1 + s T1)(1 + s T2)...), in any order, math.inf for an integrator.
    inverse [s]: of factors (1 - s T), zeros in the right half plane. The gain stays as it is.
    Raises RuleDoesNotApply for fewer lags than asked for, and for what is no time.

    >>> half_rule([1, 1, 1, 1], 0)
    ((1.5,), 2.5)
    """
    if order not in (1, 2):
        raise ValueError(f"order = {order!r}: the half rule gives one lag or two")
    if len(lags) < order:
        raise RuleDoesNotApply(f"half rule: {len(lags)} lags cannot be reduced to {order}; give {order} or more")
    lags, inverse, T0 = [_time(T) for T in lags], [_time(T) for T in inverse], _time(T0)
    kept, rest = sorted(lags, reverse=True)[:order], sorted(lags, reverse=True)[order:]
    half = rest[0] / 2 if rest else 0
    return (*kept[:-1], kept[-1] + half), T0 + half + sum(rest[1:]) + sum(inverse)


def _time(value: Any) -> float:
    try:
        number = plain_number(value)
    except TypeError as error:
        raise RuleDoesNotApply(f"half rule: {error}") from None
    if not number >= 0:
        raise RuleDoesNotApply(f"half rule: {value!r} s is no time: lags, inverse zeros and dead time are not negative")
    return number if isinstance(number, int) else float(number)


def lags_of(process: Process) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """(lags, inverse) of a process with real poles, its zeros in the right half plane; math.inf for an integrator.

    Raises RuleDoesNotApply for complex poles, unstable ones and zeros in the left half plane, which the half rule does
    not cover.

    >>> lags_of(Process([1], [8, 6, 1]))
    ((4.0, 2.0), ())
    """
    lags: tuple[float, ...]
    if process.order == 1 and process.den[-1]:
        lags, poles = (process.den[0] / process.den[1],), process.poles[:0]
    else:
        lags, poles = (), process.poles
    for pole in poles:
        if abs(pole) == 0:
            lags += (math.inf,)
        elif abs(pole.imag) > REAL * abs(pole):
            raise RuleDoesNotApply(
                f"the half rule takes real lags, the process has the poles {pole:.4g} and its conjugate: make a step "
                "experiment and take its data",
                "use loopbook.experiments.step.step_data(process)",
            )
        else:
            lags += (float(1 / abs(pole) if pole.real < 0 else -1 / abs(pole)),)
    if any(T < 0 for T in lags):
        raise RuleDoesNotApply(f"the process is unstable by itself, time constants {[float(f'{T:.4g}') for T in lags]}")
    if any(zero.real < 0 or abs(zero.imag) > REAL * abs(zero) for zero in process.zeros):
        raise RuleDoesNotApply(
            f"the half rule takes zeros in the right half plane; the process has {process.zeros.round(4)}: make a "
            "step experiment and take its data",
            "use loopbook.experiments.step.step_data(process)",
        )
    return tuple(sorted(lags, reverse=True)), tuple(float(1 / zero.real) for zero in process.zeros)
