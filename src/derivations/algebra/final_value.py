"""The steady-state error of a loop by the final value theorem.

    e(t -> oo) = lim s E(s) for s -> 0,    E(s) = W(s)/(1 + R(s) O(s))

The theorem holds only where s E(s) has all its poles in the open left half-plane; `steady_state_error` returns the
limit, stability is checked with `derivations.loop.routh`.
"""

from functools import cache

import sympy as sp
from sympy import Expr

from derivations.algebra.rational import solved_for

s = sp.Symbol("s")
k, T, Kp, Ti = sp.symbols("k T K_p T_i", positive=True)

STEP = 1 / s
RAMP = 1 / s**2


def error_transfer(regulator: Expr, plant: Expr) -> Expr:
    """E(s)/W(s) = 1/(1 + R O), from e = w - y and y = O R e.

    >>> error_transfer(Kp, k / (1 + s * T))
    (T*s + 1)/(K_p*k + T*s + 1)
    """
    e, w = sp.symbols("E W")
    return sp.factor(solved_for(e, e, w - plant * regulator * e) / w)


def steady_state_error(regulator: Expr, plant: Expr, setpoint: Expr = STEP) -> Expr:
    """The limit of s E(s) at s = 0; infinite where the error grows without bound.

    regulator, plant: transfer functions in `s`. setpoint: the transform of w(t), default the unit step.
    The limit is the error only if the loop is stable.

    >>> steady_state_error(Kp, k / (1 + s * T))
    1/(K_p*k + 1)
    >>> steady_state_error(Kp * (1 + 1 / (s * Ti)), k / (1 + s * T))
    0
    """
    return sp.limit(sp.together(s * setpoint * error_transfer(regulator, plant)), s, 0, "+")


def load_error(regulator: Expr, plant: Expr, load: Expr = STEP) -> Expr:
    """The same for a disturbance added at the plant's input: the error it leaves, -lim s O/(1 + R O) D.

    >>> load_error(Kp, k / (1 + s * T))
    -k/(K_p*k + 1)
    """
    return sp.factor(sp.limit(sp.together(-s * load * plant * error_transfer(regulator, plant)), s, 0, "+"))


@cache
def gain_for_error() -> Expr:
    """The proportional gain that leaves the part e of a set-point step on a static gain k: finite for every e > 0.

    >>> sp.expand(gain_for_error())
    -1/k + 1/(e*k)
    """
    e = sp.Symbol("e", positive=True)
    return solved_for(Kp, e, steady_state_error(Kp, k))
