"""Chien, Hrones and Reswick: settings from a step response, for no overshoot or for 20 %, and which type to take.

Formulas: `derivations.tuning.rules.chr_rules`, for changes of the set-point. All times in seconds.
"""

from loopbook.tuning.rule import RuleDoesNotApply, Tuning, compute

TYPES = ("p", "pi", "pid")
BOUNDS = {"higher order": (0.0, 3.0), "pid": (3.0, 7.5), "pi": (7.5, 10.0), "p": (10.0, float("inf"))}
"""The type that the article's table gives for low < R < high; R = 3, 7.5 and 10 belong to no row."""


def ratio(T: float, T0: float) -> float:
    """R = T/T0, time constant [s] over dead time [s]; infinite without dead time.

    Raises RuleDoesNotApply where a time is negative or T is zero.
    """
    if not (T > 0 and T0 >= 0):
        raise RuleDoesNotApply(f"R = T/T0 needs T > 0 and T0 >= 0, got T = {T:g} s, T0 = {T0:g} s")
    return T / T0 if T0 else float("inf")


def types(R: float) -> tuple[str, ...]:
    """The types of regulator that the table names for R: one, or at a border the two beside it (it names neither).

    The borders are left open in print; both neighbours are returned because either is as good.

    >>> types(3.2687), types(7.5)
    (('pid',), ('pid', 'pi'))
    """
    return tuple(name for name, (low, high) in BOUNDS.items() if low <= R <= high)


def settings(k: float, T: float, T0: float, type: str = "pid", overshoot: int = 0) -> Tuning:
    """Settings from the first-order model k e^{-s T0}/(1 + s T), with a = k T0/T.

        overshoot 0    P 0.3/a;  PI 0.35/a, Ti = 1.2 T;  PID 0.6/a, Ti = T, Td = 0.5 T0
        overshoot 20   P 0.7/a;  PI 0.6/a, Ti = T;       PID 0.95/a, Ti = 1.4 T, Td = 0.47 T0

    k [y/u], T [s], T0 [s]: positive. type: p, pi or pid. overshoot: 0 or 20 (per cent of a set-point step).
    `notes` says where the table by R would take another type. The overshoot is an aim, not a guarantee: it was found
    on the process of the authors' simulator with the PID's derivative on the error.
    Raises RuleDoesNotApply for T0 = 0, KeyError for another type or overshoot.

    >>> round(settings(3, 3.285, 1.005, "pid", 20).K, 4)
    1.0351
    """
    if type not in TYPES or overshoot not in (0, 20):
        raise KeyError(f"no row {type!r} with {overshoot} %; types: {', '.join(TYPES)}; overshoot: 0 or 20")
    fitting = types(ratio(T, T0))
    taken = " or ".join(t.upper() if t in TYPES else f"a regulator of {t}" for t in fitting)
    note = f"R = T/T0 = {ratio(T, T0):.4g}: by this ratio the method's own table takes {taken}"
    return compute(f"chr-{type}-{overshoot}", k, T, T0, notes=() if type in fitting else (note,))
