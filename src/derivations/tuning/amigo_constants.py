"""The numbers of the AMIGO rules, read back out of their expressions.

Each rule is brought into pure numbers first (gains times the process's gain, times over its dead time), then each
constant is found as a limit, a coefficient or a root, not looked up where it was typed. A rule with a factor L left out
does not become a pure number (UnitError); two constants exchanged show beside the printed ones.
"""

from functools import cache

import sympy
from sympy import Expr, Symbol

from derivations.algebra.rational import solved_for
from derivations.errors import LoopbookError
from derivations.tuning import amigo, amigo_integrating
from derivations.tuning.letters import K_180, L_1, T_1, T_2, T_180, K_p, K_v, L, T, kappa

x, x_1, x_2 = (Symbol(name, positive=True) for name in ("x", "x_1", "x_2"))  # T/L, T_1/L_1, T_2/L_1


class UnitError(LoopbookError):
    """A rule's formula has not the unit that it must have: a factor is missing or too many."""


def pure(expression: Expr, *allowed: Symbol) -> Expr:
    """The expression with T = x L, T_1 = x_1 L_1 and T_2 = x_2 L_1, which must then hold only the allowed symbols.

    >>> pure(T / L + 1, x)
    x + 1
    """
    number = sympy.cancel(expression.subs({T: x * L, T_1: x_1 * L_1, T_2: x_2 * L_1}))
    extra = number.free_symbols - set(allowed)
    if extra:
        raise UnitError(f"{expression} is no pure number: {', '.join(sorted(map(str, extra)))} remain")
    return number


def _at(expression: Expr, start: bool) -> Expr:
    """The limit for x -> 0 (start) or x -> infinity."""
    return sympy.limit(expression, x, 0 if start else sympy.oo)


def _fraction(expression: Expr) -> tuple[list[Expr], ...]:
    """Numerator and denominator as descending coefficients in x."""
    return tuple(sympy.Poly(part, x).all_coeffs() for part in sympy.fraction(sympy.cancel(expression)))


@cache
def pi_step() -> dict[str, Expr]:
    """Section 5.3.3.

    >>> pi_step()["pi-step-Ti-2"]
    13
    """
    rule, integrating = amigo.pi_step(), amigo_integrating.pi_step_limit()
    K, Ti = pure(rule.K * K_p, x), pure(rule.Ti / L, x)
    (top, *_), (lead, middle, last) = _fraction(Ti - _at(Ti, True))
    return {
        "pi-step-K-1": _at(K, True),
        "pi-step-K-2": _at(K / x, False),
        "pi-step-Ti-1": _at(Ti, True),
        "pi-step-Ti-2": top / lead,
        "pi-step-Ti-3": middle / lead,
        "pi-step-Ti-4": last / lead,
        "pi-step-b": rule.b_above,
        "pi-integrating-K": pure(integrating.K * K_v * L),
        "pi-integrating-Ti": pure(integrating.Ti / L),
    }


@cache
def pid_step() -> dict[str, Expr]:
    """Section 5.3.4.

    >>> pid_step()["pid-integrating-Ti"]
    8
    """
    rule, integrating = amigo.pid_step(), amigo_integrating.pid_step_integrating()
    K, Ti, Td = pure(rule.K * K_p, x), pure(rule.Ti / L, x), pure(rule.Td / L, x)
    (fast, slow), (shift, one) = _fraction(Ti)
    (gain, _), (lead, offset) = _fraction(Td)
    return {
        "pid-step-K-1": _at(K, True),
        "pid-step-K-2": _at(K / x, False),
        "pid-step-Ti-1": slow / one,
        "pid-step-Ti-2": fast / one,
        "pid-step-Ti-3": shift / one,
        "pid-step-Td-1": gain / lead,
        "pid-step-Td-2": offset / lead,
        "pid-step-b": rule.b_above,
        "pid-integrating-K": pure(integrating.K * K_v * L),
        "pid-integrating-Ti": pure(integrating.Ti / L),
        "pid-integrating-Td": pure(integrating.Td / L),
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
        "pi-frequency-K": pure(rule.K * K_180),
        "pi-frequency-Ti-one": (1 / pure(rule.Ti / T_180, kappa)).subs(kappa, 0),
        "pi-frequency-Ti": sympy.diff(1 / pure(rule.Ti / T_180, kappa), kappa),
        "pi-frequency-kappa": rule.good["K"][1],
    }


@cache
def pid_frequency() -> dict[str, Expr]:
    """Section 5.3.6.

    >>> pid_frequency()["pid-frequency-Td-2"]
    19/20
    """
    rule = amigo.pid_frequency()
    K, Ti, Td = pure(rule.K * K_180, kappa), pure(rule.Ti / T_180, kappa), pure(rule.Td / T_180, kappa)
    return {
        "pid-frequency-K-1": K.subs(kappa, 0),
        "pid-frequency-K-2": -sympy.Poly(K, kappa).LC(),
        "pid-frequency-K-3": sympy.degree(K, kappa),
        "pid-frequency-Ti-1": Ti.subs(kappa, 0),
        "pid-frequency-Ti-2": sympy.diff(Ti.subs(kappa, 0) / Ti, kappa),
        "pid-frequency-Td-1": Td.subs(kappa, 0),
        "pid-frequency-Td-one": solved_for(kappa, Td),
        "pid-frequency-Td-2": 1 / solved_for(kappa, 1 / Td),
        "pid-frequency-kappa": rule.good["K"][1],
    }


@cache
def pid_combined() -> dict[str, Expr]:
    """The twelve weights of section 5.3.7.1, out of K, ki and kd.

    >>> pid_combined()["beta-3"]
    -7/10000
    """
    rule = amigo.pid_combined()
    share = (T_1 + T_2) / (T_1 + T_2 + L_1)
    found: dict[str, Expr] = {}
    for letter, number in (("alpha", rule.K), ("beta", rule.ki * L_1), ("gamma", rule.kd / share / L_1)):
        weights = sympy.Poly(pure(number * K_p, x_1, x_2), x_1, x_2)
        monomials = (1, x_1, x_2, x_1 * x_2)
        found |= {f"{letter}-{i}": weights.coeff_monomial(m) for i, m in enumerate(monomials, start=1)}
    return {**found, "combined-b": rule.b_above}


@cache
def pid_combined_integrating() -> dict[str, Expr]:
    """Section 5.3.7.2 repeats all twelve; its rule for integrating processes holds six of them.

    >>> pid_combined_integrating()["gamma-2-integrating"]
    4/25
    """
    rule = amigo_integrating.pid_combined_integrating()
    found = {f"{name}-integrating": value for name, value in pid_combined().items() if name != "combined-b"}
    for letter, number in (("alpha", rule.K * L_1), ("beta", rule.ki * L_1**2), ("gamma", rule.kd)):
        constant, slope = sympy.Poly(pure(number * K_v, x_2), x_2).all_coeffs()[::-1]
        found |= {f"{letter}-2-integrating": constant, f"{letter}-4-integrating": slope}
    return {**found, "combined-b-integrating": rule.b_above}
