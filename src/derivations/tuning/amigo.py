"""The AMIGO rules as SymPy expressions: what is shown and what computes come from one object.

The rules were fitted to the MIGO optimum (largest integral gain for robustness M = 1.4) of a batch of processes; they
are cited, not derived (pid-report, sections 5.3.2 to 5.3.7). What can be derived is: the rules for integrating
processes are the limits T -> infinity of the rules for stable ones (`integrating_limit`), and the adjustment for a
derivative filter keeps the sum of all lags (`with_filter`).

All rules give the standard form K (b r - y + (1/Ti) int e dt - Td dy/dt), derivative on the measurement.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache

import sympy
from sympy import Expr, Integer, Rational, Symbol, symbols

K_p, K_v, T, L = symbols("K_p K_v T L", positive=True)
K_180, T_180, kappa = symbols("K_180 T_180 kappa", positive=True)
T_1, T_2, L_1, T_f = symbols("T_1 T_2 L_1 T_f", positive=True)

SECOND_ORDER = {  # section 5.3.7: the weights of 1, T1/L1, T2/L1 and T1 T2/L1^2 in K, ki and kd
    "alpha": (Rational(19, 100), Rational(37, 100), Rational(18, 100), Rational(2, 100)),
    "beta": (Rational(48, 100), Rational(3, 100), Rational(-7, 10000), Rational(12, 10000)),
    "gamma": (Rational(29, 100), Rational(16, 100), Rational(20, 100), Rational(28, 100)),
}


@dataclass(frozen=True)
class Rule:
    """One AMIGO rule.

    inputs: the symbols it needs. K, Ti, Td: the formulas, Td = 0 for PI. b_above: the relative dead time tau above
    which the set-point weight b is 1 (0 at and below), None where no rule for b is given. good: by parameter, symbol
    (tau or kappa) and the value above which the source calls that parameter good; empty where it calls all good.
    """

    name: str
    section: str
    inputs: tuple[Symbol, ...]
    K: Expr
    Ti: Expr
    Td: Expr = sympy.S.Zero
    b_above: Rational | None = None
    good: Mapping[str, tuple[str, Rational]] = field(default_factory=dict)

    @property
    def ki(self) -> Expr:
        """The integral gain K/Ti."""
        return self.K / self.Ti

    @property
    def kd(self) -> Expr:
        """The derivative gain K Td."""
        return self.K * self.Td


@cache
def pi_step() -> Rule:
    """PI from a step response, section 5.3.3.

    >>> pi_step().K.subs({K_p: 1, T: 1, L: 1})
    1/4
    """
    return Rule(
        "PI step",
        "5.3.3",
        (K_p, T, L),
        K=Rational(15, 100) / K_p + (Rational(35, 100) - L * T / (L + T) ** 2) * T / (K_p * L),
        Ti=Rational(35, 100) * L + 13 * L * T**2 / (T**2 + 12 * L * T + 7 * L**2),
        b_above=Rational(3, 10),
    )


@cache
def pi_step_integrating() -> Rule:
    """PI from a step response of an integrating process, as printed in section 5.3.3: Ti = 13.4 L.

    >>> pi_step_integrating().Ti
    67*L/5
    """
    return Rule(
        "PI step, integrating",
        "5.3.3",
        (K_v, L),
        K=Rational(35, 100) / (K_v * L),
        Ti=Rational(134, 10) * L,
        b_above=Rational(3, 10),
    )


@cache
def pid_step() -> Rule:
    """PID from a step response, section 5.3.4.

    >>> pid_step().K.subs({K_p: 1, T: 1, L: 1})
    13/20
    """
    return Rule(
        "PID step",
        "5.3.4",
        (K_p, T, L),
        K=(Rational(2, 10) + Rational(45, 100) * T / L) / K_p,
        Ti=(Rational(4, 10) * L + Rational(8, 10) * T) / (L + Rational(1, 10) * T) * L,
        Td=Rational(5, 10) * L * T / (Rational(3, 10) * L + T),
        b_above=Rational(5, 10),
        good={"K": ("tau", Rational(3, 10)), "Ti": ("tau", Rational(2, 10)), "Td": ("tau", Rational(5, 10))},
    )


@cache
def pid_step_integrating() -> Rule:
    """PID from a step response of an integrating process, section 5.3.4, with the L that the print leaves out of K.

    >>> pid_step_integrating().K
    9/(20*K_v*L)
    """
    limit = integrating_limit(pid_step())
    return replace(limit, name="PID step, integrating")


@cache
def pi_frequency() -> Rule:
    """PI from one point of the frequency response, section 5.3.5; kappa = K_180/K_p.

    >>> pi_frequency().Ti
    T_180/(9*kappa/2 + 1)
    """
    return Rule(
        "PI frequency",
        "5.3.5",
        (K_180, T_180, kappa),
        K=Rational(16, 100) / K_180,
        Ti=T_180 / (1 + Rational(45, 10) * kappa),
        good=dict.fromkeys(("K", "Ti"), ("kappa", Rational(2, 10))),
    )


@cache
def pid_frequency() -> Rule:
    """PID from one point of the frequency response, section 5.3.6; kappa = K_180/K_p.

    >>> pid_frequency().Td.subs(kappa, 0)
    3*T_180/20
    """
    return Rule(
        "PID frequency",
        "5.3.6",
        (K_180, T_180, kappa),
        K=(Rational(3, 10) - Rational(1, 10) * kappa**4) / K_180,
        Ti=Rational(6, 10) / (1 + 2 * kappa) * T_180,
        Td=Rational(15, 100) * (1 - kappa) / (1 - Rational(95, 100) * kappa) * T_180,
        good=dict.fromkeys(("K", "Ti", "Td"), ("kappa", Rational(2, 10))),
    )


@cache
def pid_combined() -> Rule:
    """PID from a step response and one point of the frequency response together, section 5.3.7.1.

    >>> pid_combined().K.subs({K_p: 1, T_1: 1, T_2: 1, L_1: 1})
    19/25
    """
    alpha, beta, gamma = SECOND_ORDER.values()
    basis = (Integer(1), T_1 / L_1, T_2 / L_1, T_1 * T_2 / L_1**2)
    K, ki, kd = (sum(c * x for c, x in zip(row, basis, strict=True)) / K_p for row in (alpha, beta, gamma))
    ki = sympy.expand(ki / L_1)
    kd = kd * L_1 * (T_1 + T_2) / (T_1 + T_2 + L_1)
    return Rule("PID step and frequency", "5.3.7.1", (K_p, T_1, T_2, L_1), K, K / ki, kd / K, Rational(5, 10))


@cache
def pid_combined_integrating() -> Rule:
    """PID from a short pulse on an integrating process K_v e^(-L1 s)/(s (1 + s T2)), section 5.3.7.2.

    >>> sympy.factor(pid_combined_integrating().kd.subs({K_v: 1, T_2: 1, L_1: 1}))
    11/25
    """
    limit = integrating_limit(pid_combined())
    return replace(limit, name="PID step and frequency, integrating", section="5.3.7.2")


def frequency_integrating(rule: Rule) -> Rule:
    """A frequency rule for an integrating process: its static gain is infinite, so kappa = 0.

    >>> frequency_integrating(pi_frequency()).Ti
    T_180
    """
    parts = {name: getattr(rule, name).subs(kappa, 0) for name in ("K", "Ti", "Td")}
    return replace(rule, name=f"{rule.name}, integrating", inputs=(K_180, T_180), **parts)


@cache
def pi_step_limit() -> Rule:
    """The limit of the PI step rule: Ti = 13.35 L, which section 5.3.3 prints rounded to 13.4 L.

    >>> pi_step_limit().Ti
    267*L/20
    """
    return replace(integrating_limit(pi_step()), name="PI step, limit T to infinity")


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
    ki, kd = rule.ki, rule.kd
    K, ki, kd = (_at_infinity(e.subs(K_p, K_v * lag), lag) for e in (rule.K, ki, kd))
    inputs = (K_v, *(x for x in rule.inputs if x not in (K_p, lag)))
    return replace(rule, inputs=inputs, K=sympy.factor(K), Ti=sympy.cancel(K / ki), Td=sympy.cancel(kd / K))


def with_filter(data: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
    """Process data adjusted for a derivative filter of time constant T_f, section 5.3.2.

    Half of T_f goes to the (shorter) lag, half to the dead time; gains stay. So the sum of all lags and dead times,
    which is the area above the step response divided by K_p, grows by T_f as it must.

    >>> with_filter({T: T, L: L})
    {T: T + T_f/2, L: L + T_f/2}
    """
    shorter = T if T in data else T_2
    dead = L if L in data else L_1
    return {symbol: value + T_f / 2 if symbol in (shorter, dead) else value for symbol, value in data.items()}
