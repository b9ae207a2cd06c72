"""The continuous laws of a PID controller, term by term, as equations in functions of t.

Source: pid-report, sections 3.2.2, 3.2.3, 3.3.2 and 4.2.
"""

from functools import cache

from sympy import Derivative, Eq, Expr, Function, Integral, Symbol, symbols

from derivations.algebra.differences import t
from derivations.algebra.equality import both_sides, equality
from derivations.pid.rc_filter import filter_law

K = Symbol("K", real=True)
b, c = symbols("b c", nonnegative=True)
Ti, Td, Tt = symbols("T_i T_d T_t", positive=True)
tau = Symbol("tau", real=True)
y, ysp, yf, e, u, v, P, I, D, Df = (Function(n) for n in ("y", "y_sp", "y_f", "e", "u", "v", "P", "I", "D", "D_f"))


def error() -> Expr:
    """e = y_sp - y."""
    return ysp(t) - y(t)


def proportional() -> Eq:
    """P = K (b y_sp - y)."""
    return equality(P(t), K * (b * ysp(t) - y(t)))


def integral() -> Eq:
    """I = K / T_i times the integral of e from 0 to t."""
    return equality(I(t), K / Ti * Integral(e(tau), (tau, 0, t)))


def integral_tracking() -> Eq:
    """The same plus 1 / T_t times the integral of u - v, the part of the output that the limits cut away."""
    return equality(I(t), integral().rhs + Integral(u(tau) - v(tau), (tau, 0, t)) / Tt)


def derivative() -> Eq:
    """D = -K T_d y_f': derivative of the filtered measurement."""
    return equality(D(t), -K * Td * Derivative(yf(t), t))


def raw_derivative() -> Eq:
    """D = -K T_d y': the same without filter."""
    return both_sides(lambda side: side.subs(yf(t), y(t)), derivative())


def derivative_on_error() -> Eq:
    """D = K T_d e': derivative of the error, without filter (figure 4.7)."""
    return equality(D(t), K * Td * Derivative(e(t), t))


@cache
def filtered_derivative() -> Eq:
    """T_f D_f' = -D_f - K T_d y': the filter applied to D instead of to y."""
    return both_sides(lambda side: side.subs(D(t), raw_derivative().rhs), filter_law("D_f", "D"))


@cache
def rate(law: Eq) -> Eq:
    """Both sides differentiated with respect to t: an integral law becomes a differential equation."""
    return equality(law.lhs.diff(t), law.rhs.diff(t).doit())


def pi_law() -> Expr:
    """u = K (b y_sp - y) + K / T_i times the integral of e."""
    return proportional().rhs + integral().rhs


def pid_law() -> Expr:
    """u = P + I + D with the derivative on the filtered measurement."""
    return pi_law() + derivative().rhs
