"""The plant y'' = -y' - sqrt(y) + u: its steady states, its linear models, and a PID regulator whose settings follow y.

Two ways to schedule a gain that multiplies an integral are two different regulators:

    inside    u = K(y) (e + Td(y) e') + z,    z' = K(y)/Ti(y) e
    outside   u = K(y) (e + Td(y) e' + q/Ti(y)),    q' = e

They are equal for constant settings. Around a steady state with u0 = sqrt(y0) the second contains one feedback more,
because a change of y changes the factor in front of the stored integral.
"""

from functools import cache

import sympy as sp
from sympy import Expr

from derivations.algebra.rational import solved_for

s = sp.Symbol("s")
y, v, u = sp.symbols("y v u", positive=True)
y0 = sp.Symbol("y_0", positive=True)
K, Ti, Td = sp.symbols("K T_i T_d", positive=True)
c = sp.Symbol("c", nonnegative=True)
"""Stiffness of the linear model, 1/(2 sqrt(y0)) >= 0: infinite at y0 = 0, tending to 0 for large y0."""
g = sp.Symbol("g", real=True)
"""Relative slope of the integral gain: d ln(K/Ti)/dy at y0."""


@cache
def acceleration() -> Expr:
    """y'' as a function of y, v = y' and u; y >= 0."""
    return -v - sp.sqrt(y) + u


@cache
def static_output() -> Expr:
    """The steady output for a constant input u >= 0; for u < 0 there is none.

    >>> static_output()
    u**2
    """
    root = sp.Symbol("root", nonnegative=True)
    return solved_for(root, acceleration().subs(v, 0).subs(sp.sqrt(y), root)) ** 2


@cache
def static_input() -> Expr:
    """The input that holds the output y0.

    >>> static_input()
    sqrt(y_0)
    """
    return solved_for(u, acceleration().subs({v: 0, y: y0}))


@cache
def stiffness() -> Expr:
    """c = -d y''/dy at y0.

    >>> stiffness()
    1/(2*sqrt(y_0))
    """
    return -acceleration().diff(y).subs(y, y0)


@cache
def linear_model(at: Expr = c) -> Expr:
    """Transfer function from u to y near a steady state: 1/(s^2 + s + c).

    >>> linear_model()
    1/(c + s**2 + s)
    """
    damping = -acceleration().diff(v)
    return acceleration().diff(u) / (s**2 + damping * s + at)


@cache
def static_gain() -> Expr:
    """dy/du at y0, which is the slope of the static characteristic too.

    >>> static_gain()
    2*sqrt(y_0)
    """
    return linear_model(stiffness()).subs(s, 0)


@cache
def characteristic_fixed() -> Expr:
    """Characteristic polynomial of the linear loop with one fixed PID setting, ideal derivative."""
    return _characteristic(sp.Integer(0))


@cache
def characteristic_outside() -> Expr:
    """The same with scheduled settings, the integral gain outside the integral: g and u0 enter.

    With g = 0 it is that of fixed settings.
    """
    return _characteristic(g * static_input())


def _characteristic(extra: Expr) -> Expr:
    """s^3 + (1 + K Td) s^2 + (c + K - extra) s + K/Ti.

    extra: what a change of y adds to u through the factor before the stored integral, u0 d ln(K/Ti)/dy.
    """
    output = sp.Symbol("Y")
    feedback = -K * (1 + Td * s + 1 / (Ti * s)) * output + extra * output
    numerator = sp.numer(sp.together(output / linear_model() - feedback))
    polynomial = sp.Poly(sp.expand(numerator / output), s)
    return sp.collect(sp.expand(polynomial.as_expr() / polynomial.LC()), s)


def parabola(points: list[tuple[Expr, Expr]], at: sp.Symbol = y) -> Expr:
    """The parabola through three points, exact.

    >>> parabola([(0, 0), (1, 1), (2, 4)])
    y**2
    """
    return sp.expand(sp.interpolate(points, at))


@cache
def derivative_kick() -> Expr:
    """Jump of y' when the error jumps by one and the derivative acts on the error: the area of K Td delta(t).

    >>> derivative_kick()
    K*T_d
    """
    return sp.limit(s * (K * Td * s / s) * linear_model() * s, s, sp.oo)
