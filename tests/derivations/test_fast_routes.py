"""Derivations that go a short way of their own, against SymPy's general and slow routines."""

import pytest
import sympy
from sympy import Function, Rational, Symbol, dsolve, limit, simplify, solve, symbols

from derivations.algebra.differences import BACKWARD, FORWARD, TUSTIN, at, discretise, h, t, update
from derivations.experiments import two_lags, two_point_fit
from derivations.loop import robustness
from derivations.pid import exact_filters, offset, rc_filter
from derivations.pid.pid_laws import derivative, filtered_derivative, integral_tracking, rate
from derivations.pid.rc_filter import R, Tf, filter_law
from derivations.plants import gain_scheduling
from derivations.tuning import amigo, amigo_integrating, letters, pid_by_angles

pytestmark = pytest.mark.long

a, b, start = symbols("a b start")


@pytest.mark.parametrize("source", [a, a + (b - a) * t / h])
def test_filter_over_one_sample_as_dsolve_finds_it(source):
    x = Function("x")
    law = filter_law("x", "w").subs(Function("w")(t), source)
    slow = dsolve(law, x(t), ics={x(0): start}).rhs.subs(t, h)
    assert simplify(exact_filters._after_one_sample(source) - slow) == 0


def test_a_filter_whose_source_is_curved_is_refused():
    with pytest.raises(ArithmeticError, match="not linear in t"):
        exact_filters._after_one_sample(t**2)


@pytest.mark.parametrize("difference", [FORWARD, BACKWARD, TUSTIN], ids=lambda d: d.name)
@pytest.mark.parametrize(
    ("law", "state"),
    [(rate(integral_tracking()), "I"), (derivative(), "D"), (filter_law(), "y_f"), (filtered_derivative(), "D_f")],
)
def test_the_newest_sample_as_solve_finds_it(law, state, difference):
    found = update(law, state, difference)
    (slow,) = solve(discretise(law, difference), found.lhs)
    assert found.lhs in (at(state), at(state, 1))
    assert simplify(found.rhs - slow) == 0


def test_two_equal_lags_are_the_limit_of_two():
    slow = limit(two_lags.unfinished(), two_lags.T_2, two_lags.T_1)
    assert simplify(two_lags.unfinished_equal() - slow) == 0


def test_the_smooth_branch_is_the_lower_root():
    """f = R^2 at df/dk = 0 has two roots k_i for every point of the process; the branch is the lower one."""
    d = robustness
    point = {d.a: -Rational(3, 5), d.b: -Rational(4, 5), d.C: 2, d.R: Rational(1, 2), d.w: 3, d.k_d: Rational(1, 9)}
    f = d.distance_squared().subs(point)
    (lowest,) = solve(sympy.diff(f, d.k), d.k)
    roots = solve(f.subs(d.k, lowest) - Rational(1, 4), d.k_i)
    branch = d.smooth_branch()
    assert len(roots) == 2
    assert branch.k_i.subs(point).subs(d.r, 1) == min(roots)
    assert branch.k.subs(point).subs(d.r, 1) == lowest


def test_joint_M_as_solve_finds_it():
    inverse = Symbol("q", positive=True)
    M = robustness.M
    (root,) = [x for x in solve(2 * M * (M - 1) - inverse, M) if x.subs(inverse, 1) > 0]
    x, y = robustness.a, robustness.b
    assert simplify(robustness.joint_M() - root.subs(inverse, -2 * x / ((1 + x) ** 2 + y**2))) == 0


@pytest.mark.parametrize("rule", [amigo.pi_step, amigo.pid_step, amigo.pid_combined])
def test_limits_at_infinity_as_sympy_finds_them(rule):
    rule = rule()
    lag = letters.T if letters.T in rule.inputs else letters.T_1
    for expression in (rule.K, rule.ki, rule.kd):
        at_lag = expression.subs(letters.K_p, letters.K_v * lag)
        assert simplify(amigo_integrating._at_infinity(at_lag, lag) - limit(sympy.cancel(at_lag), lag, sympy.oo)) == 0


def test_a_limit_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match="grows without bound with T"):
        amigo_integrating._at_infinity(letters.T**2 / (letters.T + letters.L), letters.T)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_time_constant_of_the_filter_as_solve_finds_it(order):
    wanted = rc_filter.attenuation ** Rational(-2, order)
    slow = solve(rc_filter.gain().subs(rc_filter.omega, rc_filter.pi / h) ** 2 - wanted, Tf)
    assert simplify(rc_filter.time_constant_for(order) - slow[0]) == 0


def test_the_circuit_as_a_system_of_three_laws():
    f = rc_filter
    slope = f.V_out(t).diff(t)
    laws = [f.current(t) - f.C * slope, f.V_R(t) - R * f.current(t), f.V_in(t) - f.V_R(t) - f.V_out(t)]
    (solved,) = solve(laws, [slope, f.current(t), f.V_R(t)], dict=True)
    law = f.circuit_law()
    assert law.lhs == R * f.C * slope
    assert simplify(law.rhs - R * f.C * solved[slope]) == 0


def test_two_points_as_a_system():
    p = two_point_fit
    (slow,) = solve([p.t1 - p.rise(p.p1), p.t2 - p.rise(p.p2)], [p.T, p.T0], dict=True)
    assert all(simplify(p.fit()[s] - slow[s]) == 0 for s in (p.T, p.T0))


def test_static_output_and_rest_as_solve_finds_them():
    g = gain_scheduling
    assert solve(g.acceleration().subs(g.v, 0), g.y) == [g.static_output()]
    (slow,) = solve(offset.y - offset.gain * offset.output() - offset.load, offset.y)
    assert simplify(offset.rest_linear() - slow) == 0


def test_rest_against_drag_as_solve_finds_it():
    o = offset
    at_one = dict.fromkeys((o.K, o.u_0, o.speed_0, o.ysp, o.u_b), 1)
    (slow,) = [y for y in solve(o.u_0 * (o.y / o.speed_0) ** 2 - o.output(), o.y) if y.subs(at_one) > 0]
    assert simplify(o.rest_drag() - slow) == 0


def test_derivative_gain_by_angles_as_simplify_finds_it():
    """D = -residue/N^2 at the filter's pole."""
    p = pid_by_angles
    without_pole = p.k * p.factor(p.f) * p.factor(p.b) / sympy.sin(p.a)  # (s + N) s C
    pole = -p.w * sympy.cos(p.a) / sympy.sin(p.a)
    slow = simplify(-without_pole.subs(p.s, pole) / pole**3)
    assert p.parallel()["D"] == slow
