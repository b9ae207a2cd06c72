"""The three terms of a PID regulator, the two parallel structures, and what each does to a step of the error.

Time t [s] counts from the step; the control error e has the unit of y, the output u that of the actuator.
"""

from functools import cache

import sympy as sp
from sympy import Expr

s = sp.Symbol("s")
t = sp.Symbol("t", positive=True)
Kp, Ti, Td, alpha = sp.symbols("K_p T_i T_d alpha", positive=True)
x = sp.Symbol("x", positive=True)


def integral_term(error: Expr, upper: Expr = t) -> Expr:
    """(1/Ti) times the integral of e(x) over 0 <= x <= upper; the upper limit is the present, t.

    >>> integral_term(sp.Integer(1))
    t/T_i
    """
    return sp.integrate(error.subs(t, x), (x, 0, upper)) / Ti


@cache
def terms() -> dict[str, Expr]:
    """Transfer functions of the separate terms: P, I and D, each from its own time equation.

    >>> terms()["I"]
    1/(T_i*s)
    """
    area = sp.laplace_transform(integral_term(sp.Integer(1)), t, s, noconds=True) / sp.laplace_transform(
        sp.Integer(1), t, s, noconds=True
    )
    return {"P": Kp, "I": sp.simplify(area), "D": Td * s}


@cache
def dependent() -> Expr:
    """The structure whose gain multiplies all three terms: Kp (1 + 1/(s Ti) + s Td), the standard form."""
    return Kp * (1 + terms()["I"] + terms()["D"])


@cache
def independent() -> Expr:
    """The sum of the separate terms: Kp + 1/(s Ti) + s Td. It is another regulator unless Kp = 1."""
    return sum(terms().values())


@cache
def to_independent() -> dict[str, Expr]:
    """Gains P, I [1/s], D [s] of P + I/s + D s that equal the dependent structure.

    >>> to_independent()["I"]
    K_p/T_i
    """
    numerator = sp.Poly(sp.expand(dependent() * s), s)
    return {"P": numerator.coeff_monomial(s), "I": numerator.coeff_monomial(1), "D": numerator.coeff_monomial(s**2)}


@cache
def real() -> Expr:
    """The dependent structure whose derivative has a lag of Td/alpha: the one that can be built."""
    return Kp * (1 + terms()["I"] + Td * s / (1 + Td / alpha * s))


@cache
def ideal_step() -> Expr:
    """u(t) for t > 0 after a unit step of e, ideal derivative; at t = 0 there is an impulse of area Kp Td besides."""
    return sp.simplify(Kp * (1 + integral_term(sp.Integer(1))))


@cache
def real_step() -> Expr:
    """u(t) for t > 0 after a unit step of e with the real derivative.

    >>> sp.expand(real_step().subs({Kp: 1, Ti: 1, Td: 1}))
    alpha*exp(-alpha*t) + t + 1
    """
    return sp.inverse_laplace_transform(sp.expand(real() / s), s, t)


@cache
def filter_area() -> Expr:
    """Area of the real derivative's decaying peak: Kp Td for every alpha, so it tends to the ideal one's impulse."""
    return sp.integrate(real_step() - ideal_step(), (t, 0, sp.oo))


@cache
def prediction_error() -> Expr:
    """e(t + Td) - (e + Td e') for a smooth error to second order: what "reacts to the future" leaves out.

    The D term extends the error along its tangent; the rest is Td^2 e''/2.
    """
    e = sp.Function("e")
    ahead = e(t) + Td * e(t).diff(t) + Td**2 / 2 * e(t).diff(t, 2)
    return ahead - (e(t) + Td * e(t).diff(t))
