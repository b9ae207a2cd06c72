"""What T_i and T_d mean, and where proportional control ends: figures 3.6 and 3.12, section 3.1."""

from sympy import Rational, simplify, symbols

from derivations.algebra.differences import t
from derivations.pid import interpretations as meaning
from derivations.pid import offset
from derivations.pid.pid_laws import K, Td, Ti


def test_pi_step_doubles_after_ti():
    expected = K * (1 + t / Ti) * meaning.step
    assert simplify(meaning.pi_step() - expected) == 0, "figure 3.6"
    assert meaning.doubling_time() == Ti


def test_prediction_is_exact_for_lines_only():
    a, b = symbols("a b")
    assert meaning.prediction_error(a * t + b) == 0
    assert meaning.prediction_error(t**2) == Td**2


def test_secant_and_tangent():
    assert meaning.tangent(meaning.x**2) == 2 * meaning.x
    assert simplify(meaning.secant(meaning.x**2) - (2 * meaning.x + meaning.distance)) == 0


def test_cruise_control_ends_at_70():
    """u = 0.1 (50 - y) + 9 on y = 10 u rests at 70 km/h; with square drag from (9 V, 90 km/h) at 75.9."""
    values = {K: Rational(1, 10), offset.ysp: 50, offset.u_b: 9, offset.load: 0, offset.gain: 10}
    assert offset.rest_linear().subs(values) == 70
    drag = offset.rest_drag().subs({**values, offset.u_0: 9, offset.speed_0: 90})
    assert abs(float(drag) - 75.9339) < 1e-4
    assert offset.output(85, 90).subs(values) == Rational(19, 2)


def test_offset_of_proportional_control():
    G, d = offset.gain, offset.load
    assert simplify(offset.error_linear() - (offset.ysp - d - G * offset.u_b) / (1 + G * K)) == 0
    assert offset.error_at_infinite_gain() == 0
    assert simplify(offset.offset_needed() - (offset.ysp - d) / G) == 0


def test_set_point_weight_is_not_in_the_load_response():
    weight = next(s for s in offset.setpoint_transfer().free_symbols if s.name == "b")
    assert weight not in offset.load_transfer().free_symbols
    G, R = offset.process, offset.integral_action
    assert simplify(offset.load_transfer() - G / (1 + G * (K + R))) == 0
    assert simplify(offset.setpoint_transfer() - G * (K * weight + R) / (1 + G * (K + R))) == 0
