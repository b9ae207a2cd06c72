"""SIMC (Skogestad 2003): PI for one lag with dead time, PID for two, with one parameter for speed.

Formulas: `derivations.rules.simc_rules`. All times in seconds.
"""

from loopbook.tuning import RuleDoesNotApply, Tuning, compute


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
