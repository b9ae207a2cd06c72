"""A PID controller given by angles at the crossover frequency, so that its phase there can be read off.

    C(s) = k w/s * (sin(f) s + w cos(f))/w * (sin(b) s + w cos(b))/(sin(a) s + w cos(a))

At s = j w a factor sin(x) s + w cos(x) is w (cos x + j sin x): its magnitude is w and its argument x. Hence

    |C(jw)| = k,        arg C(jw) = f + b - a - pi/2

and a wanted phase margin at a wanted crossover frequency w is two linear conditions. This is a third-order family in
which f and b are the two zeros' angles and a that of the filter's pole.
"""

from functools import cache

import sympy as sp
from sympy.simplify.fu import TR10i

from derivations.algebra.rational import solved_for, vanishes

s = sp.Symbol("s")
w, k = sp.symbols("omega k", positive=True)
f, b, a = sp.symbols("f b a", positive=True)
phase, margin = sp.symbols("phi_p phi_m", real=True)


def factor(angle: sp.Expr) -> sp.Expr:
    """sin(x) s + w cos(x), of magnitude w and argument x at s = j w.

    >>> sp.simplify(factor(f).subs(s, sp.I * w) - w * sp.exp(sp.I * f).rewrite(sp.cos))
    0
    """
    return sp.sin(angle) * s + w * sp.cos(angle)


@cache
def controller() -> sp.Expr:
    """C(s) by its angles."""
    return k * w / s * factor(f) / w * factor(b) / factor(a)


@cache
def lead() -> sp.Expr:
    """The angle b that gives the loop the phase margin phi_m, where the process has the phase phi_p at w [rad]."""
    return sp.expand(solved_for(b, phase + f + b - a - sp.pi / 2, -sp.pi + margin))


@cache
def parallel() -> dict[str, sp.Expr]:
    """P, I, D, N of P + I/s + D N s/(s + N): the partial fractions of C.

        N = -pole,   I = lim s C (s to 0),   -D N^2 = residue at the pole,   P N + I = coefficient of s in (s + N) s C

    >>> parallel()["N"]
    omega/tan(a)
    """
    N = w / sp.tan(a)
    with_pole = k * factor(f) * factor(b) / sp.sin(a)  # (s + N) s C
    pole = -w * sp.cos(a) / sp.sin(a)
    D = TR10i(sp.factor(-with_pole.subs(s, pole) / pole**3))  # sin a cos b - cos a sin b = sin(a - b)
    I = (controller() * s).subs(s, 0)
    P = k * (sp.sin(b + f) - sp.tan(a) * sp.cos(b) * sp.cos(f)) / sp.cos(a)
    rest = sp.expand_trig(with_pole.expand().coeff(s, 1) - I - P * N)
    if not vanishes(rest.subs(sp.tan(a), sp.sin(a) / sp.cos(a))):
        raise AssertionError("the coefficients of s do not agree")
    return {"P": P, "I": I, "D": D, "N": N}
