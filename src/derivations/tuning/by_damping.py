"""PI and PID by the poles of the loop: natural frequency omega_0 and damping ratio zeta, for processes without zeros.

    PI    b/(a_1 s + a_0)                s^2 + 2 zeta omega_0 s + omega_0^2
    PID   b/(a_2 s^2 + a_1 s + a_0)      (s + alpha omega_0)(s^2 + 2 zeta omega_0 s + omega_0^2)

The gains P, I, D of P + I/s + D s are solved from the coefficients of s. The process may integrate (a_0 = 0), oscillate
or be unstable.
"""

from functools import cache

import sympy as sp

s = sp.Symbol("s")
b = sp.Symbol("b", nonzero=True)
a_0, a_1, a_2 = sp.symbols("a_0 a_1 a_2", real=True)
omega_0, zeta, alpha = sp.symbols("omega_0 zeta alpha", positive=True)
P, I, D = sp.symbols("P I D", real=True)


def _solved(characteristic: sp.Expr, wanted: sp.Expr, unknowns: tuple[sp.Symbol, ...]) -> dict[sp.Symbol, sp.Expr]:
    """The gains that make the one polynomial a multiple of the other; its leading coefficient is given."""
    found = sp.Poly(sp.expand(characteristic), s)
    equations = (found - sp.Poly(sp.expand(found.LC() * wanted), s)).all_coeffs()
    (solution,) = sp.solve(equations, unknowns, dict=True)
    return {symbol: sp.factor(solution[symbol]) for symbol in unknowns}


@cache
def pi() -> dict[sp.Symbol, sp.Expr]:
    """P and I for a process of first order.

    >>> values = {b: 1, a_1: 1, a_0: 1, omega_0: 2, zeta: sp.Rational(7, 10)}
    >>> [gain.subs(values) for gain in (pi()[P], pi()[P] / pi()[I])]
    [9/5, 9/20]
    """
    characteristic = s * (a_1 * s + a_0) + b * (P * s + I)
    return _solved(characteristic, s**2 + 2 * zeta * omega_0 * s + omega_0**2, (P, I))


@cache
def pid() -> dict[sp.Symbol, sp.Expr]:
    """P, I and D for a process of second order.

    >>> pid()[I]
    a_2*alpha*omega_0**3/b
    """
    characteristic = s * (a_2 * s**2 + a_1 * s + a_0) + b * (D * s**2 + P * s + I)
    wanted = (s + alpha * omega_0) * (s**2 + 2 * zeta * omega_0 * s + omega_0**2)
    return _solved(characteristic, wanted, (P, I, D))
