"""Where proportional control comes to rest, and what its set-point weight cannot change.

Source: pid-report, sections 3.1 and 3.2.3: u = K (y_sp - y) + u_b.
"""

from functools import cache

from sympy import Expr, Symbol, expand, limit, oo, roots, symbols

from derivations.algebra.rational import factored, solved_for
from derivations.pid.pid_laws import K, b

y, ysp, u_b, load, speed_0, u_0 = symbols("y y_sp u_b d v_0 u_0", real=True)
gain = Symbol("G", positive=True)
process, integral_action = symbols("G_s R", real=True)  # any process, any integral part


def output(measured: Expr = y, wanted: Expr = ysp) -> Expr:
    """u = K (y_sp - y) + u_b."""
    return K * (wanted - measured) + u_b


@cache
def rest_linear() -> Expr:
    """y at rest for a process y = G u + d: (G K y_sp + G u_b + d) / (1 + G K)."""
    return solved_for(y, y, gain * output() + load)


@cache
def error_linear() -> Expr:
    """y_sp - y at rest; it tends to 0 for K -> oo and is 0 for one u_b only."""
    return factored(ysp - rest_linear())


@cache
def error_at_infinite_gain() -> Expr:
    positive = Symbol("K", positive=True)
    return limit(error_linear().subs(K, positive), positive, oo)


@cache
def offset_needed() -> Expr:
    """The u_b that makes the error zero: it depends on the set-point and the load."""
    return solved_for(u_b, error_linear())


@cache
def rest_drag() -> Expr:
    """The positive y at rest where the drag grows with the square: u = u_0 (y / v_0)^2."""
    both = roots(expand(u_0 * (y / speed_0) ** 2 - output()), y)
    at = dict.fromkeys((K, u_0, speed_0, ysp, u_b), 1)
    (positive,) = [root for root in both if root.subs(at) > 0]
    return factored(positive)


def weighted_output(setpoint: Expr = ysp) -> Expr:
    """u = K (b y_sp - y) + R (y_sp - y): the weight stands in P only."""
    return K * (b * setpoint - y) + integral_action * (setpoint - y)


def _loop(setpoint: Expr, disturbance: Expr) -> Expr:
    """y of the loop y = G (u + d) with `weighted_output`."""
    return solved_for(y, y, process * (weighted_output(setpoint) + disturbance))


@cache
def setpoint_transfer() -> Expr:
    """y / y_sp with set-point weight b."""
    return _loop(ysp, 0) / ysp


@cache
def load_transfer() -> Expr:
    """y / d with set-point weight b: b is not in it."""
    return _loop(0, load) / load
