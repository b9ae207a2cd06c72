"""Linearisation of the square-root plant and of both ways to schedule."""

import sympy as sp

from derivations.loop import routh
from derivations.plants import gain_scheduling as g


def test_static_gain_is_the_slope_of_the_static_characteristic():
    slope = sp.diff(g.static_output(), g.u).subs(g.u, g.static_input())
    assert sp.simplify(slope - g.static_gain()) == 0


def test_there_is_no_steady_state_for_a_negative_input():
    y, u = sp.Symbol("y", nonnegative=True), sp.Symbol("u", negative=True)
    assert sp.solve(sp.sqrt(y) - u, y) == []


def test_fixed_settings_follow_from_the_loop_of_transfer_functions():
    pid = g.K * (1 + 1 / (g.Ti * g.s) + g.Td * g.s)
    numerator = sp.numer(sp.together(1 + pid * g.linear_model()))
    monic = sp.Poly(sp.expand(numerator), g.s).monic().as_expr()
    assert sp.simplify(monic - g.characteristic_fixed()) == 0


def test_outside_equals_inside_where_the_integral_gain_is_flat():
    assert sp.simplify(g.characteristic_outside().subs(g.g, 0) - g.characteristic_fixed()) == 0


def test_outside_is_the_jacobian_of_the_scheduled_law():
    """Second route: differentiate the nonlinear state equations, with settings that are functions of y."""
    y, v, q, w = sp.symbols("y v q w", positive=True)
    K, Ti, Td = (sp.Function(n, positive=True)(y) for n in ("K", "Ti", "Td"))
    u = K * (w - y - Td * v + q / Ti)
    field = sp.Matrix([v, -v - sp.sqrt(y) + u, w - y])
    rest = {v: 0, w: y, q: sp.sqrt(y) * Ti / K}
    jacobian = field.jacobian([y, v, q]).subs(v, 0).subs(q, rest[q]).subs(w, y)
    found = sp.expand((g.s * sp.eye(3) - jacobian).det())
    slope = sp.diff(sp.log(K / Ti), y)
    expected = (
        g.characteristic_outside()
        .subs({g.K: K, g.Ti: Ti, g.Td: Td, g.c: g.stiffness(), g.g: slope, g.y0: y}, simultaneous=True)
        .subs(g.y0, y)
    )
    assert sp.simplify(sp.expand(found - expected)) == 0


def test_article_settings_of_the_first_segment_are_stable_for_every_stiffness():
    settings = {g.K: sp.Rational("2.88"), g.Ti: sp.Rational("1.1"), g.Td: sp.Rational("0.275")}
    column = routh.first_column(g.characteristic_fixed().subs(settings), g.s)
    assert all(e.is_positive for e in map(sp.expand, column[:2])) and column[3].is_positive
    assert sp.expand(sp.numer(sp.together(column[2]))).is_positive


def test_kick_is_gain_times_derivative_time():
    assert g.derivative_kick() == g.K * g.Td
