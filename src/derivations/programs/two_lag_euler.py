"""k/((1 + s T1)(1 + s T2)) as two first-order differential equations, and Euler's step for them.

x1 is the output, x2 its rate. Euler's method replaces x' by (x(i+1) - x(i))/h; it is stable only for a step h that is
short against the time constants, and it is not the exact sampled model.
"""

from functools import cache

import sympy as sp
from sympy import Expr

s = sp.Symbol("s")
k, T1, T2, h = sp.symbols("k T1 T2 h", positive=True)
x1, x2, u = sp.symbols("x1 x2 u", real=True)


@cache
def state_equations() -> dict[sp.Symbol, Expr]:
    """x1' and x2' from the transfer function: (1 + s T1)(1 + s T2) Y = k U with Y = x1, s Y = x2.

    >>> state_equations()[x1]
    x2
    """
    denominator = sp.Poly(sp.expand((1 + s * T1) * (1 + s * T2)), s)
    a2, a1, a0 = denominator.all_coeffs()
    rate = (k * u - a1 * x2 - a0 * x1) / a2
    return {x1: x2, x2: sp.expand(rate)}


@cache
def transfer() -> Expr:
    """The way back, from the state equations to Y/U."""
    U = sp.Symbol("U")
    X = sp.symbols("X1 X2")
    laplace = {x1: X[0], x2: X[1], u: U}
    equations = [sp.Eq(s * big, state_equations()[small].subs(laplace)) for big, small in zip(X, (x1, x2), strict=True)]
    return sp.factor(sp.solve(equations, X)[X[0]] / U)


@cache
def euler_step() -> dict[sp.Symbol, Expr]:
    """The state one step later.

    >>> euler_step()[x1]
    h*x2 + x1
    """
    return {x: x + h * rate for x, rate in state_equations().items()}


@cache
def longest_step() -> Expr:
    """The step at which Euler's method for the slower-decaying mode stops converging: |1 - h/T| = 1 for the shorter T.

    >>> longest_step()
    2*Min(T1, T2)
    """
    T = sp.Symbol("T", positive=True)
    (limit,) = [x for x in sp.solve(sp.Eq((1 - h / T) ** 2, 1), h) if x != 0]
    return 2 * sp.Min(T1, T2) if limit == 2 * T else sp.nan
