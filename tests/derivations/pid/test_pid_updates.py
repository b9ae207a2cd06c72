"""The laws behind equations 4.1 to 4.13, Tustin and exact variants, the RC filter: second routes."""

import math
from fractions import Fraction

import pytest
from sympy import Function, Integral, N, Rational, exp, integrate, limit, oo, simplify, solve, sqrt, symbols
from sympy.physics.units import ampere, farad, ohm, second, volt
from sympy.physics.units.systems.si import dimsys_SI

from derivations.algebra.differences import at, by_signals, h, t
from derivations.pid import exact_filters as exact
from derivations.pid import pid_laws as law
from derivations.pid import pid_updates as term
from derivations.pid import rc_filter as rc
from derivations.pid.pid_laws import K, Td, Ti, Tt
from derivations.pid.rc_filter import Tf, omega

A = exp(-h / Tf)


def test_laws_in_words():
    """P 4.1, I 4.5, D 4.7: the continuous laws written once more by hand."""
    y, ysp, e, u, v, yf = (Function(n)(t) for n in ("y", "y_sp", "e", "u", "v", "y_f"))
    assert law.error() == ysp - y, "eq. 4.5"
    assert law.proportional().rhs == K * (law.b * ysp - y), "eq. 4.1"
    assert law.rate(law.integral()).rhs == K * e / Ti, "eqs 4.3 to 4.5"
    assert law.rate(law.integral_tracking()).rhs == K * e / Ti + (u - v) / Tt, "eqs 4.3 to 4.5"
    assert law.derivative().rhs == -K * Td * yf.diff(t), "eqs 4.6 and 4.7"
    assert law.derivative_on_error().rhs == K * Td * e.diff(t), "figure 4.7"
    assert law.filtered_derivative().rhs == -Function("D_f")(t) - K * Td * y.diff(t), "eq. 4.13"
    assert law.pid_law() == K * (law.b * ysp - y) + K / Ti * Integral(
        Function("e")(law.tau), (law.tau, 0, t)
    ) - K * Td * yf.diff(t)


def test_integral_of_a_polynomial_by_rectangles():
    """Eq. 4.5 summed over e = t^2 is the left rectangle sum; the error halves with h (first order)."""
    gain = by_signals(term.integral().rhs)[at("e")].subs({K: 1, Ti: 1})
    true = integrate(t**2, (t, 0, 1))

    def error(n: int) -> Fraction:
        step = Rational(1, n)
        return abs(sum(gain.subs(h, step) * (step * k) ** 2 for k in range(n)) - true)

    assert error(10) == Rational(29, 600)
    assert abs(N(error(20) / error(40)) - 2) < 0.1


@pytest.mark.parametrize(
    ("equation", "expected"),
    [
        (term.derivative_tustin, {("D", -1): -1, ("y_f", 0): -2 * K * Td / h, ("y_f", -1): 2 * K * Td / h}),
        (
            term.low_pass_tustin,
            {("y_f", -1): (2 * Tf - h) / (2 * Tf + h), ("y", 0): h / (2 * Tf + h), ("y", -1): h / (2 * Tf + h)},
        ),
        (
            term.filtered_derivative_tustin,
            {
                ("D_f", -1): (2 * Tf - h) / (2 * Tf + h),
                ("y", 0): -2 * K * Td / (2 * Tf + h),
                ("y", -1): 2 * K * Td / (2 * Tf + h),
            },
        ),
        (exact.low_pass_held, {("y_f", -1): A, ("y", -1): 1 - A}),
        (exact.low_pass_current, {("y_f", -1): A, ("y", 0): 1 - A}),
        (
            exact.low_pass_line,
            {("y_f", -1): A, ("y", 0): 1 - Tf / h * (1 - A), ("y", -1): Tf / h * (1 - A) - A},
        ),
        (
            exact.filtered_derivative_line,
            {("D_f", -1): A, ("y", 0): -K * Td * (1 - A) / h, ("y", -1): K * Td * (1 - A) / h},
        ),
        (
            exact.filtered_derivative_held,
            {("D_f", -1): A, ("y", 0): -K * Td / Tf, ("y", -1): K * Td / Tf},
        ),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_alternatives(equation, expected):
    """Tustin and exact forms of the filter and of the filtered derivative, by hand."""
    gains = by_signals(equation().rhs)
    assert {s for s, g in gains.items() if g != 0} == {at(*key) for key in expected}
    for key, gain in expected.items():
        assert simplify(gains[at(*key)] - gain) == 0, key


def test_filtered_derivative_is_the_filtered_slope():
    """For y = t every form of D_f tends to -K Td; the held and the straight form differ in how."""
    ramp = {at("y"): t, at("y", -1): t - h, at("D_f", -1): -K * Td}
    for form in (term.filtered_derivative().full(), exact.filtered_derivative_line()):
        assert simplify(form.rhs.subs(ramp) + K * Td) == 0


def test_backward_time_constant():
    """The backward filter's pole read as exp(-h/T) gives T = h/log(1 + h/Tf), half a sample more than Tf."""
    T = exact.backward_time_constant()
    pole = by_signals(term.low_pass().full().rhs)[at("y_f", -1)]
    assert math.isclose(float(exp(-h / T).subs({h: 1, Tf: 3})), float(pole.subs({h: 1, Tf: 3})))
    assert limit((T - Tf) / h, h, 0) == Rational(1, 2)
    assert limit(T / Tf, h, 0) == 1


def test_rc_circuit():
    """The divider with impedance 1/(sC): 1/(1 + i omega R C), an independent route to the filter's law."""
    R, C = rc.R, rc.C
    i = symbols("i")
    divider = (1 / (i * omega * C)) / (R + 1 / (i * omega * C))
    assert simplify(divider - 1 / (1 + i * omega * R * C)) == 0
    assert simplify(rc.transfer() - (1 / (1 + i * omega * Tf)).subs(i, sqrt(-1))) == 0
    assert rc.gain() == 1 / sqrt(1 + omega**2 * Tf**2)
    assert rc.circuit_law().rhs == rc.V_in(t) - rc.V_out(t)
    assert rc.circuit_law().lhs == R * C * rc.V_out(t).diff(t)
    assert rc.filter_law().rhs == Function("y")(t) - Function("y_f")(t), "eqs 4.8 and 4.9"
    assert rc.filter_law().lhs == Tf * Function("y_f")(t).diff(t), "eqs 4.8 and 4.9"


def test_cutoff_in_both_units():
    assert rc.cutoff() == 1 / Tf
    assert simplify(rc.cutoff_hz() * 2 * rc.pi * Tf) == 1
    assert simplify(rc.gain().subs(omega, rc.cutoff()) - 1 / sqrt(2)) == 0


def test_unit_of_the_time_constant():
    assert dimsys_SI.equivalent_dims(ohm.dimension * farad.dimension, second.dimension)
    assert dimsys_SI.equivalent_dims(farad.dimension, ampere.dimension * second.dimension / volt.dimension)


@pytest.mark.parametrize("order", [1, 2])
def test_anti_alias_time_constant(order):
    """At half the sampling frequency the filters in series attenuate 16 times: Tf = 5.08 h for one."""
    T = rc.time_constant_for(order).subs(rc.attenuation, 16)
    reached = rc.gain().subs(omega, rc.pi / h).subs(Tf, T) ** order
    assert simplify(reached - Rational(1, 16)) == 0
    assert math.isclose(float(T / h), {1: 5.0829, 2: 1.23281}[order], rel_tol=1e-4)


def test_current_grows_with_frequency():
    current = rc.capacitor_current()
    assert limit(current, omega, oo) == 1 / rc.R
    assert simplify(current - rc.C * omega / sqrt(1 + (omega * rc.R * rc.C) ** 2)) == 0
    assert solve(current.diff(omega), omega) == []
