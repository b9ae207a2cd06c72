"""The AMIGO rules: every printed constant, every printed output of figures 5.8 to 5.13, limits and refusals."""

import math
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from derivations.tuning import amigo as expressions
from derivations.tuning import amigo_constants, amigo_integrating, letters
from loopbook.documents.open import printed as load
from loopbook.experiments.data import (
    DataError,
    FrequencyData,
    IntegratingPulseData,
    IntegratingStepData,
    StepData,
    TwoLagData,
)
from loopbook.tuning import RuleDoesNotApply, filtered_data, tune
from notebook_reports.ledger.verdicts import UNEXPLAINED, Computed, rounds_to, value_verdict

STEP = StepData(Kp=1, T=1.04, L=0.075)
POINT = FrequencyData(K180=0.0091, T180=0.199)
CONSTANTS = {
    name: value
    for section in ("pi_step", "pid_step", "pi_frequency", "pid_frequency", "pid_combined", "pid_combined_integrating")
    for name, value in getattr(amigo_constants, section)().items()
}


def test_every_constant_is_printed():
    printed = load("pid-report").values
    assert len(CONSTANTS) > 50
    assert not set(CONSTANTS) - set(printed)


@pytest.mark.parametrize("name", sorted(CONSTANTS))
def test_constant_as_printed(name):
    if name == "pi-integrating-Ti":  # printed 13.4; the limit of the stable rule, from which it comes, is 13.35
        assert CONSTANTS[name] * 20 == 267
        return
    assert Fraction(int(CONSTANTS[name].p), int(CONSTANTS[name].q)) == load("pid-report").values[name].fraction


@pytest.mark.parametrize("name", sorted(CONSTANTS))
def test_another_digit_would_be_seen(name):
    value = load("pid-report").values[name]
    altered = str(Decimal(value.printed) + Decimal(1).scaleb(Decimal(value.printed).as_tuple().exponent))
    assert value_verdict(replace(value, printed=altered), Computed(quoted=CONSTANTS[name])) == UNEXPLAINED


SLIPS = {
    "L left out of K": ("pi_step", lambda r: {"K": r.K.subs(letters.L, 1)}),
    "L left out of Ti": ("pid_step", lambda r: {"Ti": r.Ti / letters.L}),
    "thresholds swapped": ("pid_step", lambda r: {"b_above": expressions.pi_step().b_above}),
    "a digit of Td": ("pid_step", lambda r: {"Td": r.Td * sympy.Rational(6, 5)}),
    "a power of kappa": ("pid_frequency", lambda r: {"K": r.K.subs(letters.kappa**4, letters.kappa**3)}),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_in_a_rule_turns_a_constant_red(slip, monkeypatch):
    """The constants are read back out of the expressions, so a slip there shows beside the print."""
    name, change = SLIPS[slip]
    rule = getattr(expressions, name)()
    monkeypatch.setattr(expressions, name, lambda: replace(rule, **change(rule)))
    try:
        found = getattr(amigo_constants, name).__wrapped__()
    except amigo_constants.UnitError as error:
        assert slip.startswith("L left out") and "no pure number: L remain" in str(error)
        return
    printed = load("pid-report").values
    assert any(value_verdict(printed[id], Computed(quoted=value)) == UNEXPLAINED for id, value in found.items())


FIGURES = {
    "fig5.8": (tune(STEP, "amigo-step-pi"), {"K": "4.1333", "Ti": "0.5389", "b": "0", "ki": "7.6696"}),
    "fig5.9": (
        tune(STEP, "amigo-step-pid"),
        {"K": "6.4400", "Ti": "0.3612", "Td": "0.0367", "b": "0", "ki": "17.8308"},
    ),
    "fig5.10": (
        tune(POINT, "amigo-frequency-pi", Kp=1.0, extrapolate=True),
        {"K": "17.5824", "Ti": "0.1912", "ki": "91.9719", "kappa": "0.0091"},
    ),
    "fig5.11": (
        tune(POINT, "amigo-frequency-pid", Kp=1.0, extrapolate=True),
        {"K": "32.9670", "Ti": "0.1173", "Td": "0.0298", "ki": "281.1309"},
    ),
    "fig5.13": (
        tune(TwoLagData(1, 0.9988, 0.1057, 0.0102), "amigo-combined-pid", tau=STEP.tau),
        {"K": "58.5810", "Ti": "0.1291", "Td": "0.0521", "b": "0", "ki": "453.7330"},
    ),
}


@pytest.mark.parametrize(("figure", "name"), [(f, n) for f, (_, numbers) in FIGURES.items() for n in numbers])
def test_figure_output(figure, name):
    tuning, numbers = FIGURES[figure]
    assert rounds_to(tuning.values[name] if name == "kappa" else getattr(tuning, name), numbers[name])


@settings(deadline=None, max_examples=30)
@given(st.floats(0.05, 20), st.floats(0.05, 20), st.floats(0.05, 20), st.floats(0.1, 10))
def test_rules_scale_with_gain_and_time(Kp, T, L, stretch):
    """A process with times stretched and gain doubled: K halves, the times stretch. Catches a missing L or Kp."""
    for rule in ("amigo-step-pi", "amigo-step-pid"):
        one, two = tune(StepData(Kp, T, L), rule), tune(StepData(2 * Kp, stretch * T, stretch * L), rule)
        assert math.isclose(two.K, one.K / 2, rel_tol=1e-9)
        assert math.isclose(two.Ti, stretch * one.Ti, rel_tol=1e-9)
        assert math.isclose(two.Td, stretch * one.Td, rel_tol=1e-9)
    one = tune(TwoLagData(Kp, T, T / 2, L), "amigo-combined-pid", tau=0.2)
    two = tune(TwoLagData(2 * Kp, stretch * T, stretch * T / 2, stretch * L), "amigo-combined-pid", tau=0.2)
    assert math.isclose(two.K, one.K / 2, rel_tol=1e-9)
    assert math.isclose(two.Ti, stretch * one.Ti, rel_tol=1e-9)
    assert math.isclose(two.Td, stretch * one.Td, rel_tol=1e-9)


@settings(deadline=None, max_examples=30)
@given(st.floats(0.05, 20), st.floats(0.05, 20), st.floats(0.1, 10))
def test_integrating_rules_scale_with_gain_and_time(Kv, L, stretch):
    """Kv carries 1/s: times stretched by k at the same Kv is K/k. The printed K = 0.45/Kv fails here."""
    for rule in ("amigo-step-pi-integrating", "amigo-step-pi-limit", "amigo-step-pid-integrating"):
        one, two = tune(IntegratingStepData(Kv, L), rule), tune(IntegratingStepData(2 * Kv, stretch * L), rule)
        assert math.isclose(two.K, one.K / (2 * stretch), rel_tol=1e-9)
        assert math.isclose(two.Ti, stretch * one.Ti, rel_tol=1e-9)
    one = tune(IntegratingPulseData(Kv, L / 3, L), "amigo-combined-pid-integrating")
    two = tune(IntegratingPulseData(2 * Kv, stretch * L / 3, stretch * L), "amigo-combined-pid-integrating")
    assert math.isclose(two.K, one.K / (2 * stretch), rel_tol=1e-9)
    assert math.isclose(two.Td, stretch * one.Td, rel_tol=1e-9)


@pytest.mark.parametrize(
    ("rule", "integrating"),
    [("amigo-step-pi", "amigo-step-pi-limit"), ("amigo-step-pid", "amigo-step-pid-integrating")],
)
def test_a_very_slow_lag_is_an_integrator(rule, integrating):
    slow, limit = tune(StepData(Kp=1e8, T=1e8, L=1), rule), tune(IntegratingStepData(Kv=1, L=1), integrating)
    for name in ("K", "Ti", "Td"):
        assert math.isclose(getattr(slow, name), getattr(limit, name), rel_tol=1e-6)


def test_combined_rule_of_a_very_slow_lag_is_the_integrating_one():
    slow = tune(TwoLagData(Kp=1e8, T1=1e8, T2=0.5, L1=1), "amigo-combined-pid", tau=0.0)
    limit = tune(IntegratingPulseData(Kv=1, T2=0.5, L1=1), "amigo-combined-pid-integrating")
    for name in ("K", "ki", "kd"):
        assert math.isclose(getattr(slow, name), getattr(limit, name), rel_tol=1e-6)


@pytest.mark.parametrize(
    ("rule", "threshold"), [("amigo-step-pi", Fraction(3, 10)), ("amigo-step-pid", Fraction(1, 2))], ids=["PI", "PID"]
)
def test_set_point_weight_switches_above_its_threshold(rule, threshold):
    tau = float(threshold)
    at, above = StepData(1, 1 - tau, tau), StepData(1, 1 - tau - 1e-6, tau + 1e-6)
    assert (tune(at, rule).b, tune(above, rule).b) == (0.0, 1.0)


def test_pid_step_says_that_it_is_conservative_for_a_lag():
    assert any("conservative" in note for note in tune(STEP, "amigo-step-pid").notes)
    assert not tune(StepData(1, 0.2, 1), "amigo-step-pid").notes


def test_filter_adjustment():
    assert filtered_data.with_filter(STEP, 0.01) == StepData(1, 1.045, 0.08)
    adjusted = filtered_data.with_filter(TwoLagData(1, 2, 1, 0.5), 0.2)
    assert (adjusted.T1, adjusted.T2, adjusted.L1) == (2, 1.1, 0.6)


def test_frequency_rule_for_an_integrating_process_is_kappa_zero():
    found = tune(POINT, "amigo-frequency-pid", Kp=math.inf, extrapolate=True)
    rule = amigo_integrating.frequency_integrating(expressions.pid_frequency())
    at = {letters.K_180: 0.0091, letters.T_180: 0.199}
    assert found.values["kappa"] == 0
    for name in ("K", "Ti", "Td"):
        assert math.isclose(getattr(found, name), float(getattr(rule, name).subs(at)), rel_tol=1e-12)


REFUSED = {
    "step rule on an integrator": (
        lambda: tune(IntegratingStepData(1, 1), "amigo-step-pi"),
        "amigo-step-pi: the process integrates: .*use simc-pi-integrating, amigo-step-pi-integrating",
    ),
    "no dead time": (lambda: tune(StepData(1, 1, 0), "amigo-step-pid"), "without dead time"),
    "lag-dominated": (lambda: tune(POINT, "amigo-frequency-pi", Kp=1.0), "use amigo-combined-pid"),
    "integrating": (lambda: tune(POINT, "amigo-frequency-pid", Kp=math.inf), "use amigo-step-pi-integrating"),
    "kappa above one": (lambda: tune(FrequencyData(2, 1), "amigo-frequency-pi", Kp=1.0), "check K180 and Kp"),
    "tau": (lambda: tune(TwoLagData(1, 1, 1, 1), "amigo-combined-pid", tau=1.5), "tau = 1.5"),
    "filter for frequency data": (
        lambda: filtered_data.with_filter(POINT, 0.1),
        "adjusts StepData and TwoLagData only",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_the_rule_that_applies(case):
    call, words = REFUSED[case]
    with pytest.raises(RuleDoesNotApply, match=words):
        call()


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [(StepData, (-1, 1, 1)), (StepData, (1, -1, 1)), (StepData, (1, 0, 0)), (FrequencyData, (0, 1))],
)
def test_data_that_no_process_gives(kind, numbers):
    with pytest.raises(DataError):
        kind(*numbers)
