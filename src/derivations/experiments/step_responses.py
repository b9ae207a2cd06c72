"""Unit step responses of the process models that an identification fits, derived by partial fractions.

Each is given for the time after the dead time; before it the response is zero.

>>> first_order()
1 - exp(-t/T)
"""

from functools import cache

import sympy
from sympy import Symbol

t = Symbol("t", nonnegative=True)
s = Symbol("s")
T = Symbol("T", positive=True)
T2 = Symbol("T_2", positive=True)
w0, zeta = Symbol("omega_0", positive=True), Symbol("zeta", positive=True)


def unit_step_response(transfer: sympy.Expr) -> sympy.Expr:
    """The response to a unit step, the inverse Laplace transform of G(s)/s, for t >= 0.

    transfer: a strictly proper rational G(s) whose poles are real. Each term c/(s - p)^k of the partial fractions of
    G(s)/s gives c t^(k-1) e^(pt)/(k-1)!. Raises ValueError for a direct term or complex poles.
    """
    factors = [factor for factor, _ in sympy.factor_list(sympy.denom(sympy.together(transfer / s)), s)[1]]
    response = sympy.Integer(0)
    for term in sympy.Add.make_args(sympy.apart(sympy.together(transfer / s), s)):
        numerator, denominator = sympy.fraction(sympy.together(term))
        poles = sympy.roots(sympy.Poly(denominator, s))
        if len(poles) != 1 or numerator.has(s):
            raise ValueError(f"{transfer}: only strictly proper transfer functions with real poles, got {factors}")
        ((pole, order),) = poles.items()
        weight = sympy.factor(numerator / sympy.Poly(denominator, s).LC() / sympy.factorial(order - 1))
        response += weight * t ** (order - 1) * sympy.exp(pole * t)
    return response


@cache
def first_order() -> sympy.Expr:
    """One lag, 1/(1 + T s)."""
    return unit_step_response(1 / (1 + T * s))


@cache
def two_lags() -> sympy.Expr:
    """Two different lags, 1/((1 + T s)(1 + T_2 s))."""
    return unit_step_response(1 / ((1 + T * s) * (1 + T2 * s)))


@cache
def two_equal_lags() -> sympy.Expr:
    """A double lag, 1/(1 + T s)^2: the limit of `two_lags` for T_2 towards T."""
    return unit_step_response(1 / (1 + T * s) ** 2)


@cache
def integrator() -> sympy.Expr:
    """A pure integrator, 1/s."""
    return unit_step_response(1 / s)


@cache
def integrator_with_lag() -> sympy.Expr:
    """An integrator behind a lag, 1/(s (1 + T s))."""
    return unit_step_response(1 / (s * (1 + T * s)))


@cache
def ringing() -> sympy.Expr:
    """A pair of complex poles, w0^2/(s^2 + 2 zeta w0 s + w0^2) with zeta < 1.

    The poles -zeta w0 +- i w0 r, r = sqrt(1 - zeta^2), make it 1 - e^(-zeta w0 t) (cos(w0 r t) + zeta/r sin(w0 r t)):
    the ansatz whose differential equation and start (0, 0) are checked here before it is returned.
    """
    r = sympy.sqrt(1 - zeta**2)
    y = 1 - sympy.exp(-zeta * w0 * t) * (sympy.cos(w0 * r * t) + zeta / r * sympy.sin(w0 * r * t))
    equation = y.diff(t, 2) + 2 * zeta * w0 * y.diff(t) + w0**2 * y - w0**2
    if sympy.simplify(equation) != 0 or y.subs(t, 0) != 0 or sympy.simplify(y.diff(t).subs(t, 0)) != 0:
        raise ArithmeticError("the step response of a pair of complex poles does not solve its equation")
    return y
