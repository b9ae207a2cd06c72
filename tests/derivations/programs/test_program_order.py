"""The derived difference equations and the statements that run."""

import pytest
import sympy as sp

from derivations.programs import positional_pid as law
from derivations.programs import program_order
from derivations.programs import two_lag_euler as plant
from derivations.programs.program_order import OrderMismatch, Statement


def test_state_equations_lead_back_to_the_transfer_function():
    expected = plant.k / ((1 + plant.s * plant.T1) * (1 + plant.s * plant.T2))
    assert sp.simplify(plant.transfer() - expected) == 0


def test_euler_is_stable_up_to_twice_the_shorter_time_constant():
    assert plant.longest_step() == 2 * sp.Min(plant.T1, plant.T2)
    step = sp.Matrix([plant.euler_step()[x] for x in (plant.x1, plant.x2)]).jacobian([plant.x1, plant.x2])
    roots = step.subs({plant.T1: 2, plant.T2: 3, plant.h: 4}).eigenvals()
    assert max(abs(r) for r in roots) == 1


def test_transfer_of_the_law_is_rectangle_rule_and_backward_difference():
    z, h = law.z, law.h
    expected = law.Kp * (1 + h * z / ((z - 1) * law.Ti) + law.Td * (z - 1) / (h * z))
    assert sp.simplify(law.transfer() - expected) == 0


def test_increments_add_up_to_the_positional_law():
    errors = sp.symbols("e0:5")
    total = sum(errors)
    positional = law.law().subs({law.total: total, law.e: errors[4], law.last: errors[3]}, simultaneous=True)
    start = law.law().subs({law.total: errors[0] + errors[1], law.e: errors[1], law.last: errors[0]}, simultaneous=True)
    steps = [
        law.increment().subs({law.e: errors[i], law.last: errors[i - 1], law.older: errors[i - 2]}, simultaneous=True)
        for i in (2, 3, 4)
    ]
    assert sp.expand(positional - start - sum(steps)) == 0


def test_bumpless_sum_makes_the_first_sample_equal_the_manual_signal():
    terms = law.terms()
    first = terms["P"] + terms["I"].subs(law.total, law.bumpless_total() + law.e)
    assert sp.simplify(first - law.manual) == 0


def test_statements_are_refused_where_they_do_not_equal_the_derivation():
    wrong = (Statement("up", "Kp*e"), Statement("ui", "total*h/Ti"), Statement("ud", "(e - last)/h*Kp*Td"))
    terms = law.terms()
    with pytest.raises(OrderMismatch, match="ui: the statements give"):
        program_order._proved(wrong, {"up": terms["P"], "ui": terms["I"], "ud": terms["D"]})


def test_statements_keep_the_order_that_decides_rounding():
    texts = {s.target: s.text for s in (*program_order.plant(), *program_order.regulator())}
    assert texts["ui"] == "total*h*Kp/Ti"
    assert texts["d2"] == "-(T1 + T2)/m*x2 - 1/m*x1 + k/m*u"
