"""The discrete terms of the PID controller: each a continuous law under a difference, with its gains named.

Source: pid-report, equations 4.1 to 4.13. The names of the gains are those of the printed equations.
"""

from dataclasses import dataclass
from functools import cache

from sympy import Eq, Expr, Max, Min, Piecewise, Symbol, collect, symbols

from derivations.algebra.differences import BACKWARD, FORWARD, TUSTIN, at, discretise, name_gains, update
from derivations.algebra.equality import both_sides, equality
from derivations.pid import pid_laws as law
from derivations.pid.rc_filter import filter_law

p1, p3, p4, p5, p24 = symbols("p_1 p_3 p_4 p_5 p_24")
u_low, u_high = symbols("u_low u_high", real=True)


@dataclass(frozen=True)
class UpdateLaw:
    """One discrete term: gains (computed when a setting changes) and the equation that runs at each sample."""

    gains: dict[Symbol, Expr]
    equation: Eq

    def full(self) -> Eq:
        """The equation with its gains written out."""
        return both_sides(lambda side: side.subs(self.gains), self.equation)


@cache
def proportional() -> UpdateLaw:
    """P(t_k) = K (b y_sp(t_k) - y(t_k)), eq. 4.1: no dynamics, so sampling is all there is."""
    return UpdateLaw({}, discretise(law.proportional(), BACKWARD))


def saturated(value: Expr, low: Expr = u_low, high: Expr = u_high) -> Expr:
    """``value`` kept within [low, high], eq. 4.2 (low <= high)."""
    return Min(high, Max(low, value))


def saturated_by_cases(value: Expr, low: Expr = u_low, high: Expr = u_high) -> Expr:
    """The three cases of section 4.2.3, written out."""
    return Piecewise((high, value > high), (low, value < low), (value, True))


@cache
def sampled_error() -> Expr:
    """e(t_k) = y_sp(t_k) - y(t_k)."""
    return discretise(equality(at("e"), law.error()), BACKWARD).rhs


@cache
def integral() -> Eq:
    """I(t_{k+1}) = I(t_k) + K h / T_i e(t_k): forward difference, section 4.2.2."""
    return update(law.rate(law.integral()), "I", FORWARD)


@cache
def integral_tracking() -> UpdateLaw:
    """Eqs 4.3 to 4.5: forward difference of the integral with tracking, e written as y_sp - y."""
    raw = update(law.rate(law.integral_tracking()), "I", FORWARD)
    gains, short = name_gains(raw, {p3: at("e"), p4: at("u")})
    return UpdateLaw(gains, equality(short.lhs, collect(short.rhs.subs(at("e"), sampled_error()), list(gains))))


@cache
def derivative() -> UpdateLaw:
    """Eqs 4.6 and 4.7: backward difference of D = -K T_d y_f'."""
    raw = update(law.derivative(), "D", BACKWARD)
    gains, short = name_gains(raw, {p5: at("y_f")})
    return UpdateLaw(gains, short)


@cache
def low_pass() -> UpdateLaw:
    """Eqs 4.8 and 4.9: backward difference of T_f y_f' = -y_f + y."""
    raw = update(filter_law(), "y_f", BACKWARD)
    gains, short = name_gains(raw, {p1: at("y_f", -1)})
    return UpdateLaw(gains, short)


@cache
def filtered_derivative() -> UpdateLaw:
    """Eqs 4.11 to 4.13: backward difference of T_f D_f' = -D_f - K T_d y'."""
    raw = update(law.filtered_derivative(), "D_f", BACKWARD)
    gains, short = name_gains(raw, {p3: at("D_f", -1), p24: at("y", -1)})
    return UpdateLaw(gains, equality(short.lhs, short.rhs.expand()))


@cache
def derivative_tustin() -> Eq:
    """D(t_k) = -D(t_{k-1}) - 2 K T_d / h (y_f(t_k) - y_f(t_{k-1})): a pole at -1, it rings for ever."""
    return update(law.derivative(), "D", TUSTIN)


@cache
def low_pass_tustin() -> Eq:
    """y_f by the trapezoidal rule; its pole (2 T_f - h) / (2 T_f + h) is negative for h > 2 T_f."""
    return update(filter_law(), "y_f", TUSTIN)


@cache
def filtered_derivative_tustin() -> Eq:
    """D_f by the trapezoidal rule, same pole as the filter's."""
    return update(law.filtered_derivative(), "D_f", TUSTIN)
