"""A first-order model with dead time through two points of a step response.

    y(t) = k du (1 - e^(-(t - T0)/T)) for t >= T0

With the time t1 at which the part p1 of the final change is reached, and t2 for p2 < p1, two equations give T and T0.
For p1 = 1 - e^-1 (63.2 %) and p2 = 1 - e^(-1/3) (28.3 %) the factor is exactly 3/2.
"""

from functools import cache

import sympy as sp
from sympy import Expr

from derivations.algebra.rational import solved_for

t, t1, t2, T, T0, tau = sp.symbols("t t_1 t_2 T T_0 tau", positive=True)
p1, p2 = sp.symbols("p_1 p_2", positive=True)
k, du, x = sp.symbols("k Delta_u x", positive=True)

FRACTIONS = {p1: 1 - sp.exp(-1), p2: 1 - sp.exp(-sp.Rational(1, 3))}
"""What 63.2 % and 28.3 % stand for."""


@cache
def response() -> Expr:
    """The model's output for t >= T0 after a step du of the input.

    >>> sp.simplify(response().subs(t, rise()) / (k * du))
    p_1
    """
    return k * du * (1 - sp.exp(-(t - T0) / T))


@cache
def rise(p: Expr = p1) -> Expr:
    """The instant at which the model has made the part p of the way.

    >>> rise()
    -T*log(1 - p_1) + T_0
    """
    left = sp.Symbol("q", positive=True)
    instant = solved_for(tau, sp.log(sp.exp(-tau)), sp.log(left))
    return T0 + T * instant.subs(left, 1 - p)


@cache
def fit() -> dict[sp.Symbol, Expr]:
    """T and T0 from t1 and t2 for any two parts p1 > p2."""
    start = solved_for(T0, t2, rise(p2))
    constant = solved_for(T, t1, rise(p1).subs(T0, start))
    return {T: constant, T0: sp.factor(start.subs(T, constant))}


@cache
def fit_283_632() -> dict[sp.Symbol, Expr]:
    """The article's pair: T = 1.5 (t1 - t2), T0 = t1 - T.

    >>> fit_283_632()[T], sp.expand(fit_283_632()[T0] - (t1 - fit_283_632()[T]))
    (3*t_1/2 - 3*t_2/2, 0)
    """
    return {name: sp.expand(e.subs(FRACTIONS)) for name, e in fit().items()}


@cache
def equal_lags(order: int) -> Expr:
    """The part of a step that so many equal lags in a row have made after x = t/tau.

    Each lag is driven by the one before, ``dy/dx = before - y``, so that y is the integral of before(v) e^(-(x - v)).

    >>> sp.factor(equal_lags(2) - 1)
    -(x + 1)*exp(-x)
    """
    if order == 0:
        return sp.Integer(1)
    v = sp.Symbol("v", positive=True)
    driven = sp.integrate(sp.expand(equal_lags(order - 1).subs(x, v) * sp.exp(v)), (v, 0, x))
    return sp.expand(driven * sp.exp(-x))


@cache
def double_lag_instant(p: Expr) -> Expr:
    """The instant at which k/(1 + s tau)^2 has made the part p of a step, in closed form.

    (1 + x) e^(-x) = 1 - p with x = t/tau is solved by the lower branch of Lambert's function:

    >>> double_lag_instant(sp.Symbol("p"))
    tau*(-LambertW((p - 1)*exp(-1), -1) - 1)
    """
    return tau * (-1 - sp.LambertW(-(1 - p) * sp.exp(-1), -1))
