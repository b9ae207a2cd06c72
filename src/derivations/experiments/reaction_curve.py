"""What a step and a short pulse tell about a process: the formulas behind the graphical constructions.

Two models, both with a dead time L (pid-report, sections 5.2.1, 5.2.2 and 5.3.7.2):

    stable        K_p e^(-L s) / (1 + s T)
    integrating   K_v e^(-L s) / (s (1 + s T))

Time t counts from the step. All outputs are deviations from the level before it.
"""

from functools import cache

import sympy
from sympy import Expr, Symbol, exp, symbols

from derivations.algebra.rational import solved_for

K_p, K_v, T, L, t, width = symbols("K_p K_v T L t w", positive=True)
du = Symbol("Delta_u", nonzero=True)
dy = Symbol("Delta_y", nonzero=True)


@cache
def stable_step() -> Expr:
    """The output for t >= L after a step du of the input: K_p du (1 - e^(-(t-L)/T))."""
    return K_p * du * (1 - exp(-(t - L) / T))


@cache
def steepest_tangent() -> Expr:
    """The tangent where the first-order response is steepest: the instant at which it starts to move.

    >>> sympy.solve(steepest_tangent(), t)
    [L]
    """
    slope = sympy.diff(stable_step(), t).subs(t, L)
    return sympy.factor(slope * (t - L))


@cache
def fraction_at_T63() -> Expr:
    """The part of the way made at T_63 = L + T.

    >>> fraction_at_T63()
    1 - exp(-1)
    """
    return stable_step().subs(t, L + T) / (K_p * du)


@cache
def integrating_step() -> Expr:
    """The output of the integrating model for t >= L after a step du: the integral of the stable one with K_v."""
    since = Symbol("x", positive=True)
    return K_v * du * sympy.integrate(1 - exp(-since / T), (since, 0, t - L))


@cache
def final_tangent() -> Expr:
    """The line that the integrating model's response comes to follow.

    >>> sympy.solve(final_tangent(), t)
    [L + T]
    """
    return integrating_step().replace(exp, lambda _: sympy.S.Zero)  # they die out


@cache
def velocity_gain() -> Expr:
    """K_v from the tangent: it stands dy below the starting level at the instant of the step.

    dy is that distance (positive for a rising response), L the instant at which the tangent cuts the starting level.

    >>> velocity_gain()
    Delta_y/(Delta_u*L)
    """
    crossing = Symbol("L", positive=True)
    line = K_v * du * (t - crossing)
    return solved_for(K_v, -line.subs(t, 0), dy)


@cache
def velocity_gain_from_slope() -> Expr:
    """K_v from two points of the final tangent, Delta_y_tan apart in y and Delta_t_tan in time.

    >>> velocity_gain_from_slope()
    Delta_y_tan/(Delta_t_tan*Delta_u)
    """
    rise, run = symbols("Delta_y_tan Delta_t_tan", positive=True)
    slope = sympy.diff(final_tangent(), t)
    return solved_for(K_v, slope, rise / run)


@cache
def pulse_response() -> Expr:
    """The output of the integrating model after a pulse of width w and height 1/w, for t >= L + w.

    Two steps, w apart, each divided by w.
    """
    step = integrating_step().subs(du, 1)
    return sympy.simplify((step - step.subs(t, t - width)) / width)


@cache
def short_pulse_response() -> Expr:
    """Its limit for w -> 0: the step response of the stable model with K_p = K_v.

    >>> sympy.simplify(short_pulse_response() - stable_step().subs({K_p: K_v, du: 1}))
    0
    """
    return sympy.limit(pulse_response(), width, 0)
