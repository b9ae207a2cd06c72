"""Ziegler-Nichols, Chien-Hrones-Reswick, lambda, SIMC and the first-order rule: printed numbers and properties."""

import math
import re

import numpy as np
import pytest
import sympy as sp

from derivations.tuning import rules
from loopbook.tuning import chien_hrones_reswick, first_order, lambda_tuning, simc
from loopbook.tuning import ziegler_nichols as zn
from loopbook.tuning.rule import RuleDoesNotApply, compute


def rounded(tuning, digits=4):
    return tuple(round(x, digits) for x in (tuning.K, tuning.Ti, tuning.Td))


@pytest.mark.parametrize(
    "model, settings",
    [
        ((3, 3.285, 1.005), (1.3075, 2.01, 0.5025)),
        ((1, 1.32, 0.55), (2.88, 1.1, 0.275)),
        ((3, 2.76, 0.85), (1.2988, 1.7, 0.425)),
        ((5, 4.515, 0.975), (1.1114, 1.95, 0.4875)),
    ],
    ids=["example", "gain scheduling 1", "gain scheduling 2", "gain scheduling 3"],
)
def test_step_method_gives_the_printed_settings(model, settings):
    assert rounded(zn.step_method(*model)) == settings


def test_ultimate_method_gives_the_printed_settings_in_the_variant_of_the_article():
    assert rounded(zn.ultimate_method(1.33, 6.3, "pid-article"), 2) == (0.8, 3.15, 0.76)
    assert rounded(zn.ultimate_method(1.33, 6.3, "pid"), 2) == (0.8, 3.15, 0.79)


def test_ultimate_method_gives_the_double_tank_form():
    K0, T0 = 10 ** (95 / 20), 2 * math.pi / 0.402
    parallel = zn.ultimate_method(K0, T0, "pid").pid.parallel()
    P = 0.6 * K0
    assert pytest.approx((P, P / (0.5 * T0), P * 0.125 * T0), rel=1e-14) == (parallel.P, parallel.I, parallel.D)


@pytest.mark.parametrize("variant, Ti", [("pi", 10 / 3), ("pi-article", 3.0)])
def test_the_two_integral_times_of_the_step_method_are_two_variants(variant, Ti):
    assert zn.step_method(1, 1, 1, variant).Ti == pytest.approx(Ti, rel=1e-15)


@pytest.mark.parametrize("variant, Ti", [("pi", 1 / 1.2), ("pi-article", 0.85)])
def test_the_two_integral_times_of_the_ultimate_method_are_two_variants(variant, Ti):
    assert zn.ultimate_method(1, 1, variant).Ti == pytest.approx(Ti, rel=1e-15)


def test_proportional_settings_have_no_integral_and_no_derivative():
    tuning = zn.step_method(2, 4, 1, "p")
    assert (tuning.K, tuning.Ti, tuning.Td) == (2.0, math.inf, 0.0)


def test_settings_act_on_the_error_as_the_rules_were_published():
    pid = zn.step_method(3, 3.285, 1.005).pid
    assert (pid.b, pid.c, pid.Tf) == (1.0, 1.0, 0.0)


@pytest.mark.parametrize("name", [*rules.step_rules(), *rules.chr_rules(), *rules.lambda_rules(), *rules.simc_rules()])
def test_every_rule_scales_with_time_and_gain(name):
    """In other units of time and output the settings are the same regulator: K ~ 1/gain, Ti and Td ~ time."""
    found = rules.rule(name)
    times = {x: 2.5 for x in found.inputs if str(x) in ("T", "T_0", "lambda", "T_2")}
    factors = [1 / 7 if x == rules.k else times.get(x, 1.0) for x in found.inputs]
    numbers = [{"T": 5.0, "T_2": 3.0}.get(str(x), 1.5) for x in found.inputs]
    one, other = compute(name, *numbers), compute(name, *(n * f for n, f in zip(numbers, factors, strict=True)))
    assert pytest.approx(7 * one.K, rel=1e-12) == other.K
    assert other.Td == pytest.approx(2.5 * one.Td, rel=1e-12)
    assert other.Ti == pytest.approx(2.5 * one.Ti, rel=1e-12)


def test_formula_that_is_shown_is_the_one_that_computes():
    shown = rules.rule("zn-step-pid").equations()
    at = {rules.k: sp.Integer(3), rules.T: sp.Rational("3.285"), rules.L: sp.Rational("1.005")}
    assert float(shown["K"].rhs.subs(at)) == pytest.approx(zn.step_method(3, 3.285, 1.005).K, rel=1e-15)
    assert "Td" not in rules.rule("zn-step-pi").equations()


def test_dead_time_of_zero_names_the_rule_that_applies():
    with pytest.raises(RuleDoesNotApply, match=r"use first_order\.pole_cancelling_pi"):
        zn.step_method(1, 1, 0)


@pytest.mark.parametrize("bad", [-1.0, 0.0, math.nan, math.inf])
def test_inputs_must_be_positive_and_finite(bad):
    with pytest.raises(RuleDoesNotApply, match="must be a positive number"):
        zn.ultimate_method(bad, 1.0)


def test_unknown_names_list_the_known_ones():
    with pytest.raises(KeyError, match="pi-article"):
        zn.step_method(1, 1, 1, "pd")
    with pytest.raises(KeyError, match="zn-step-pid"):
        rules.rule("zn")
    with pytest.raises(KeyError, match="types: p, pi, pid"):
        chien_hrones_reswick.settings(1, 1, 1, "pd")


def test_wrong_number_of_inputs_names_them():
    with pytest.raises(TypeError, match=re.escape("takes K_u, T_u; got 1 numbers")):
        compute("zn-ultimate-p", 1.0)


def test_validity_range_is_noted():
    assert zn.step_method(1, 1, 0.5).notes == ()
    assert "outside 0.1 to 1" in zn.step_method(1, 1, 0.05).notes[0]


@pytest.mark.parametrize(
    "R, types",
    [(3.2687, ("pid",)), (2, ("higher order",)), (8, ("pi",)), (11, ("p",)), (7.5, ("pid", "pi")), (10, ("pi", "p"))],
)
def test_type_by_ratio_and_both_neighbours_at_the_open_borders(R, types):
    assert chien_hrones_reswick.types(R) == types


def test_chr_settings_of_the_example():
    aperiodic = chien_hrones_reswick.settings(3, 3.285, 1.005, "pid", 0)
    assert rounded(aperiodic) == (round(0.6 * 3.285 / (3 * 1.005), 4), 3.285, 0.5025)
    with_overshoot = chien_hrones_reswick.settings(3, 3.285, 1.005, "pid", 20)
    assert rounded(with_overshoot) == (round(0.95 * 3.285 / (3 * 1.005), 4), 4.599, round(0.47 * 1.005, 4))
    assert "table takes PID" in chien_hrones_reswick.settings(3, 3.285, 1.005, "pi").notes[0]


def test_ratio_refuses_negative_times():
    assert chien_hrones_reswick.ratio(1, 0) == math.inf
    with pytest.raises(RuleDoesNotApply, match="T0 = -1 s"):
        chien_hrones_reswick.ratio(1, -1)


def test_first_order_rule_and_the_script_are_the_same_for_a_range_in_units_of_T():
    for i in np.arange(1, 11) / 10:
        assert pytest.approx(first_order.pole_cancelling_pi(2, 3, i * 3).K) == first_order.script_pi(2, 3, i).K
        assert pytest.approx(1 / (2 * i)) == first_order.script_pi(2, 3, i).K
    assert first_order.script_pi(2, 30, 0.5).K == first_order.script_pi(2, 3, 0.5).K


def test_lambda_pi_makes_the_loop_an_integrator_with_dead_time():
    k, T, L, closed = 2.0, 3.0, 0.7, 1.1
    pid = lambda_tuning.settings(k, T, L, closed).pid
    s = 1j * np.array([0.1, 1.0, 10.0])
    loop = pid(s) * k / (1 + s * T) * np.exp(-s * L)
    assert loop == pytest.approx(np.exp(-s * L) / (s * (closed + L)), rel=1e-12)


def test_lambda_pid_cancels_the_lag_and_the_pade_pole_of_the_dead_time():
    k, T, L, closed = 2.0, 3.0, 0.7, 1.1
    pid = lambda_tuning.settings(k, T, L, closed, "pid").pid
    s = 1j * np.array([0.1, 1.0, 10.0])
    loop = pid(s) * k / (1 + s * T) * (1 - s * L / 2) / (1 + s * L / 2)
    assert loop == pytest.approx((1 - s * L / 2) / (s * (closed + L / 2)), rel=1e-12)


def test_simc_with_the_recommended_speed_has_the_published_sensitivity():
    pid = simc.settings(2.0, 5.0, 1.0).pid
    w = np.linspace(0.01, 20, 200_001)
    loop = pid(1j * w) * 2 / (1 + 5j * w) * np.exp(-1j * w)
    assert max(1 / abs(1 + loop)) == pytest.approx(1.59, abs=0.005)


def test_simc_shortens_the_integral_time_of_slow_plants_and_converts_its_series_form():
    assert simc.settings(1, 100, 1).Ti == 8.0
    series = simc.settings(1, 10, 1, T2=2).pid.series()
    assert (series.K, series.Ti, series.Td) == pytest.approx((5.0, 8.0, 2.0), rel=1e-12)
    with pytest.raises(RuleDoesNotApply, match="swap them"):
        simc.settings(1, 1, 1, T2=2)


@pytest.mark.parametrize(
    "tuning, words",
    [
        (lambda_tuning.settings(1, 10, 1, 1), "longer than 8 T0"),
        (lambda_tuning.settings(1, 2, 1, 0.5), "shorter than T0"),
        (simc.settings(1, 2, 1, closed=0.5), "faster than the author recommends"),
        (first_order.pole_cancelling_pi(2, 3, 0.3), "decays with T = 3 s"),
    ],
    ids=["slow load", "aggressive lambda", "aggressive SIMC", "cancelled mode"],
)
def test_what_limits_the_trust_is_noted(tuning, words):
    assert any(words in note for note in tuning.notes)
