"""The numbers of the AMIGO rules, read back out of their expressions.

Each constant is found as a limit, a coefficient or a root, not looked up where it was typed: a rule with a factor
missing or two constants exchanged shows here, and so beside the printed constants. x stands for T/L.
"""

from functools import cache

import sympy
from sympy import Expr, Symbol

from derivations import amigo

x = Symbol("x", positive=True)
UNIT = {amigo.K_p: 1, amigo.K_v: 1, amigo.L: 1, amigo.T: x, amigo.K_180: 1, amigo.T_180: 1}


def _at(expression: Expr, start: bool) -> Expr:
    """The limit for x -> 0 (start) or x -> infinity."""
    return sympy.limit(expression, x, 0 if start else sympy.oo)


def _fraction(expression: Expr) -> tuple[list[Expr], list[Expr]]:
    """Numerator and denominator as descending coefficients in x."""
    return tuple(sympy.Poly(part, x).all_coeffs() for part in sympy.fraction(sympy.cancel(expression)))


@cache
def pi_step() -> dict[str, Expr]:
    """Section 5.3.3.

    >>> pi_step()["pi-step-Ti-2"]
    13
    """
    rule = amigo.pi_step()
    K, Ti = rule.K.subs(UNIT), rule.Ti.subs(UNIT)
    (top, *_), (lead, middle, last) = _fraction(Ti - _at(Ti, True))
    integrating = amigo.pi_step_integrating()
    return {
        "pi-step-K-1": _at(K, True),
        "pi-step-K-2": _at(K / x, False),
        "pi-step-Ti-1": _at(Ti, True),
        "pi-step-Ti-2": top / lead,
        "pi-step-Ti-3": middle / lead,
        "pi-step-Ti-4": last / lead,
        "pi-step-b": rule.b_above,
        "pi-integrating-K": integrating.K.subs(UNIT),
        "pi-integrating-Ti": integrating.Ti.subs(UNIT),
    }


@cache
def pid_step() -> dict[str, Expr]:
    """Section 5.3.4.

    >>> pid_step()["pid-integrating-Ti"]
    8
    """
    rule = amigo.pid_step()
    K, Ti, Td = (e.subs(UNIT) for e in (rule.K, rule.Ti, rule.Td))
    (fast, slow), (shift, one) = _fraction(Ti)
    (gain, _), (lead, offset) = _fraction(Td)
    integrating = amigo.pid_step_integrating()
    return {
        "pid-step-K-1": _at(K, True),
        "pid-step-K-2": _at(K / x, False),
        "pid-step-Ti-1": slow / one,
        "pid-step-Ti-2": fast / one,
        "pid-step-Ti-3": shift / one,
        "pid-step-Td-1": gain / lead,
        "pid-step-Td-2": offset / lead,
        "pid-step-b": rule.b_above,
        "pid-integrating-K": integrating.K.subs(UNIT),
        "pid-integrating-Ti": integrating.Ti.subs(UNIT),
        "pid-integrating-Td": integrating.Td.subs(UNIT),
        "pid-good-K": rule.good["K"][1],
        "pid-good-Ti": rule.good["Ti"][1],
        "pid-good-Td": rule.good["Td"][1],
    }


@cache
def pi_frequency() -> dict[str, Expr]:
    """Section 5.3.5.

    >>> pi_frequency()["pi-frequency-Ti"]
    9/2
    """
    rule = amigo.pi_frequency()
    return {
        "pi-frequency-K": rule.K.subs(UNIT),
        "pi-frequency-Ti": sympy.diff(1 / rule.Ti.subs(UNIT), amigo.kappa),
        "pi-frequency-kappa": rule.good["K"][1],
    }


@cache
def pid_frequency() -> dict[str, Expr]:
    """Section 5.3.6.

    >>> pid_frequency()["pid-frequency-Td-2"]
    19/20
    """
    rule, kappa = amigo.pid_frequency(), amigo.kappa
    K, Ti, Td = (e.subs(UNIT) for e in (rule.K, rule.Ti, rule.Td))
    return {
        "pid-frequency-K-1": K.subs(kappa, 0),
        "pid-frequency-K-2": -sympy.Poly(K, kappa).LC(),
        "pid-frequency-K-3": sympy.degree(K, kappa),
        "pid-frequency-Ti-1": Ti.subs(kappa, 0),
        "pid-frequency-Ti-2": sympy.diff(Ti.subs(kappa, 0) / Ti, kappa),
        "pid-frequency-Td-1": Td.subs(kappa, 0),
        "pid-frequency-Td-2": 1 / sympy.solve(1 / Td, kappa)[0],
        "pid-frequency-kappa": rule.good["K"][1],
    }


@cache
def pid_combined() -> dict[str, Expr]:
    """The twelve weights of section 5.3.7.1, out of K, ki and kd.

    >>> pid_combined()["beta-3"]
    -7/10000
    """
    rule, lags = amigo.pid_combined(), (amigo.T_1, amigo.T_2)
    share = sum(lags) / (sum(lags) + amigo.L_1)
    found = {}
    for letter, expression in (("alpha", rule.K), ("beta", rule.ki), ("gamma", rule.kd / share)):
        weights = sympy.Poly(sympy.cancel(expression.subs(amigo.K_p, 1)).subs(amigo.L_1, 1), *lags)
        monomials = (1, *lags, lags[0] * lags[1])
        found |= {f"{letter}-{i}": weights.coeff_monomial(m) for i, m in enumerate(monomials, start=1)}
    return {**found, "combined-b": rule.b_above}


@cache
def pid_combined_integrating() -> dict[str, Expr]:
    """Section 5.3.7.2 repeats all twelve; its rule for integrating processes holds six of them.

    >>> pid_combined_integrating()["gamma-2-integrating"]
    4/25
    """
    rule = amigo.pid_combined_integrating()
    found = {f"{name}-integrating": value for name, value in pid_combined().items() if name != "combined-b"}
    for letter, expression in (("alpha", rule.K), ("beta", rule.ki), ("gamma", rule.kd)):
        at = sympy.cancel(expression.subs({amigo.K_v: 1, amigo.L_1: 1}))
        constant, slope = sympy.Poly(at, amigo.T_2).all_coeffs()[::-1]
        found |= {f"{letter}-2-integrating": constant, f"{letter}-4-integrating": slope}
    return {**found, "combined-b-integrating": rule.b_above}
