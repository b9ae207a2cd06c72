"""Double pulse: what the extremes of the response tell about a first-order process with dead time.

The input is +u_a for a time T_p, then -u_a for T_p, then zero (pid-report, section 5.2.3). The process

    K_p e^(-L s) / (1 + s T)

answers with a maximum where the first pulse ends, seen L later, and a minimum where the second one ends. Between
those instants the output is one exponential, so both extremes follow in closed form and can be solved for K_p and T.
"""

from dataclasses import dataclass
from functools import cache

import sympy
from sympy import Expr, Symbol, exp, log, symbols

K_p, T, L, u_a, T_p = symbols("K_p T L u_a T_p", positive=True)
y_max = Symbol("y_max", positive=True)
y_min = Symbol("y_min", negative=True)
t_max, t_min = symbols("t_max t_min", positive=True)


@dataclass(frozen=True)
class Extremes:
    """The two extremes of the output and the instants at which they are reached, in terms of the process."""

    y_max: Expr
    y_min: Expr
    t_max: Expr
    t_min: Expr


@dataclass(frozen=True)
class PulseFormulas:
    """The process in terms of the two extremes; L once from each extreme."""

    K_p: Expr
    T: Expr
    L_from_max: Expr
    L_from_min: Expr


def _relax(start: Expr, target: Expr, duration: Expr) -> Expr:
    """A first-order lag moves from start towards target for a duration."""
    return target + (start - target) * exp(-duration / T)


@cache
def extremes() -> Extremes:
    """The extremes of the response, from the first-order lag's exponential.

    >>> extremes().t_min
    L + 2*T_p
    """
    top = sympy.factor(_relax(sympy.S.Zero, K_p * u_a, T_p))
    bottom = sympy.factor(_relax(top, -K_p * u_a, T_p))
    return Extremes(top, bottom, L + T_p, L + 2 * T_p)


@cache
def estimate() -> PulseFormulas:
    """The extremes solved for the process.

    The ratio y_min/y_max = -(1 - e^(-T_p/T)) does not hold K_p: it gives T; y_max then gives K_p.

    >>> estimate().K_p
    -y_max**2/(u_a*y_min)
    """
    found = extremes()
    remains = Symbol("E", positive=True)  # e^(-T_p/T)
    top, bottom = (sympy.expand(e).subs(exp(-2 * T_p / T), remains**2) for e in (found.y_max, found.y_min))
    top, bottom = (e.subs(exp(-T_p / T), remains) for e in (top, bottom))
    (left,) = sympy.solve(sympy.cancel(bottom / top) - y_min / y_max, remains)
    (gain,) = sympy.solve(top.subs(remains, left) - y_max, K_p)
    return PulseFormulas(
        K_p=sympy.simplify(gain),
        T=-T_p / log(sympy.expand(left)),
        L_from_max=sympy.solve(found.t_max - t_max, L)[0],
        L_from_min=sympy.solve(found.t_min - t_min, L)[0],
    )
