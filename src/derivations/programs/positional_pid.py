"""The discrete PID law with a sum and a difference quotient, its incremental form, and how to start it without a bump.

    u(i) = Kp (e(i) + h/Ti sum(e(0) ... e(i)) + Td (e(i) - e(i-1))/h)

The sum is the rectangle rule with the height at the right end of each interval, the quotient the backward difference.
"""

from functools import cache

import sympy as sp
from sympy import Expr

from derivations.algebra.rational import solved_for

h, Kp, Ti, Td = sp.symbols("h Kp Ti Td", positive=True)
e, last, older, total, manual = sp.symbols("e last older total manual", real=True)
"""e(i), e(i-1), e(i-2) and the sum up to and including e(i); manual: the control signal in force before automatic."""
z, s = sp.symbols("z s")
NAMES = {
    Kp: "K_p",
    Ti: "T_i",
    Td: "T_d",
    e: "e_i",
    last: "e_{i-1}",
    older: "e_{i-2}",
    total: r"\Sigma e",
    manual: "u_m",
}
"""How the symbols are written in LaTeX; their own names are those of a program."""


@cache
def terms() -> dict[str, Expr]:
    """P, I and D from the continuous law by the rectangle rule and the backward difference.

    >>> terms()["I"]
    Kp*h*total/Ti
    """
    rectangle = h * total
    backward = (e - last) / h
    return {"P": Kp * e, "I": Kp * rectangle / Ti, "D": Kp * Td * backward}


@cache
def law() -> Expr:
    """u(i) as a function of e(i), e(i-1) and the sum up to e(i)."""
    return sum(terms().values())


@cache
def transfer() -> Expr:
    """U(z)/E(z): the integral 1/s became h z/(z - 1), the derivative s became (z - 1)/(h z)."""
    substituted = law().subs({total: e * z / (z - 1), last: e / z})
    return sp.together(substituted / e)


@cache
def increment() -> Expr:
    """u(i) - u(i-1): the velocity form, free of the sum.

    >>> sorted(increment().free_symbols, key=str)
    [Kp, Td, Ti, e, h, last, older]
    """
    before = law().subs({total: total - e, e: last, last: older}, simultaneous=True)
    return sp.expand(law() - before)


@cache
def bumpless_total() -> Expr:
    """The sum to store before the first automatic sample so that u(0) equals the manual signal, whatever e is.

    The program adds e(0) to the stored sum first and skips the D term at the first sample.

    >>> bumpless_total()
    (-Kp*Ti*e - Kp*e*h + Ti*manual)/(Kp*h)
    """
    stored = sp.Symbol("stored", real=True)
    first = (terms()["P"] + terms()["I"]).subs(total, stored + e)
    return solved_for(stored, first, manual)
