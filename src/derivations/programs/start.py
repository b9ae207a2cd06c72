"""Start from rest: the states for which a controller that is switched on keeps the output that it finds.

At rest y, y_sp and u stand still. From x = p3 x + p4 (y - c y_sp) and u = p1 y_sp - p2 y + I + x:

    x = p4 (y - c y_sp)/(1 - p3)        I = u - p1 y_sp - x + p2 y - u_ff

The first has a shorter form, x = p24 (y - c y_sp), which needs no difference of nearly equal numbers; `gain_residual`
is the proof. A program that starts with I = x = 0 instead moves the actuator by the whole of I at its first sample.
"""

from functools import cache

from sympy import Expr, Symbol, collect, factor

from derivations.algebra.rational import factored, solved_for
from derivations.pid.pid_laws import c
from derivations.programs import pid_code as code

u0 = Symbol("u_0", real=True)
u_ff = Symbol("feedforward", real=True)


@cache
def law() -> Expr:
    """v with the feedforward signal added.

    >>> law()
    I + feedforward + p_1*y_sp - p_2*y + x
    """
    return code.weighted().assigned(code.v) + u_ff


@cache
def all_but_integral() -> Expr:
    """v without I."""
    return law() - code.I


@cache
def integral_from(output: Expr = u0) -> Expr:
    """The I for which v is this output.

    >>> integral_from()
    -feedforward - p_1*y_sp + p_2*y + u_0 - x
    """
    return solved_for(code.I, law(), output).expand()


@cache
def derivative_state() -> Expr:
    """x at rest, from its own update.

    >>> derivative_state()
    -p_4*(-c*y_sp + y)/(p_3 - 1)
    """
    return factor(solved_for(code.x, code.weighted().assigned(code.x), code.x))


@cache
def derivative_state_short() -> Expr:
    """The same with p_24, the derivative's gain: p_24 (y - c y_sp)."""
    return code.p24 * (code.y - c * code.ysp)


@cache
def gain_residual() -> Expr:
    """Long form minus short form, in the settings: zero."""
    gains = code.weighted().gain_values() | {code.p24: code.derivative_gain()}
    return factored((derivative_state() - derivative_state_short()).subs(gains))


@cache
def rest() -> dict[Symbol, Expr]:
    """x and I at rest in p_1, p_2, p_24, c, y, y_sp, feedforward and u_0."""
    x = derivative_state_short()
    return {code.x: x, code.I: collect(integral_from().subs(code.x, x), [code.y, code.ysp])}
