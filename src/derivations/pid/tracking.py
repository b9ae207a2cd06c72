"""What tracking does to the integral: its recursion in saturation, in manual mode and after one bad sample.

Source: pid-report, sections 4.2.3 and 4.2.5. The recursion is eq. 4.5 with v = P + I + D.
"""

from functools import cache

from sympy import Expr, factor, sqrt, symbols

from derivations.algebra.differences import at, by_signals
from derivations.algebra.rational import solved_for
from derivations.pid import pid_updates as term
from derivations.pid.pid_laws import Td, Ti

rest, imposed, error, spike = symbols("r u_out e s", real=True)  # r = P + D


@cache
def recursion() -> Expr:
    """I(t_{k+1}) while the output is ``u_out``, whatever v asks for, with P + D = r and error e."""
    update = term.integral_tracking().full().rhs
    state = at("I")
    return update.subs({at("v"): state + rest, at("u"): imposed, at("y_sp"): error + at("y")}).expand()


@cache
def pole() -> Expr:
    """Factor of I per sample in saturation or in manual: 1 - h / T_t. It must lie between -1 and 1: h < 2 T_t."""
    return by_signals(recursion())[at("I")].expand()


@cache
def settled() -> Expr:
    """I where its recursion comes to rest, for a constant error and a constant P + D = r."""
    return solved_for(at("I"), at("I"), recursion()).expand()


@cache
def bump() -> Expr:
    """v - u_out that tracking settles at for a constant error: K T_t / T_i e. Zero only for e = 0."""
    return factor(settled() + rest - imposed)


@cache
def spike_effect() -> Expr:
    """Change of I by one sample whose v lies s above the limit: -h s / T_t. With T_t = h all of it."""
    update = term.integral_tracking().full().rhs
    quiet = update.subs(at("u"), at("v"))
    return factor((update - quiet).subs(at("v"), at("u") + spike))


def rule(derivative_time: Expr = Td, integral_time: Expr = Ti) -> Expr:
    """T_t = sqrt(T_i T_d) for PID (section 4.2.3): between T_d and T_i where T_d < T_i."""
    return sqrt(integral_time * derivative_time)
