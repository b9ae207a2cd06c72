"""Two perfectly mixed tanks with a pipe between them: the model from the heat balances.

A tank of volume V, through which Q flows, with inlet temperature T_in and heating power u:

    rho c V dT/dt = rho c Q (T_in - T) + u

The pipe moves the temperature on unchanged and V_r/Q later. Deviations from a steady state; s is the Laplace variable.
"""

from functools import cache

import sympy as sp

from derivations.algebra.rational import solved_for

s, t = sp.Symbol("s"), sp.Symbol("t")
Q, c, rho = sp.symbols("Q c rho", positive=True)
V1, Vr, V2 = sp.symbols("V_1 V_r V_2", positive=True)
U, V = sp.symbols("U V")


def balance(volume: sp.Expr) -> sp.Eq:
    """What a mixed tank stores is what flows in, less what flows out, and what is heated [W].

    >>> balance(V1)
    Eq(V_1*c*rho*Derivative(T(t), t), Q*c*rho*(-T(t) + T_in(t)) + u(t))
    """
    T, T_in, u = (sp.Function(name)(t) for name in ("T", "T_in", "u"))
    return sp.Eq(rho * c * volume * T.diff(t), rho * c * Q * (T_in - T) + u)


def transformed(law: sp.Eq) -> sp.Eq:
    """A linear law after Laplace's transform, from rest: a derivative is a factor s, x(t) the symbol x.

    >>> transformed(balance(V1))
    Eq(T*V_1*c*rho*s, Q*c*rho*(-T + T_in) + u)
    """
    signals = law.atoms(sp.core.function.AppliedUndef)
    slopes = {x.diff(t): s * sp.Symbol(x.func.__name__) for x in signals}
    return law.subs(slopes).subs({x: sp.Symbol(x.func.__name__) for x in signals})


def mixed_tank(volume: sp.Expr, inlet: sp.Expr, power: sp.Expr = sp.S.Zero) -> sp.Expr:
    """The tank's temperature for a given inlet temperature and heating power, all Laplace transforms.

    >>> sp.simplify(mixed_tank(V2, V) - V / (V2 / Q * s + 1))
    0
    """
    T, T_in, u = sp.symbols("T T_in u")
    law = transformed(balance(volume)).subs({T_in: inlet, u: power})
    return solved_for(T, law.lhs, law.rhs)


def pipe(inlet: sp.Expr) -> sp.Expr:
    """The temperature at the end of the pipe."""
    return inlet * sp.exp(-Vr / Q * s)


@cache
def outlet() -> sp.Expr:
    """Y(s) from the heating power U(s) in the first tank and the inlet temperature V(s)."""
    return mixed_tank(V2, pipe(mixed_tank(V1, V, U)))


w = sp.Symbol("omega", positive=True)


@cache
def gain_and_phase(source: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """|G(j w)| and the argument of G(j w) [rad] on the path from U or V; each lag adds its own angle, the pipe V_r w/Q.

    >>> gain, phase = gain_and_phase(V)
    >>> phase
    -atan(V_1*omega/Q) - atan(V_2*omega/Q) - V_r*omega/Q
    """
    lags = [1 + s * volume / Q for volume in (V1, V2)]
    parts = [lag.subs(s, sp.I * w).as_real_imag() for lag in lags]
    gain = path(source).subs(s, 0) / sp.Mul(*(sp.sqrt(re**2 + im**2) for re, im in parts))
    return gain, -Vr / Q * w - sp.Add(*(sp.atan(im / re) for re, im in parts))


@cache
def path(source: sp.Symbol) -> sp.Expr:
    """The transfer function from U or V to Y.

    >>> path(U).subs(s, 0)
    1/(Q*c*rho)
    >>> path(V).subs(s, 0)
    1
    """
    return sp.factor(sp.expand(outlet()).coeff(source))
