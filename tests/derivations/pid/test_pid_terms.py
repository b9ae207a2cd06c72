"""The terms of a PID regulator: structures, step responses, limits."""

import pytest
import sympy as sp

from derivations.pid import pid_terms as p


def test_the_integral_term_grows_with_time_and_needs_the_present_as_upper_limit():
    assert p.integral_term(sp.Integer(1)) == p.t / p.Ti
    assert p.integral_term(p.t) == p.t**2 / (2 * p.Ti)
    fixed = sp.Symbol("tau", positive=True)
    assert p.t not in p.integral_term(sp.Integer(1), fixed).free_symbols


def test_separate_terms_add_up_to_the_independent_structure_which_differs_unless_the_gain_is_one():
    difference = sp.simplify(p.dependent() - p.independent())
    assert difference != 0
    assert difference.subs(p.Kp, 1) == 0


def test_conversion_to_the_independent_structure_is_exact():
    gains = p.to_independent()
    rebuilt = gains["P"] + gains["I"] / p.s + gains["D"] * p.s
    assert sp.simplify(rebuilt - p.dependent()) == 0


def test_infinite_integral_time_and_no_derivative_leave_the_gain():
    assert sp.limit(p.dependent().subs(p.Td, 0), p.Ti, sp.oo) == p.Kp


def test_the_real_derivative_tends_to_the_ideal_one_and_has_one_pole_more():
    assert sp.simplify(sp.limit(p.real(), p.alpha, sp.oo) - p.dependent()) == 0
    poles = [sp.Poly(sp.denom(sp.together(r)), p.s).degree() for r in (p.real(), p.dependent())]
    assert poles[0] - poles[1] == 1


@pytest.mark.parametrize("alpha", [1, 10, sp.Rational(7, 2)])
def test_the_peak_of_the_real_derivative_has_the_area_of_the_ideal_impulse(alpha):
    assert p.filter_area().subs(p.alpha, alpha) == p.Kp * p.Td


def test_prediction_along_the_tangent_is_exact_for_a_straight_line_only():
    slope = sp.Symbol("c")
    error = p.prediction_error()
    e = sp.Function("e")
    assert error.subs(e(p.t), slope * p.t).doit() == 0
    assert sp.simplify(error.subs(e(p.t), p.t**2).doit()) == p.Td**2
