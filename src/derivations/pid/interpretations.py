"""What T_i and T_d mean: a step of the error doubles the P step after T_i; D looks T_d ahead along the tangent.

Also the secant that becomes a tangent. Source: pid-report, sections 3.2.2, 3.3.1 and 3.3.2.
"""

from functools import cache

from sympy import Eq, Expr, Function, Symbol, limit, solve, symbols

from derivations.algebra.differences import t
from derivations.pid.pid_laws import K, Td, b, e, pi_law, y, ysp

step = Symbol("De", real=True)
horizon = Symbol("horizon", positive=True)
distance, x = symbols("h x", real=True)


@cache
def pi_on_error() -> Expr:
    """The PI law in terms of the error, b = 1: K e + K / T_i times the integral of e."""
    return pi_law().subs(b, 1).subs(ysp(t), e(t) + y(t))


@cache
def pi_step() -> Expr:
    """Change of the PI output at time t after a step De of the error at t = 0: K (1 + t / T_i) De."""
    return pi_on_error().replace(lambda part: part.func == Function("e"), lambda part: step).doit().factor()


@cache
def doubling_time() -> Expr:
    """The time at which the PI step response is twice the P step: T_i."""
    return solve(Eq(pi_step(), 2 * K * step), t)[0]


def prediction(signal: Expr) -> Expr:
    """The tangent T_d ahead: e(t) + T_d e'(t), for a signal given as an expression in t."""
    return signal + Td * signal.diff(t)


def prediction_error(signal: Expr) -> Expr:
    """e(t + T_d) minus the prediction: zero for straight lines, T_d^2 e'' / 2 for a parabola."""
    return (signal.subs(t, t + Td) - prediction(signal)).expand()


def secant(function: Expr) -> Expr:
    """(f(x + h) - f(x)) / h for an expression in x."""
    return (function.subs(x, x + distance) - function) / distance


def tangent(function: Expr) -> Expr:
    """The limit of the secant's slope for h -> 0."""
    return limit(secant(function), distance, 0)
