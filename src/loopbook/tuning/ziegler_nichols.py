"""Ziegler and Nichols: settings from a step response or from the ultimate gain, in the variants that are in print.

Formulas: `derivations.tuning.rules.step_rules` and `derivations.tuning.rules.ultimate_rules`. All numbers in seconds.
"""

from loopbook.tuning.rule import RuleDoesNotApply, Tuning, compute

STEP_VARIANTS = {
    "p": "zn-step-p",
    "pi": "zn-step-pi",
    "pi-article": "zn-step-pi-article",
    "pid": "zn-step-pid",
}
ULTIMATE_VARIANTS = {
    "p": "zn-ultimate-p",
    "pi": "zn-ultimate-pi",
    "pi-article": "zn-ultimate-pi-article",
    "pid": "zn-ultimate-pid",
    "pid-article": "zn-ultimate-pid-article",
}


def _named(variants: dict[str, str], variant: str) -> str:
    if variant not in variants:
        raise KeyError(f"no variant {variant!r}; known: {', '.join(variants)}")
    return variants[variant]


def step_method(k: float, T: float, T0: float, variant: str = "pid") -> Tuning:
    """Settings from the first-order model k e^{-s T0}/(1 + s T) of a step response.

        a = k T0/T
        P    K = 1/a
        PI   K = 0.9/a, Ti = 3 T0 (variant pi-article) or T0/0.3 (variant pi, the paper of 1942)
        PID  K = 1.2/a, Ti = 2 T0, Td = T0/2

    k: gain [y/u]; T: time constant [s]; T0: dead time [s]; all positive. A negative gain is refused: change the sign
    of u, tune, and change it back.
    Aims at a quarter decay ratio for load disturbances, so set-point steps overshoot; `notes` says so where
    T0/T lies outside 0.1 to 1, where the rule was found.
    Raises RuleDoesNotApply for T0 = 0 (use `first_order.pole_cancelling_pi`), KeyError for an unknown variant.

    >>> round(step_method(3, 3.285, 1.005).Ti, 3)
    2.01
    """
    name = _named(STEP_VARIANTS, variant)
    if T0 == 0:
        raise RuleDoesNotApply(
            f"{name}: a process without dead time (T0 = 0) has a = 0; use first_order.pole_cancelling_pi"
        )
    tuning = compute(name, k, T, T0)
    if 0.1 <= T0 / T <= 1:
        return tuning
    note = f"T0/T = {T0 / T:.3g} lies outside 0.1 to 1, the range the rule was found on"
    return Tuning(tuning.pid, tuning.rule, tuning.source, (note,))


def ultimate_method(Ku: float, Tu: float, variant: str = "pid") -> Tuning:
    """Settings from the gain and the period at which a proportional loop just keeps oscillating.

        P    K = 0.5 Ku
        PI   K = 0.45 Ku, Ti = Tu/1.2 (variant pi) or 0.85 Tu (variant pi-article)
        PID  K = 0.6 Ku, Ti = Tu/2, Td = Tu/8 (variant pid) or 0.12 Tu (variant pid-article)

    Ku: ultimate gain [u/y]; Tu: ultimate period [s]; both positive.
    Exact values come from `derivations.loop.routh.ultimate` (rational process) or the loop's margins (with dead time).
    Raises RuleDoesNotApply where a number is not positive and finite, KeyError for an unknown variant.

    >>> tuning = ultimate_method(1.33, 6.3, "pid-article")
    >>> round(tuning.K, 3), tuning.Ti, round(tuning.Td, 3)
    (0.798, 3.15, 0.756)
    """
    return compute(_named(ULTIMATE_VARIANTS, variant), Ku, Tu)
