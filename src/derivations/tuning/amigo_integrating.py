"""AMIGO for integrating processes: as printed, and as the limits of the rules for stable processes, T -> infinity.

The report prints Ti = 13.4 L for PI, which is 13.35 L rounded, and leaves the L out of K = 0.45/(K_v L) for PID; the L
is in the limit and in the units.
"""

from dataclasses import replace
from functools import cache

import sympy
from sympy import Expr, Rational, Symbol

from derivations.tuning.amigo import pi_step, pid_combined, pid_step
from derivations.tuning.letters import K_180, T_1, T_180, K_p, K_v, L, T, kappa
from derivations.tuning.rule import Rule
from derivations.tuning.takes import Takes


@cache
def pi_step_integrating() -> Rule:
    """PI from a step response of an integrating process, as printed in section 5.3.3: Ti = 13.4 L.

    >>> pi_step_integrating().Ti
    67*L/5
    """
    return _integrating(pi_step(), inputs=(K_v, L), K=Rational(35, 100) / (K_v * L), Ti=Rational(134, 10) * L)


@cache
def pi_step_limit() -> Rule:
    """The limit of the PI step rule: Ti = 13.35 L, which section 5.3.3 prints rounded to 13.4 L.

    >>> pi_step_limit().Ti
    267*L/20
    """
    printed = pi_step_integrating()
    return replace(integrating_limit(pi_step()), name="amigo-step-pi-limit", variant_of=printed.name)


@cache
def pid_step_integrating() -> Rule:
    """PID from a step response of an integrating process, section 5.3.4, with the L that the print leaves out of K.

    >>> pid_step_integrating().K
    9/(20*K_v*L)
    """
    return integrating_limit(pid_step())


@cache
def pid_combined_integrating() -> Rule:
    """PID from a short pulse on an integrating process K_v e^(-L1 s)/(s (1 + s T2)), section 5.3.7.2.

    >>> T_2, L_1 = pid_combined_integrating().inputs[1:]
    >>> sympy.factor(pid_combined_integrating().kd.subs({K_v: 1, T_2: 1, L_1: 1}))
    11/25
    """
    limit = integrating_limit(pid_combined())
    section = "5.3.7.2"
    return replace(limit, section=section, source=limit.source.replace(limit.section, section))


def _integrating(stable: Rule, inputs: tuple[Symbol, ...], **formulas: Expr) -> Rule:
    """A rule for an integrating process, which has no relative dead time to speak of: b = 0."""
    takes = Takes.INTEGRATING_STEP if stable.takes is Takes.STEP else Takes.PULSE
    return replace(
        stable, name=f"{stable.name}-integrating", takes=takes, integrating=True, measure=sympy.S.Zero,
        inputs=inputs, good={}, cautions=(), refusals=(), **formulas,
    )  # fmt: skip


def frequency_integrating(rule: Rule) -> Rule:
    """A frequency rule for an integrating process: its static gain is infinite, so kappa = 0.

    >>> from derivations.tuning.amigo import pi_frequency
    >>> frequency_integrating(pi_frequency()).Ti
    T_180
    """
    parts = {name: getattr(rule, name).subs(kappa, 0) for name in ("K", "Ti", "Td")}
    return replace(rule, name=f"{rule.name}-integrating", inputs=(K_180, T_180), **parts)


def _at_infinity(rational: Expr, growing: Symbol) -> Expr:
    """The limit for growing -> infinity of a rational function that has one: the ratio of the leading coefficients."""
    top, bottom = (sympy.Poly(part, growing) for part in sympy.fraction(sympy.cancel(rational)))
    if top.degree() > bottom.degree():
        raise ValueError(f"{rational} grows without bound with {growing}")
    return top.coeff_monomial(growing ** bottom.degree()) / bottom.LC()


def integrating_limit(rule: Rule) -> Rule:
    """The rule for a process whose lag grows without bound while its velocity gain K_v = K_p/T stays.

    Works for the step rules (lag T) and for the combined rule (lag T_1).
    """
    lag = T if T in rule.inputs else T_1
    K, ki, kd = (_at_infinity(e.subs(K_p, K_v * lag), lag) for e in (rule.K, rule.ki, rule.kd))
    inputs = (K_v, *(x for x in rule.inputs if x not in (K_p, lag)))
    return _integrating(rule, inputs=inputs, K=sympy.factor(K), Ti=sympy.cancel(K / ki), Td=sympy.cancel(kd / K))


@cache
def rules() -> tuple[Rule, ...]:
    """From a step response, from a short pulse, and the limit beside the rounded print."""
    return pi_step_integrating(), pid_step_integrating(), pid_combined_integrating(), pi_step_limit()
