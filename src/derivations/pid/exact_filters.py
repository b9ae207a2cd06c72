"""The filter and the filtered derivative without approximation, and what the backward difference costs.

Between two samples the linear law T_f x' = -x + input is solved exactly: for an input that is held (zero-order hold)
or that runs in a straight line (first-order hold). Compared with pid-report, equations 4.9 and 4.13.
"""

from functools import cache

from sympy import Add, Eq, Expr, Function, Symbol, diff, exp, log, simplify, symbols

from derivations.algebra.differences import at, by_signals, h, t
from derivations.algebra.equality import equality
from derivations.algebra.rational import vanishes
from derivations.pid.pid_laws import K, Td
from derivations.pid.rc_filter import Tf, filter_law

_start, _from, _to = symbols("start from to")


def _after_one_sample(source: Expr) -> Expr:
    """x(h) of T_f x' = -x + source(t), x(0) = start, for a source that is linear in t.

    The solution is source - T_f source', which the filter follows, and what is left of the start, decaying.
    Raises ArithmeticError where that is no solution.
    """
    followed = source - Tf * source.diff(t)
    solution = followed + (_start - followed.subs(t, 0)) * exp(-t / Tf)
    law = filter_law("x", "w")
    if not vanishes((law.lhs - law.rhs).subs({Function("w")(t): source, Function("x")(t): solution}).doit()):
        raise ArithmeticError(f"the source {source} is not linear in {t}")
    return solution.subs(t, h)


def _samples(expr: Expr, state: str, held: str) -> Expr:
    named = expr.subs({_start: at(state, -1), _from: at(held, -1), _to: at(held)})
    return Add(*(simplify(gain) * sample for sample, gain in by_signals(named).items()))


@cache
def low_pass_held() -> Eq:
    """y_f(t_k) = a y_f(t_{k-1}) + (1 - a) y(t_{k-1}), a = exp(-h / T_f): exact where y is held from t_{k-1} on.

    It knows y(t_k) only at the next sample; the printed form uses y(t_k) at once.
    """
    return equality(at("y_f"), _samples(_after_one_sample(_from), "y_f", "y"))


@cache
def low_pass_current() -> Eq:
    """y_f(t_k) = a y_f(t_{k-1}) + (1 - a) y(t_k): the same pole with the newest measurement, the drop-in for 4.9."""
    return equality(at("y_f"), low_pass_held().rhs.subs(at("y", -1), at("y")))


@cache
def low_pass_line() -> Eq:
    """y_f exact for a y that runs straight from y(t_{k-1}) to y(t_k)."""
    return equality(at("y_f"), _samples(_after_one_sample(_from + (_to - _from) * t / h), "y_f", "y"))


@cache
def filtered_derivative_line() -> Eq:
    """D_f(t_k) = a D_f(t_{k-1}) - K T_d (1 - a) / h (y(t_k) - y(t_{k-1})): exact for a straight y.

    There y' is constant, so that D_f is the filter's answer to a held -K T_d y'.
    """
    slope = -K * Td * (_to - _from) / h
    expr = _after_one_sample(slope).subs(_start, at("D_f", -1)).subs({_from: at("y", -1), _to: at("y")})
    return equality(at("D_f"), Add(*(simplify(gain) * sample for sample, gain in by_signals(expr).items())))


@cache
def filtered_derivative_held() -> Eq:
    """D_f(t_k) = a D_f(t_{k-1}) - K T_d / T_f (y(t_k) - y(t_{k-1})): exact for a y that jumps at the samples.

    From D_f = -K T_d y_f' = -K T_d / T_f (y - y_f), with y_f held-exact and y_f eliminated.
    """
    yf_old = Symbol("yf_old")
    d_old = -K * Td / Tf * (at("y", -1) - yf_old)
    yf_new = low_pass_held().rhs.subs(at("y_f", -1), yf_old)
    d_new = -K * Td / Tf * (at("y") - yf_new)
    gain_old = simplify(diff(d_new, yf_old) / diff(d_old, yf_old))
    rest = simplify(d_new - gain_old * d_old)
    terms = (simplify(gain) * sample for sample, gain in by_signals(rest).items())
    return equality(at("D_f"), Add(gain_old * at("D_f", -1), *terms))


@cache
def backward_time_constant() -> Expr:
    """The continuous time constant that the backward filter really has: h / log(1 + h / T_f) > T_f."""
    return simplify(h / log(1 / (Tf / (Tf + h))))
