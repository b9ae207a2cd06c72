"""Lambda tuning: PI or PID for a first-order model with dead time and a wanted closed-loop time constant.

Formulas: `derivations.tuning.rules.lambda_rules`. All times in seconds.
"""

from loopbook.tuning.rule import Tuning, compute


def settings(k: float, T: float, T0: float, closed: float, type: str = "pi") -> Tuning:
    """Settings for k e^{-s T0}/(1 + s T) and the wanted time constant `closed`.

        PI    K = T/(k (closed + T0)), Ti = T
        PID   K = (T0/2 + T)/(k (T0/2 + closed)), Ti = T + T0/2, Td = T T0/(T0 + 2 T)

    k [y/u], T, T0, closed [s]: positive. type: pi or pid (standard form, on the error).
    Robust for closed >= T0 (PI: the loop gain is k K e^{-s T0}/(s T), margin set by closed/T0); slow for loads where
    T is much longer than T0, which `notes` says (simc.settings is the remedy).
    Raises RuleDoesNotApply where a number is not positive and finite, KeyError for another type.

    >>> settings(2, 3, 1, 1).K
    0.75
    """
    if type not in ("pi", "pid"):
        raise KeyError(f"no lambda rule for {type!r}; known: pi, pid")
    slow = f"T = {T:.4g} s is longer than 8 T0: the integral action is slow for loads; SIMC shortens it"
    aggressive = (
        f"closed = {closed:.4g} s is shorter than T0 = {T0:.4g} s: little robustness against a longer dead time"
    )
    notes = [slow] * (T > 8 * T0) + [aggressive] * (closed < T0)
    return compute(f"lambda-{type}", k, T, T0, closed, notes=tuple(notes))
