"""Ziegler-Nichols, Chien-Hrones-Reswick, lambda, SIMC and the first-order rule: printed numbers and properties."""

import math
import re

import numpy as np
import pytest
import sympy as sp

from derivations.tuning import catalogue, letters
from derivations.tuning.chien_hrones_reswick import types
from loopbook.experiments.data import DataError, FrequencyData, StepData
from loopbook.process.transfer_function import Process
from loopbook.tuning import RuleDoesNotApply, tune


def rounded(tuning, digits=4):
    return tuple(round(x, digits) for x in (tuning.K, tuning.Ti, tuning.Td))


def ultimate(Ku, Tu, kind):
    return tune(FrequencyData.from_ultimate(Ku, Tu), f"zn-ultimate-{kind}")


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
    assert rounded(tune(StepData(*model), "zn-step-pid")) == settings


def test_ultimate_method_gives_the_printed_settings_in_the_variant_of_the_article():
    assert rounded(ultimate(1.33, 6.3, "pid-article"), 2) == (0.8, 3.15, 0.76)
    assert rounded(ultimate(1.33, 6.3, "pid"), 2) == (0.8, 3.15, 0.79)


def test_ultimate_method_gives_the_double_tank_form():
    K0, T0 = 10 ** (95 / 20), 2 * math.pi / 0.402
    parallel = ultimate(K0, T0, "pid").pid.parallel()
    P = 0.6 * K0
    assert pytest.approx((P, P / (0.5 * T0), P * 0.125 * T0), rel=1e-14) == (parallel.P, parallel.I, parallel.D)


@pytest.mark.parametrize("variant, Ti", [("pi", 10 / 3), ("pi-article", 3.0)])
def test_the_two_integral_times_of_the_step_method_are_two_variants(variant, Ti):
    assert tune(StepData(1, 1, 1), f"zn-step-{variant}").Ti == pytest.approx(Ti, rel=1e-15)


@pytest.mark.parametrize("variant, Ti", [("pi", 1 / 1.2), ("pi-article", 0.85)])
def test_the_two_integral_times_of_the_ultimate_method_are_two_variants(variant, Ti):
    assert ultimate(1, 1, variant).Ti == pytest.approx(Ti, rel=1e-15)


def test_proportional_settings_have_no_integral_and_no_derivative():
    tuning = tune(StepData(2, 4, 1), "zn-step-p")
    assert (tuning.K, tuning.Ti, tuning.Td) == (2.0, math.inf, 0.0)


def test_settings_act_on_the_error_as_the_rules_were_published():
    pid = tune(StepData(3, 3.285, 1.005), "zn-step-pid").pid
    assert (pid.b, pid.c, pid.Tf) == (1.0, 1.0, 0.0)


def test_formula_that_is_shown_is_the_one_that_computes():
    shown = catalogue.rule("zn-step-pid").equations()
    at = {letters.k: sp.Integer(3), letters.T: sp.Rational("3.285"), letters.T_0: sp.Rational("1.005")}
    K = tune(StepData(3, 3.285, 1.005), "zn-step-pid").K
    assert float(shown["K"].rhs.subs(at)) == pytest.approx(K, rel=1e-15)
    assert "Td" not in catalogue.rule("zn-step-pi").equations()


def test_dead_time_of_zero_names_the_rule_that_applies():
    with pytest.raises(RuleDoesNotApply, match=re.escape("(use first-order-pi)")):
        tune(StepData(1, 1, 0), "zn-step-pid")


@pytest.mark.parametrize("bad", [-1.0, 0.0, math.nan, math.inf])
def test_inputs_must_be_positive_and_finite(bad):
    with pytest.raises(DataError, match=r"Ku = .* must be a positive finite number"):
        ultimate(bad, 1.0, "pid")
    with pytest.raises(RuleDoesNotApply, match=r"closed = .* must be a positive number"):
        tune(StepData(1, 1, 0), "lambda-pi", closed=bad)


def test_validity_range_is_noted():
    assert tune(StepData(1, 1, 0.5), "zn-step-pid").notes == ()
    assert "outside 0.1 to 1" in tune(StepData(1, 1, 0.05), "zn-step-pid").notes[0]


@pytest.mark.parametrize(
    "R, named",
    [(3.2687, ("pid",)), (2, ("higher order",)), (8, ("pi",)), (11, ("p",)), (7.5, ("pid", "pi")), (10, ("pi", "p"))],
)
def test_type_by_ratio_and_both_neighbours_at_the_open_borders(R, named):
    assert types(R) == named


def test_chr_settings_of_the_example():
    data = StepData(3, 3.285, 1.005)
    assert rounded(tune(data, "chr-pid-0")) == (round(0.6 * 3.285 / (3 * 1.005), 4), 3.285, 0.5025)
    with_overshoot = (round(0.95 * 3.285 / (3 * 1.005), 4), 4.599, round(0.47 * 1.005, 4))
    assert rounded(tune(data, "chr-pid-20")) == with_overshoot
    assert "table takes PID" in tune(data, "chr-pi-0").notes[0]
    assert not tune(data, "chr-pid-0").notes


def test_first_order_rule_and_the_script_are_the_same_for_a_range_in_units_of_T():
    lag = StepData(2, 3, 0)
    for i in np.arange(1, 11) / 10:
        scripted = tune(lag, "first-order-pi-script", i=i).K
        assert pytest.approx(tune(lag, "first-order-pi", closed=i * 3).K) == scripted
        assert pytest.approx(1 / (2 * i)) == scripted
    slower = tune(StepData(2, 30, 0), "first-order-pi-script", i=0.5)
    assert slower.K == tune(lag, "first-order-pi-script", i=0.5).K


def test_first_order_rule_is_for_a_lag_without_dead_time_and_needs_its_option():
    with pytest.raises(RuleDoesNotApply, match=r"dead time of 1 s .*\(use lambda-pi\)"):
        tune(StepData(2, 3, 1), "first-order-pi", closed=1)
    with pytest.raises(RuleDoesNotApply, match="first-order-pi needs closed: the wanted time constant"):
        tune(StepData(2, 3, 0), "first-order-pi")


def test_lambda_pi_makes_the_loop_an_integrator_with_dead_time():
    k, T, L, closed = 2.0, 3.0, 0.7, 1.1
    pid = tune(StepData(k, T, L), "lambda-pi", closed=closed).pid
    s = 1j * np.array([0.1, 1.0, 10.0])
    loop = pid(s) * k / (1 + s * T) * np.exp(-s * L)
    assert loop == pytest.approx(np.exp(-s * L) / (s * (closed + L)), rel=1e-12)


def test_lambda_pid_cancels_the_lag_and_the_pade_pole_of_the_dead_time():
    k, T, L, closed = 2.0, 3.0, 0.7, 1.1
    pid = tune(StepData(k, T, L), "lambda-pid", closed=closed).pid
    s = 1j * np.array([0.1, 1.0, 10.0])
    loop = pid(s) * k / (1 + s * T) * (1 - s * L / 2) / (1 + s * L / 2)
    assert loop == pytest.approx((1 - s * L / 2) / (s * (closed + L / 2)), rel=1e-12)


def test_simc_with_the_recommended_speed_has_the_published_sensitivity():
    pid = tune(StepData(2, 5, 1), "simc").pid
    w = np.linspace(0.01, 20, 200_001)
    loop = pid(1j * w) * 2 / (1 + 5j * w) * np.exp(-1j * w)
    assert max(1 / abs(1 + loop)) == pytest.approx(1.59, abs=0.005)


def test_simc_shortens_the_integral_time_of_slow_plants_and_converts_its_series_form():
    assert tune(StepData(1, 100, 1), "simc").Ti == 8.0
    series = tune(Process([1], [20, 12, 1], 1), "simc", "PID").pid.series()
    assert (series.K, series.Ti, series.Td) == pytest.approx((5.0, 8.0, 2.0), rel=1e-12)
    with pytest.raises(RuleDoesNotApply, match="needs a second lag; the model has one, for which SIMC gives PI"):
        tune(StepData(1, 1, 1), "simc", "PID")


@pytest.mark.parametrize(
    "data, rule, closed, words",
    [
        (StepData(1, 10, 1), "lambda-pi", 1, "longer than 8 T0"),
        (StepData(1, 2, 1), "lambda-pi", 0.5, "shorter than T0"),
        (StepData(1, 2, 1), "simc-pi", 0.5, "faster than the author recommends"),
        (StepData(2, 3, 0), "first-order-pi", 0.3, "decays with T = 3 s"),
    ],
    ids=["slow load", "aggressive lambda", "aggressive SIMC", "cancelled mode"],
)
def test_what_limits_the_trust_is_noted(data, rule, closed, words):
    assert any(words in note for note in tune(data, rule, closed=closed).notes)
