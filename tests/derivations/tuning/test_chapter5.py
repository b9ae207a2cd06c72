"""The derivations behind the experiments and MIGO: defining properties and second routes."""

import math

import pytest
import sympy

from derivations.experiments import describing_function, double_pulse, reaction_curve, two_lags
from derivations.loop import robustness
from derivations.tuning import amigo, amigo_integrating, letters

pytestmark = pytest.mark.long


def test_double_pulse_extremes_give_the_process_back():
    found, estimate = double_pulse.extremes(), double_pulse.estimate()
    extremes = {getattr(double_pulse, n): getattr(found, n) for n in ("y_max", "y_min", "t_max", "t_min")}
    assert sympy.simplify(estimate.K_p.subs(extremes) - double_pulse.K_p) == 0
    at = {double_pulse.T: 3, double_pulse.T_p: 2, double_pulse.K_p: 5, double_pulse.u_a: 7, double_pulse.L: 1}
    for name, expected in (("T", 3), ("L_from_max", 1), ("L_from_min", 1)):
        value = getattr(estimate, name).subs({k: v.subs(at) for k, v in extremes.items()}).subs(at)
        assert abs(float(value) - expected) < 1e-12


def test_double_pulse_log_is_of_the_minimum_over_the_maximum():
    y = double_pulse.y_min / double_pulse.y_max
    assert -double_pulse.T_p / sympy.log(1 + y) == double_pulse.estimate().T


def test_relay_fourier_integral_by_numbers():
    """The first harmonic of the relay's square wave against a plain sum over samples."""
    n, eps, amplitude = 20000, 0.3, 1.0
    total, lag = 0j, math.asin(eps / amplitude)
    for i in range(n):
        angle = 2 * math.pi * (i + 0.5) / n
        level = 1.0 if (angle - lag) % (2 * math.pi) < math.pi else -1.0
        total += level * complex(math.sin(angle), math.cos(angle)) * 2 / n
    d = describing_function
    expected = complex(d.relay().subs({d.u_a: 1, d.y_a: 1, d.epsilon: sympy.Rational(3, 10)}))
    assert abs(total - expected) < 1e-3


def test_oscillation_stands_where_loop_is_minus_one():
    d = describing_function
    assert sympy.simplify(d.relay() * d.process_at_oscillation() + 1) == 0
    assert d.process_gain() == sympy.pi * d.y_a / (4 * d.u_a)


def test_two_lags_solve_gain_and_phase_for_every_alpha():
    assert two_lags.gain_residual_vanishes() == 0
    assert two_lags.phase_residual_vanishes() == 0


def test_two_lags_step_response_meets_its_differential_equation():
    """z = unfinished solves T1 T2 z'' + (T1 + T2) z' + z = 0 with z(0) = 1, z'(0) = 0."""
    z, t = two_lags.unfinished(), two_lags.t
    T1, T2 = two_lags.T_1, two_lags.T_2
    assert sympy.simplify(T1 * T2 * z.diff(t, 2) + (T1 + T2) * z.diff(t) + z) == 0
    assert sympy.simplify(z.subs(t, 0) - 1) == sympy.simplify(z.diff(t).subs(t, 0)) == 0
    assert sympy.simplify(two_lags.unfinished_equal().diff(t).subs(t, 0)) == 0


def test_reaction_curve_gives_the_model_back():
    r = reaction_curve
    assert sympy.solve(r.steepest_tangent(), r.t) == [r.L]
    assert r.fraction_at_T63() == 1 - sympy.exp(-1)
    assert sympy.simplify(sympy.limit(r.integrating_step().diff(r.t), r.t, sympy.oo) - r.K_v * r.du) == 0
    assert sympy.simplify(r.short_pulse_response() - r.stable_step().subs({r.K_p: r.K_v, r.du: 1})) == 0


def test_velocity_gain_holds_the_step_height():
    r = reaction_curve
    assert r.velocity_gain() == r.dy / (r.L * r.du)


def test_circles():
    M = robustness.M
    Ms, Mp, joint = (
        f() for f in (robustness.sensitivity_circle, robustness.complementary_circle, robustness.joint_circle)
    )
    assert sympy.simplify(joint.centre + (2 * M**2 - 2 * M + 1) / (2 * M * (M - 1))) == 0
    assert sympy.simplify(joint.radius - (2 * M - 1) / (2 * M * (M - 1))) == 0
    assert sympy.simplify(Mp.centre + M**2 / (M**2 - 1)) == 0
    assert sympy.simplify(Mp.radius - M / (M**2 - 1)) == 0
    for M_value in (sympy.Rational(11, 10), sympy.Rational(7, 5), 2, 5):
        left = [c.left.subs(M, M_value) for c in (Ms, Mp)]
        right = [c.right.subs(M, M_value) for c in (Ms, Mp)]
        assert joint.left.subs(M, M_value) == min(left) and joint.right.subs(M, M_value) == max(right)


def test_smooth_branch_solves_its_three_equations():
    d = robustness
    branch, f = d.smooth_branch(), d.distance_squared()
    settings = {d.k: branch.k, d.k_i: branch.k_i}
    moved = d.along_frequency(f).subs(settings).subs(d.k_d, branch.k_d)
    point = {d.a: -sympy.Rational(3, 5), d.b: -sympy.Rational(4, 5), d.r: 1, d.C: 2, d.R: 1, d.w: 3}
    slopes = {d.da: sympy.Rational(1, 7), d.db: sympy.Rational(2, 5)}
    assert sympy.simplify(moved.subs(slopes).subs(point)) == 0
    assert sympy.simplify((f - d.R**2).subs(settings).subs(point)) == 0
    assert sympy.simplify(sympy.diff(f, d.k).subs(settings).subs(point)) == 0


def test_stationary_gain_is_the_derivative_along_a_real_process():
    """dk_i/dw at fixed k_d, by SymPy's own derivative on 1/(s+1)^3."""
    d, w = robustness, robustness.w
    G = 1 / (1 + sympy.I * w) ** 3
    a, b = (sympy.simplify(e) for e in G.as_real_imag())
    values = {d.a: a, d.b: b, d.r: sympy.sqrt(a**2 + b**2), d.da: a.diff(w), d.db: b.diff(w), d.C: 2, d.R: 1}
    branch = d.smooth_branch()
    k_i = branch.k_i.subs(d.k_d, sympy.Symbol("q")).subs({k: values[k] for k in (d.a, d.b, d.r, d.C, d.R)})
    direct = sympy.solve(k_i.diff(w).subs(w, sympy.Rational(2, 3)), sympy.Symbol("q"))[0]
    assert abs(float(direct - branch.k_d.subs(values).subs(w, sympy.Rational(2, 3)))) < 1e-12


@pytest.mark.parametrize(
    ("rule", "K", "Ti", "Td"),
    [
        (amigo.pi_step(), "7/(20*K_v*L)", "267*L/20", "0"),
        (amigo.pid_step(), "9/(20*K_v*L)", "8*L", "L/2"),
    ],
)
def test_limits_of_the_step_rules(rule, K, Ti, Td):
    limit = amigo_integrating.integrating_limit(rule)
    names = {s.name: s for s in (letters.K_v, letters.L)}
    for found, expected in ((limit.K, K), (limit.Ti, Ti), (limit.Td, Td)):
        assert sympy.simplify(found - sympy.sympify(expected, locals=names)) == 0


def test_limit_of_the_combined_rule_drops_half_of_its_weights():
    a, limit = letters, amigo_integrating.integrating_limit(amigo.pid_combined())
    alpha, beta, gamma = amigo.SECOND_ORDER.values()
    K = (alpha[1] / a.L_1 + alpha[3] * a.T_2 / a.L_1**2) / a.K_v
    ki = (beta[1] / a.L_1**2 + beta[3] * a.T_2 / a.L_1**3) / a.K_v
    kd = (gamma[1] + gamma[3] * a.T_2 / a.L_1) / a.K_v
    assert all(sympy.simplify(x - y) == 0 for x, y in ((limit.K, K), (limit.ki, ki), (limit.kd, kd)))


def test_filter_adjustment_keeps_the_sum_of_lags():
    a = letters
    for data in ({a.T: a.T, a.L: a.L}, {a.T_1: a.T_1, a.T_2: a.T_2, a.L_1: a.L_1}):
        assert sympy.simplify(sum(amigo.with_filter(data).values()) - sum(data.values()) - a.T_f) == 0
