"""A PI regulator with Ti = T on the plant k/(1 + s T): what the closed loop is, exactly.

The regulator's zero cancels the plant's pole, the loop transfer function is a pure integrator, and the set-point
response is that of one lag, whatever T is. The cancelled mode exp(-t/T) stays in the response to a load.
"""

from functools import cache

import sympy as sp
from sympy import Expr

from derivations.algebra.final_value import T, k, s

lam = sp.Symbol("alpha", positive=True)
"""The wanted time constant of the closed loop [s]; the article calls it alpha."""
t = sp.Symbol("t", positive=True)
plant = k / (1 + s * T)


@cache
def gain() -> Expr:
    """K that gives the closed loop 1/(1 + s alpha) with Ti = T: solved from the loop, not assumed.

    >>> gain()
    T/(alpha*k)
    """
    K = sp.Symbol("K")
    wanted = sp.Eq(sp.simplify(plant * K * (1 + 1 / (s * T))), 1 / (s * lam))
    (solution,) = sp.solve(wanted, K)
    return solution


@cache
def regulator() -> Expr:
    """K (1 + 1/(s T)) with that gain."""
    return gain() * (1 + 1 / (s * T))


@cache
def setpoint_transfer() -> Expr:
    """Y/W, after cancellation.

    >>> setpoint_transfer()
    1/(alpha*s + 1)
    """
    loop = sp.simplify(regulator() * plant)
    return sp.simplify(loop / (1 + loop))


@cache
def load_transfer() -> Expr:
    """Y/D for a load d at the plant's input: two modes, alpha and T.

    >>> load_transfer()
    alpha*k*s/((T*s + 1)*(alpha*s + 1))
    """
    return sp.factor(sp.simplify(plant / (1 + regulator() * plant)))


@cache
def load_response() -> Expr:
    """y(t) after a unit step of the load, for alpha != T: k alpha (e^(-t/T) - e^(-t/alpha))/(T - alpha)."""
    step = load_transfer() / s
    modes = [sp.factor(sp.limit(step * (s + 1 / tau), s, -1 / tau)) * sp.exp(-t / tau) for tau in (T, lam)]
    return sp.factor_terms(sum(modes))


@cache
def load_response_equal() -> Expr:
    """The same for alpha = T: k t e^(-t/T)/T.

    >>> load_response_equal()
    k*t*exp(-t/T)/T
    """
    return sp.inverse_laplace_transform(sp.factor(load_transfer().subs(lam, T) / s), s, t)


@cache
def load_area() -> Expr:
    """Integral of y(t) over a unit step of the load; y does not change sign, so it is the integral of |y| too.

    >>> load_area()
    alpha*k
    """
    return sp.limit(load_transfer() / s, s, 0)
