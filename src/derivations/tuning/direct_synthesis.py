"""Direct synthesis: the regulator that gives a wanted closed loop, and its settings in the standard form.

    C = M/(G (1 - M)),   M = e^(-s T_0)/(1 + lambda s)

The dead time of the process G stays in the closed loop M, which otherwise is one lag lambda. Two ways to make that a
PID regulator: 1 - e^(-s T_0) by its tangent, s T_0, or the dead time in G and M by Padé of order 1.
"""

from functools import cache

import sympy as sp
from sympy import Expr, Symbol

from derivations.tuning.letters import T_0, K_v, k, lam

s = Symbol("s")


def by_tangent(lags: Expr) -> Expr:
    """C for k e^(-s T_0)/lags, with 1 - e^(-s T_0) by its tangent at s = 0.

    >>> from derivations.tuning.letters import T
    >>> sp.factor(by_tangent(1 + s * T))
    (T*s + 1)/(k*s*(T_0 + lambda))
    """
    delay = sp.exp(-s * T_0)
    without = delay.subs(s, 0) + s * delay.diff(s).subs(s, 0)
    return sp.cancel(lags / k / (1 + lam * s - without))


def by_pade(lags: Expr) -> Expr:
    """C for k e^(-s T_0)/lags, with the dead time by Padé of order 1 in the process and in the wanted loop."""
    delay = (1 - s * T_0 / 2) / (1 + s * T_0 / 2)
    wanted = (1 - s * T_0 / 2) / (1 + lam * s)
    return sp.cancel(wanted / (k * delay / lags * (1 - wanted)))


def standard(C: Expr) -> tuple[Expr, Expr, Expr]:
    """(K, Ti, Td) of C = K (1 + 1/(s Ti) + s Td). Raises ValueError where C is no such regulator.

    >>> a, b = sp.symbols("a b", positive=True)
    >>> standard((1 + a * s) * (1 + b * s) / s)
    (a + b, a + b, a*b/(a + b))
    """
    top = sp.cancel(C * s)
    if sp.denom(top).has(s) or sp.degree(sp.numer(top), s) > 2:
        raise ValueError(f"{C} is not of the form K (1 + 1/(s Ti) + s Td)")
    ki, K, kd = (sp.factor(sp.expand(top).coeff(s, n)) for n in range(3))
    return K, sp.cancel(K / ki), sp.cancel(kd / K)


@cache
def integral_time_of_an_integrator() -> Expr:
    """The shortest Ti for which PI on K_v e^(-s T_0)/s does not swing slowly: the characteristic polynomial without
    the dead time has a double root.

    >>> integral_time_of_an_integrator()
    4*T_0 + 4*lambda
    """
    Ti = Symbol("T_i", positive=True)
    gain = slope_gain()
    (found,) = sp.solve(sp.discriminant(sp.numer(sp.together(s**2 + gain * K_v * (s + 1 / Ti))), s), Ti)
    return sp.expand(found)


@cache
def slope_gain() -> Expr:
    """The gain for K_v e^(-s T_0)/s: that of a lag T of the gain k = K_v T, for T to infinity."""
    T = Symbol("T", positive=True)
    return sp.factor(sp.limit(standard(by_tangent(1 + s * T))[0].subs(k, K_v * T), T, sp.oo))
