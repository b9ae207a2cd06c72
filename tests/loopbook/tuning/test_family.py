"""The tuning rules as one family: every rule has one form, follows its process, and is found by its name."""

import math
import re
import textwrap
from pathlib import Path

import pytest

from derivations.tuning.catalogue import catalogue
from derivations.tuning.letters import QUANTITIES
from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidStandard
from loopbook.documents.pid_report.batch.processes import four_lags
from loopbook.experiments import relay, step
from loopbook.experiments.data import (
    FrequencyData,
    IntegratingPulseData,
    IntegratingStepData,
    StepData,
    TwoLagData,
)
from loopbook.experiments.plant import Plant
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.tuning import RULES, RuleDoesNotApply, Tuning, UnknownRule, tune
from loopbook.tuning.process_data import ProcessData

ROOT = Path(__file__).parents[3]
STABLE = Process([2], [40, 14, 1], 3)
BALANCED = Process([2], [40, 14, 1], 10)  # kappa > 0.2: the frequency rules cover it
INTEGRATING = Process([0.2], [4, 1, 0], 3)
LAG = Process([2], [5, 1])
GIVEN = {"closed": 5.0, "i": 0.5, "w": 0.1, "phase_margin": 60.0, "w0": 0.5, "zeta": 0.7}
OWN = {"phase-margin-pi": {"w": 0.05}}  # a frequency at which a PI controller has that margin


def fitting(rule) -> Process:
    if rule.name.startswith("first-order") or rule.name == "damping-pi":
        return LAG
    if rule.name == "damping-pid":
        return STABLE.rational
    return INTEGRATING if rule.integrating else BALANCED


def asked(rule, **scaled) -> dict:
    given = {**GIVEN, **OWN.get(rule.name, {})}
    return {name: given[name] * scaled.get(name, 1.0) for name in rule.required}


@pytest.mark.parametrize("name", list(RULES))
def test_every_rule_gives_a_stable_loop_with_its_source(name):
    rule = RULES[name]
    tuning = rule(fitting(rule), **asked(rule))
    assert isinstance(tuning, Tuning) and isinstance(tuning.pid, PidStandard)
    assert (tuning.rule, tuning.source) == (name, rule.source) and rule.source and rule.aim and rule.text
    assert rule.action == "P" + "I" * math.isfinite(tuning.Ti) + "D" * bool(tuning.Td)
    assert rule.year is None or 1940 < rule.year < 2030
    assert Loop(fitting(rule), tuning).is_stable


@pytest.mark.parametrize("factor", [1e-6, 3600.0])
@pytest.mark.parametrize("name", list(RULES))
def test_every_rule_scales_with_time_and_gain(name, factor):
    """In other units of time and output the settings are the same regulator: K ~ 1/gain, Ti and Td ~ time."""
    rule, gain = RULES[name], 7.0
    process = fitting(rule)
    stretched = Process(
        [gain * c * factor ** (len(process.num) - 1 - i) for i, c in enumerate(process.num)],
        [c * factor ** (len(process.den) - 1 - i) for i, c in enumerate(process.den)],
        process.delay * factor,
    )
    one = rule(process, **asked(rule))
    other = rule(stretched, **asked(rule, closed=factor, w=1 / factor, w0=1 / factor))
    assert other.K == pytest.approx(one.K / gain, rel=1e-6)
    assert other.Ti == pytest.approx(one.Ti * factor, rel=1e-6)
    assert other.Td == pytest.approx(one.Td * factor, rel=1e-6)
    assert len(other.notes) == len(one.notes)


@pytest.mark.parametrize("name", list(RULES))
def test_a_process_that_falls_gets_the_same_settings_with_the_other_sign(name):
    rule = RULES[name]
    up, down = rule(fitting(rule), **asked(rule)), rule(fitting(rule) * -1.0, **asked(rule))
    assert (down.K, down.Ti, down.Td) == (-up.K, up.Ti, up.Td) and "other sign" in down.notes[-1]


@pytest.mark.parametrize("name", list(catalogue()))
def test_every_letter_of_a_formula_stands_for_a_quantity_or_is_an_option(name):
    rule = catalogue()[name]
    used = set().union(*(e.free_symbols for e in (rule.K, rule.Ti, rule.Td)))
    assert used <= set(rule.inputs)
    assert all(letter in QUANTITIES or str(letter) in RULES[name].options for letter in rule.inputs)


DATA = {
    Takes.STEP: StepData(2, 10, 3),
    Takes.INTEGRATING_STEP: IntegratingStepData(0.2, 3),
    Takes.FREQUENCY: FrequencyData(0.5, 20),
    Takes.FREQUENCY_AND_GAIN: (StepData(2, 10, 3), FrequencyData(0.5, 20)),
    Takes.TWO_LAGS: TwoLagData(2, 10, 4, 3),
    Takes.PULSE: IntegratingPulseData(0.2, 4, 3),
    Takes.ONE_LAG: StepData(2, 10, 3),
}


@pytest.mark.parametrize(
    "name", [n for n in catalogue() if RULES[n].takes in DATA and RULES[n].integrating is not True]
)
def test_data_as_given_are_taken_as_they_are(name):
    rule = RULES[name]
    data = StepData(2, 10, 0) if name.startswith("first-order") else DATA[rule.takes]
    tuning = rule(data, **asked(rule))
    given = data[1] if isinstance(data, tuple) else data
    names = {"StepData": ("Kp", "T", "L"), "FrequencyData": ("K180", "T180"), "TwoLagData": ("Kp", "T1", "T2", "L1")}
    for field in names[type(given).__name__]:
        assert tuning.values[field] == getattr(given, field)


@pytest.mark.parametrize(
    ("rule", "process", "how"),
    [
        ("zn-step-pi", STABLE, "tangent and 63 % of the exact step response"),
        ("zn-step-pi", Process.fopdt(2, 10, 3), "its own gain, lag and dead time"),
        ("simc-pi", STABLE, "half rule on 2 lags"),
        ("simc-pi", Process([1], [1, 4, 6, 4, 1]), "half rule on 4 lags"),
        ("simc-pid", STABLE, "its own lags and dead time"),
        ("zn-ultimate-pi", STABLE, "exact point at -180 degrees"),
        ("amigo-combined-pid", STABLE, "its own lags and dead time"),
        ("amigo-combined-pid", four_lags(0.1), "step response and point at -180 degrees together"),
        ("amigo-step-pi-integrating", INTEGRATING, "final tangent of the exact step response"),
        ("migo-pi", STABLE, ""),
    ],
)
def test_a_process_is_reduced_by_a_named_method(rule, process, how):
    assert tune(process, rule).known_by == how


def test_the_half_rule_of_four_equal_lags():
    values = tune(Process([1], [1, 4, 6, 4, 1]), "simc-pi").values
    assert (values["T"], values["L"]) == pytest.approx((1.5, 2.5), rel=1e-3)


def test_what_the_half_rule_does_not_cover_is_refused_with_the_way_out():
    for process in (Process([1], [1, 0.2, 1], 1), Process([1, 1], [2, 3, 1], 1)):
        with pytest.raises(RuleDoesNotApply, match=r"use loopbook\.experiments\.step\.step_data\(process\)"):
            tune(process, "simc")
        assert tune(step.step_data(process), "simc").K > 0


@pytest.mark.parametrize(
    ("known", "name", "action", "rule"),
    [
        (STABLE, "simc", "", "simc-pi"),
        (STABLE, "simc", "pid", "simc-pid"),
        (INTEGRATING, "simc", "", "simc-pi-integrating"),
        (STABLE, "amigo", "PID", "amigo-step-pid"),
        (INTEGRATING, "amigo", "PID", "amigo-step-pid-integrating"),
        (TwoLagData(2, 10, 4, 3), "amigo combined", "", "amigo-combined-pid"),
        (FrequencyData(0.5, 20), "ziegler-nichols", "PID", "zn-ultimate-pid"),
        (StepData(2, 10, 3), "Ziegler-Nichols", "P", "zn-step-p"),
        (STABLE, "Ziegler-Nichols ultimate, PI", "", "zn-ultimate-pi"),
        (STABLE, "zn-ultimate-pid-article", "", "zn-ultimate-pid-article"),
        (STABLE, "CHR 20", "PI", "chr-pi-20"),
        (STABLE, "lambda", "", "lambda-pi"),
        (STABLE, "MIGO", "", "migo-pi"),
    ],
)
def test_a_name_means_what_data_and_action_leave(known, name, action, rule):
    assert tune(known, name, action).rule == rule


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("simk", "simc"),
        ("amigo-setp-pi", "amigo-step-pi"),
        ("Zigler-Nichols step, PI", "zn-step-pi"),
        ("qqq", "known: "),
    ],
)
def test_an_unknown_rule_is_refused_with_the_nearest(name, near):
    with pytest.raises(UnknownRule, match=near):
        tune(STABLE, name)
    with pytest.raises(UnknownRule, match=near):
        RULES[name]
    assert name not in RULES


def test_every_rule_at_once_with_the_reasons_of_those_that_refuse():
    found = tune(STABLE, all=True)
    assert {"simc-pi", "amigo-step-pid", "migo-pid", "zn-ultimate-p"} <= set(found)
    assert "dominated by its lag" in found.refused["amigo-frequency-pi"]
    assert not set(found) & {"zn-step-pi-article", "first-order-pi", "simc-pi-integrating", "phase-margin-pid"}
    assert {RULES[name].action for name in tune(STABLE, all=True, action="PI")} == {"PI"}
    assert "simc-pi" in str(found) and "<td>simc-pi</td>" in found._repr_html_()


def test_several_rules_with_the_options_that_each_has():
    found = tune(STABLE, ["lambda", "simc", "amigo"], closed=6)
    assert list(found) == ["lambda-pi", "simc-pi", "amigo-step-pi"]
    assert found["lambda-pi"].values["closed"] == found["simc-pi"].values["closed"] == 6


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: tune(STABLE, "simc", clsoed=3), TypeError, "simc-pi has no option 'clsoed'; its options: closed"),
        (lambda: tune(STABLE, ["simc"], w=3), TypeError, "none of simc-pi has an option 'w'"),
        (lambda: tune(3.0, "simc"), TypeError, "float says nothing of a process"),
        (lambda: tune(STABLE), RuleDoesNotApply, "needs a rule's name"),
        (lambda: tune(FrequencyData(1, 1), "simc"), RuleDoesNotApply, "cannot be told from frequency data alone"),
        (lambda: tune(Process([1], [1, -1], 1), "simc"), RuleDoesNotApply, "unstable by itself"),
        (lambda: tune(STABLE, "migo", "P"), UnknownRule, "'migo' has no P; it has migo-pi, migo-pid"),
    ],
)
def test_what_cannot_be_tuned_says_why(call, error, words):
    with pytest.raises(error, match=words):
        call()


def test_what_an_experiment_found_is_taken():
    found = relay.estimate(relay.apply_relay(Plant(STABLE)))
    assert tune(found, "ziegler-nichols", "PID").values["T180"] == found.data.T180
    assert ProcessData.of(found, StepData(2, 10, 3)).numbers(Takes.FREQUENCY_AND_GAIN)[0]["kappa"] > 0


def test_a_phase_margin_is_had_at_its_frequency():
    tuning = tune(STABLE, "phase margin", "PID", w=0.2, phase_margin=60)
    margins = Loop(STABLE, tuning.pid).margins()
    assert margins.phase == pytest.approx(60, abs=1e-6) and margins.gain_crossovers[0].w == pytest.approx(0.2, rel=1e-9)


def test_a_rule_is_one_file(tmp_path, monkeypatch):
    """The file that CONTRIBUTING shows, in the folder of the derivations, is a rule of the family and of the design."""
    import importlib
    import sys

    import derivations.tuning as folder
    from derivations.tuning import catalogue as published
    from loopbook.design.candidates import candidates
    from loopbook.design.model import Model
    from loopbook.tuning import registry

    how_to = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("## How to add a tuning rule")[2]
    pessen = textwrap.dedent(re.search(r"```python\n(.*?)```", how_to, re.DOTALL)[1])
    (tmp_path / "pessen.py").write_text(pessen, encoding="utf-8")
    monkeypatch.setattr(folder, "__path__", [*folder.__path__, str(tmp_path)])
    importlib.invalidate_caches()
    try:
        for cached in (published.catalogue, registry.rules):
            cached.cache_clear()
        rule = RULES["pessen-pid"]
        assert (rule.action, rule.takes, rule.year, rule.integrating) == ("PID", Takes.FREQUENCY, 1994, None)
        tuning = tune(FrequencyData(0.5, 20), "pessen")
        assert (tuning.K, tuning.Ti, tuning.Td) == pytest.approx((1.4, 8, 3))
        assert "Pessen, PID" in {c.name for c in candidates(Model(2.0, (10.0,), 3.0))[0]}
    finally:
        sys.modules.pop("derivations.tuning.pessen", None)
        for cached in (published.catalogue, registry.rules):
            cached.cache_clear()
