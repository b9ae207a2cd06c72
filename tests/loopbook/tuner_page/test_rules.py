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
}
CLOSED = 5.0
ASK = """(name, process, wish) => {
    try {
        return page.settingsBy(page.rules.find((rule) => rule.name === name), process, wish);
    } catch (error) {
        return { refused: error.message, stack: error.constructor === Error ? error.stack : "" };
    }
}"""


def options_of(rule, process):
    """The options that a rule must have, as the page fills them."""
    if "w" in rule.required:
        return {"w": 0.2, "phase_margin": 60.0}
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
        wish = {"w": 0.2, "margin": 60.0} | ({"closed": CLOSED} if {"closed", "i"} & set(options) else {})
        found = ask(ASK, name, given, wish)
        try:
            ours = rule(process, **options)
        except Refusal:
            assert found.get("refused") and "TypeError" not in found["stack"], name
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


def test_the_formulas_that_are_shown_are_those_that_compute(ask):
    """The equations are text of the same expressions: evaluated as such they give the rule's numbers."""
    rule = next(r for r in ask("() => page.rules") if r["name"] == "amigo-step-pid")
    L, T, K_p = 3.0, 10.0, 2.0
    shown = {text.partition(" = ")[0]: text.partition(" = ")[2] for text in rule["equations"]}
    settings = ask(ASK, "amigo-step-pid", {"num": [K_p], "den": [T, 1.0], "delay": L}, {})
    for name, key in (("K", "K"), ("T_i", "Ti"), ("T_d", "Td")):
        value = read_formula(shown[name]).subs({"L": L, "T": T, "K_p": K_p})
        assert math.isclose(float(value), settings[key], rel_tol=1e-9)
