"""The first-order low-pass filter: from a resistor and a capacitor to its law, its gain and the anti-alias choice.

Source: pid-report, section 4.1 (circuit of figure 4.4) and section 5.1 (16 times at half the sampling frequency).
"""

from functools import cache

from sympy import Eq, Expr, Function, I, Integer, Rational, Symbol, cancel, expand, pi, simplify, sqrt, symbols

from derivations.algebra.differences import h, t
from derivations.algebra.equality import both_sides, equality
from derivations.algebra.rational import solved_for

R, C, Tf, omega, attenuation = symbols("R C T_f omega a", positive=True)
V_in, V_out, current, V_R = (Function(name) for name in ("V_in", "V_out", "I", "V_R"))


@cache
def capacitor() -> Eq:
    """I = C V_out': the current charges the capacitor."""
    return equality(current(t), C * V_out(t).diff(t))


@cache
def resistor() -> Eq:
    """V_R = R I, Ohm's law."""
    return equality(V_R(t), R * current(t))


@cache
def around() -> Eq:
    """V_in - V_R - V_out = 0, Kirchhoff's voltage law."""
    return equality(V_in(t) - V_R(t) - V_out(t), Integer(0))


@cache
def circuit_law() -> Eq:
    """R C V_out' = V_in - V_out: the three laws with the current and the resistor's voltage eliminated."""
    slope = V_out(t).diff(t)
    left = around().lhs.subs(*resistor().args).subs(*capacitor().args)
    return equality(R * C * slope, expand(R * C * solved_for(slope, left)))


@cache
def filter_law(output: str = "y_f", source: str = "y") -> Eq:
    """T_f y_f' = -y_f + y: the circuit's law with T_f = R C and the names of a measured signal."""
    names = {V_out(t): Function(output)(t), V_in(t): Function(source)(t)}
    return both_sides(lambda side: side.subs(R, Tf / C).subs(names).doit(), circuit_law())


@cache
def transfer() -> Expr:
    """V_out / V_in at the angular frequency omega [rad/s], complex: 1 / (1 + i omega T_f)."""
    law = circuit_law().subs(R, Tf / C)
    phasor = Symbol("phasor")
    steady = law.subs(V_out(t).diff(t), I * omega * phasor).subs({V_out(t): phasor, V_in(t): 1})
    return 1 / expand(1 / solved_for(phasor, *steady.args))


@cache
def gain() -> Expr:
    """Amplitude ratio 1 / sqrt(1 + (omega T_f)^2)."""
    value = transfer()
    return sqrt(1 / expand(1 / (value * value.subs(I, -I))))


def _root(unknown: Symbol, power: Expr) -> Expr:
    """The positive T_f or omega for which the squared gain, which holds its square only, is ``power``."""
    square = Symbol("square", positive=True)
    return sqrt(cancel(solved_for(square, (gain() ** 2).subs(unknown**2, square), power)))


@cache
def cutoff() -> Expr:
    """The angular frequency [rad/s] at which the power is halved: 1 / T_f."""
    return _root(omega, Rational(1, 2))


@cache
def cutoff_hz() -> Expr:
    """The same in periods per second [Hz]: 1 / (2 pi T_f)."""
    return cutoff() / (2 * pi)


@cache
def time_constant_for(order: int = 1) -> Expr:
    """The time constant of each of ``order`` equal filters in series that attenuate ``a`` times at half the sampling
    frequency, that is at omega = pi / h."""
    return _root(Tf, attenuation ** Rational(-2, order)).subs(omega, pi / h)


@cache
def capacitor_current() -> Expr:
    """Amplitude of the current per volt of V_in; it grows with frequency: omega C / sqrt(1 + (omega R C)^2)."""
    return simplify((C * omega * gain()).subs(Tf, R * C))
