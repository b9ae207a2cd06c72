"""SIMC (Skogestad 2003): PI for one lag with dead time, PID for two, with one parameter for speed.

Formulas: `derivations.tuning.rules.simc_rules`. A process of more lags is first reduced by the half rule. All times in
seconds.
"""

import math
from collections.abc import Sequence

from loopbook.tuning.rule import RuleDoesNotApply, Tuning, compute


def half_rule(lags: Sequence[float], T0: float, inverse: Sequence[float] = (), order: int = 1):
    """One lag (order 1) or two (order 2) and a dead time for more lags: (lags, T0).

        order 1    T1 + T2/2                T0 + T2/2 + T3 + T4 + ... + inverse
        order 2    T1, T2 + T3/2            T0 + T3/2 + T4 + ...      + inverse

    The largest neglected lag is split in halves between the last lag that stays and the dead time; all that is
    smaller is dead time. lags [s]: of 1/((1 + s T1)(1 + s T2)...), in any order, math.inf for an integrator.
    inverse [s]: of factors (1 - s T), zeros in the right half plane. The gain stays as it is.
    Source: S. Skogestad, J. Process Control 13 (2003), section 2.

    >>> half_rule([1, 1, 1, 1], 0)
    ((1.5,), 2.5)
    """
    if order not in (1, 2):
        raise ValueError(f"order = {order!r}: the half rule gives one lag or two")
    kept, rest = sorted(lags, reverse=True)[:order], sorted(lags, reverse=True)[order:]
    half = rest[0] / 2 if rest else 0
    return (*kept[:-1], kept[-1] + half), T0 + half + sum(rest[1:]) + sum(inverse)


def settings(k: float, T: float, T0: float, closed: float | None = None, T2: float = 0.0) -> Tuning:
    """Settings for k e^{-s T0}/((1 + s T)(1 + s T2)), T >= T2; closed is the wanted time constant tau_c.

        series   Kc = T/(k (closed + T0)), tau_I = min(T, 4 (closed + T0)), tau_D = T2
        here     the equal standard form: K = Kc (1 + T2/tau_I), Ti = tau_I + T2, Td = T2/(1 + T2/tau_I)

    k [y/u], T, T0 [s]: positive. closed [s]: default T0, the author's recommendation. T2 = 0 gives PI.
    Ms is 1.59 for closed = T0, T <= 8 T0, T2 = 0 (only T0 and closed shape the loop then); `notes` warns below that.
    Raises RuleDoesNotApply where a number is not positive and finite, or T2 > T.

    >>> settings(1, 10, 1).pid.Ti
    8.0
    """
    closed = T0 if closed is None else closed
    if T2 > T:
        raise RuleDoesNotApply(f"simc: T2 = {T2:g} s is the shorter time constant, T = {T:g} s the longer; swap them")
    note = f"closed = {closed:g} s is shorter than T0 = {T0:g} s: faster than the author recommends"
    notes = (note,) if closed < T0 else ()
    if T2 == 0:
        return compute("simc-pi", k, T, T0, closed, notes=notes)
    return compute("simc-pid", k, T, T2, T0, closed, notes=notes)


def settings_integrating(kv: float, T0: float, closed: float | None = None, T2: float = 0.0) -> Tuning:
    """Settings for kv e^{-s T0}/(s (1 + s T2)): those of a lag so long that only its slope k/T = kv is seen.

        series   Kc = 1/(kv (closed + T0)), tau_I = 4 (closed + T0), tau_D = T2

    kv [y/(u s)], T0 [s]: positive. closed [s]: default T0. T2 = 0 gives PI. Ms is 1.70 for closed = T0, T2 = 0.
    Raises RuleDoesNotApply where a number is not positive and finite.

    >>> pid = settings_integrating(0.5, 2).pid
    >>> pid.K, pid.Ti
    (0.5, 16.0)
    """
    closed = T0 if closed is None else closed
    T = max(4 * (closed + T0), T2)
    return settings(kv * T, T, T0, closed, T2)


def reduced(k: float, lags: Sequence[float], T0: float, order: int = 1) -> Tuning:
    """Settings for k e^{-s T0}/((1 + s T1)(1 + s T2)...), reduced by `half_rule`: PI for order 1, PID for order 2.

    k [y/u]; with an integrator (a lag of math.inf) the gain kv [y/(u s)] of 1/s. Raises RuleDoesNotApply as `settings`,
    and for order 2 where the process has but one lag, for which SIMC gives PI.

    >>> reduced(1, [10, 2], 1).K
    2.75
    """
    if len(lags) < order:
        raise RuleDoesNotApply("simc: derivative action needs a second lag; the model has one, for which SIMC gives PI")
    kept, delay = half_rule(lags, T0, order=order)
    T2 = kept[1] if order == 2 else 0.0
    if math.isinf(kept[0]):
        return settings_integrating(k, delay, T2=T2)
    return settings(k, kept[0], delay, T2=T2)
