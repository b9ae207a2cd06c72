"""Steady-state errors: the limit against simulation-free second routes."""

import sympy as sp

from derivations.algebra.final_value import (
    RAMP,
    Kp,
    T,
    Ti,
    error_transfer,
    gain_for_error,
    k,
    load_error,
    s,
    steady_state_error,
)
from derivations.loop import first_order_loop as first

LAG = k / (1 + s * T)


def test_proportional_error_equals_the_static_solution_of_the_loop():
    e = sp.Symbol("e")
    (static,) = sp.solve(sp.Eq(e, 1 - k * Kp * e), e)
    assert sp.simplify(steady_state_error(Kp, LAG) - static) == 0


def test_integral_action_removes_the_error_of_a_step_and_bounds_that_of_a_ramp():
    pi = Kp * (1 + 1 / (s * Ti))
    assert steady_state_error(pi, LAG) == 0
    assert sp.simplify(steady_state_error(pi, LAG, RAMP) - Ti / (Kp * k)) == 0
    assert steady_state_error(Kp, LAG, RAMP) == sp.oo


def test_an_integrating_plant_needs_no_integral_action_for_the_set_point_but_for_the_load():
    plant = k / (s * (1 + s * T))
    assert steady_state_error(Kp, plant) == 0
    assert load_error(Kp, plant) == -1 / Kp
    assert load_error(Kp * (1 + 1 / (s * Ti)), plant) == 0


def test_the_gain_for_an_error_is_finite_for_every_positive_error():
    e = sp.Symbol("e", positive=True)
    assert sp.simplify(steady_state_error(gain_for_error(), LAG) - e) == 0
    assert sp.limit(gain_for_error(), e, 0) == sp.oo


def test_error_transfer_is_the_sensitivity():
    R, O = sp.symbols("R O")
    assert sp.simplify(error_transfer(R, O) - 1 / (1 + R * O)) == 0


def test_pole_cancelling_pi_gives_one_lag_whatever_the_plant():
    assert sp.simplify(first.setpoint_transfer() - 1 / (1 + s * first.lam)) == 0
    assert sp.simplify(sp.diff(first.setpoint_transfer(), T)) == 0


def test_load_response_satisfies_its_differential_equation_and_its_area():
    y, t = first.load_response(), first.t
    product = sp.Poly(sp.expand((1 + s * T) * (1 + s * first.lam)), s)
    left = sum(c * sp.diff(y, t, n[0]) for n, c in product.terms())
    assert sp.simplify(left) == 0
    assert sp.simplify(sp.diff(y, t).subs(t, 0) - k / T) == 0
    assert sp.simplify(first.load_area() - first.lam * k) == 0


def test_equal_time_constants_are_the_limit_of_unequal_ones():
    assert sp.simplify(sp.limit(first.load_response(), first.lam, T) - first.load_response_equal()) == 0
