"""Two lags and a dead time from a step response and one point of the frequency response.

    G(s) = K_p e^(-L_1 s) / ((1 + s T_1)(1 + s T_2)),   T_2 = alpha T_1,   0 <= alpha <= 1

must have the gain 1/K_u and the phase -180 degrees at omega, and its step response must reach 63 % at T_63
(pid-report, section 5.2.7). Gain and phase can be solved: T_1 from the gain, L_1 from the phase. What is left is one
equation in alpha, `residuals().e1`; the other two residuals vanish identically (`gain_residual_vanishes`).
"""

from dataclasses import dataclass
from functools import cache

import sympy
from sympy import Expr, Rational, Symbol, atan, exp, pi, sqrt, symbols

alpha, omega, K_p, K_u, T_63 = symbols("alpha omega_180 K_p K_u T_63", positive=True)
T_1, T_2, L_1, t = symbols("T_1 T_2 L_1 t", positive=True)
PRINTED_TAIL = Rational(37, 100)
TAIL = exp(-1)


@dataclass(frozen=True)
class Residuals:
    """The three equations of the section in the form "must be zero"; e1 also where both lags are equal."""

    e1: Expr
    e1_equal: Expr
    e2: Expr
    e3: Expr


@cache
def unfinished() -> Expr:
    """What a unit step response still lacks a time t after the dead time: the sum of the modes of both lags.

    >>> unfinished().subs(t, 0).simplify()
    1
    """
    s = Symbol("s")
    step = 1 / (s * (1 + s * T_1) * (1 + s * T_2))
    residues = [sympy.cancel(step * (s + 1 / T)).subs(s, -1 / T) * exp(-t / T) for T in (T_1, T_2)]
    return -sum(sympy.factor(r) for r in residues)


@cache
def unfinished_equal() -> Expr:
    """The same for two equal lags: the limit T_2 -> T_1.

    >>> unfinished_equal()
    (T_1 + t)*exp(-t/T_1)/T_1
    """
    top, bottom = sympy.fraction(sympy.together(unfinished()))  # both vanish at T_2 = T_1: l'Hospital
    return sympy.factor((top.diff(T_2) / bottom.diff(T_2)).subs(T_2, T_1))


@cache
def first_lag() -> Expr:
    """T_1 that gives the process the gain 1/K_u at omega, for T_2 = alpha T_1.

    (1 + x)(1 + alpha^2 x) = (K_p K_u)^2 is quadratic in x = (omega T_1)^2; its positive root, for K_p K_u > 1:

    >>> first_lag().subs({alpha: 1, K_p: 1, K_u: 2, omega: 1})
    1
    """
    x = Symbol("x")
    roots = sympy.roots((1 + x) * (1 + alpha**2 * x) - (K_p * K_u) ** 2, x)
    at = {alpha: Rational(1, 2), K_p: 1, K_u: 10}
    (root,) = [r for r in roots if r.subs(at) > 0]
    under = sympy.factor(sympy.expand(2 * alpha**2 * root))
    return sqrt(under) / (alpha * omega * sqrt(2))


@cache
def first_lag_without_cancellation() -> Expr:
    """The same T_1 with numerator and denominator multiplied by the root's conjugate.

    The form of `first_lag` subtracts nearly equal numbers for small alpha and divides by alpha; this one has its limit
    at alpha = 0, sqrt((K_p K_u)^2 - 1)/omega.

    >>> first_lag_without_cancellation().subs({alpha: 0, K_p: 1, K_u: 2, omega: 1})
    sqrt(3)
    """
    under = sympy.expand((first_lag() * alpha * omega) ** 2 * 2)  # inner - (1 + alpha^2)
    inner = under + 1 + alpha**2
    conjugate = inner + 1 + alpha**2
    product = sympy.factor(sympy.expand(under * conjugate))  # 4 alpha^2 ((K_p K_u)^2 - 1)
    return sqrt(sympy.cancel(product / (2 * alpha**2)) / conjugate) / omega


@cache
def dead_time() -> Expr:
    """L_1 that gives the process the phase -180 degrees at omega.

    >>> dead_time()
    (-atan(T_1*omega_180) - atan(T_2*omega_180) + pi)/omega_180
    """
    return (pi - atan(omega * T_1) - atan(omega * T_2)) / omega


@cache
def residuals(tail: Expr = TAIL) -> Residuals:
    """The residuals as functions of T_1, T_2 and L_1. tail: what is unfinished at T_63, e^-1 or the printed 0.37."""
    waited = T_63 - L_1
    return Residuals(
        e1=tail - unfinished().subs(t, waited),
        e1_equal=tail - unfinished_equal().subs(t, waited),
        e2=(1 + omega**2 * T_1**2) * (1 + omega**2 * T_2**2) - (K_p * K_u) ** 2,
        e3=atan(omega * T_1) + atan(omega * T_2) + omega * L_1 - pi,
    )


@cache
def gain_residual_vanishes() -> Expr:
    """e2 with T_1 and T_2 as solved; it is zero for every alpha.

    >>> gain_residual_vanishes()
    0
    """
    return sympy.simplify(sympy.expand(residuals().e2.subs(T_2, alpha * T_1).subs(T_1, first_lag())))


@cache
def phase_residual_vanishes() -> Expr:
    """e3 with L_1 as solved; it is zero for every T_1 and T_2.

    >>> phase_residual_vanishes()
    0
    """
    return sympy.expand(residuals().e3.subs(L_1, dead_time()))
