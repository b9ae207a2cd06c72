"""Every rule of the registry in the page: the settings of Python, or a refusal where Python refuses."""

import math

import pytest

from loopbook.process.construct import tf
from loopbook.refusal import Refusal
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.registry import rules
from notebook_reports.formula.read import read_formula

PROCESSES = {
    "one lag": tf(2, [10, 1], 3),
    "two lags": tf(2, [[10, 1], [4, 1]], 3),
    "negative gain": tf(-2, [[10, 1], [4, 1], [1, 1]], 3),
    "no dead time": tf(2, [[10, 1], [4, 1], [1, 1]], 0),
    "integrating, a lag": tf(2, [[10, 1], [1, 0]], 3),
    "integrating": tf(2, [1, 0], 3),
    "inverse response": tf([-1, 1], [[10, 1], [3, 1]], 3),
    "a zero": tf([1, 1], [[10, 1], [3, 1]], 3),
    "complex poles": tf(1, [4, 1, 1], 1),
    "unstable": tf(1, [4, -1], 1),
    "four lags": tf(1, [[1, 1], [0.5, 1], [0.25, 1], [0.1, 1]], 0),
    "long dead time": tf(1, [10, 1], 50),
    "one lag alone": tf(2, [10, 1], 0),
    "a lag as fast as the loop": tf(2, [1, 1], 0),
    "two lags alone": tf(2, [[10, 1], [4, 1]], 0),
    "two fast lags alone": tf(-2, [[1, 1], [0.1, 1]], 0),
    "a lag with an integrator alone": tf(-3, [[10, 1], [1, 0]], 0),
    "an integrator alone": tf(3, [1, 0], 0),
    "unstable, one pole alone": tf(1, [4, -1], 0),
    "unstable, a lag": tf(1, [[4, -1], [1, 1]], 0),
    "unstable, of negative gain": tf(-1, [4, -1], 1),
    "unstable, a pair": tf(1, [4, -1, 1], 0),
    "unstable, two real poles": tf(1, [[4, -1], [3, -1]], 0),
}
CLOSED = 5.0
ASK = """(name, process, wish) => {
    try {
        return page.settingsBy(page.rules.find((rule) => rule.name === name), process, wish);
    } catch (error) {
        return { refused: error.message, kind: error.name };
    }
}"""


def options_of(rule, process):
    """The options that a rule must have, as the page fills them."""
    if "w" in rule.required:
        return {"w": 0.2, "phase_margin": 60.0}
    if "w0" in rule.required:
        return {"w0": 0.2, "zeta": 0.7}
    if "closed" in rule.required:
        return {"closed": CLOSED}
    if "i" in rule.required:
        try:
            return {"i": CLOSED / ProcessData.of(process).numbers(rule.takes)[0]["T"]}
        except Refusal:
            return {"i": 1.0}
    return {}


@pytest.mark.long
@pytest.mark.parametrize("process", PROCESSES.values(), ids=PROCESSES)
def test_the_settings_of_every_rule(ask, process):
    given = {"num": list(process.num), "den": list(process.den), "delay": process.delay}
    for name, rule in rules().items():
        options = options_of(rule, process)
        wish = {"w": 0.2, "margin": 60.0, "zeta": 0.7} | ({"closed": CLOSED} if {"closed", "i"} & set(options) else {})
        found = ask(ASK, name, given, wish)
        try:
            ours = rule(process, **options)
        except Refusal:
            assert found.get("refused") and found["kind"] == "Error", (name, found)
            continue
        assert "refused" not in found, (name, found)
        # the page keeps no filter where the rule has no derivative
        for key, value in (("K", ours.K), ("Ti", ours.Ti), ("Td", ours.Td), ("b", ours.b)):
            assert found[key] == pytest.approx(value, rel=1e-8), (name, key)
        assert found["Tf"] == pytest.approx(ours.as_built().Tf, rel=1e-8), name
        own = [note for note in ours.notes if not note.startswith("the process answers with the other sign")]
        assert found["notes"] == own, name


def test_the_page_has_every_rule_and_says_whose_it_is(ask):
    found = {rule["name"]: rule for rule in ask("() => page.rules")}
    assert set(found) == set(rules())
    for name, rule in rules().items():
        assert found[name]["title"] == rule.title and found[name]["action"] == rule.action
        assert found[name]["source"] == rule.source and found[name]["integrating"] == rule.integrating
        assert found[name].get("variantOf", "") == rule.variant_of


def test_a_rule_without_its_wish_says_what_it_needs(ask):
    process = {"num": [2.0], "den": [10.0, 1.0], "delay": 0.0}
    wishes = {"w": 0.3, "margin": 60.0, "zeta": 0.7, "closed": 5.0}
    asking = {rule["name"]: rule["asks"] for rule in ask("() => page.rules") if rule.get("asks")}
    assert {"phase-margin-pi", "phase-margin-pid", "damping-pi", "damping-pid"} <= set(asking)
    for name, asks in asking.items():
        for missing in asks:
            found = ask(ASK, name, process, {key: wish for key, wish in wishes.items() if key != missing} | {"w0": 0.3})
            wanted = {"w": "frequency", "margin": "margin", "zeta": "damping"}.get(missing, "time constant")
            if missing != "i":
                assert found["kind"] == "Error" and wanted in found["refused"], (name, missing, found)


def test_the_formulas_that_are_shown_are_those_that_compute(ask):
    """The equations are text of the same expressions: evaluated as such they give the rule's numbers."""
    rule = next(r for r in ask("() => page.rules") if r["name"] == "amigo-step-pid")
    L, T, K_p = 3.0, 10.0, 2.0
    shown = {text.partition(" = ")[0]: text.partition(" = ")[2] for text in rule["equations"]}
    settings = ask(ASK, "amigo-step-pid", {"num": [K_p], "den": [T, 1.0], "delay": L}, {})
    for name, key in (("K", "K"), ("T_i", "Ti"), ("T_d", "Td")):
        value = read_formula(shown[name]).subs({"L": L, "T": T, "K_p": K_p})
        assert math.isclose(float(value), settings[key], rel_tol=1e-9)
