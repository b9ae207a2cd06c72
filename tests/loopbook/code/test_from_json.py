"""The JSON of a design, or one written by hand, as a controller; and what is said where it is wrong."""

import copy
import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopbook.code import CodeError, controller, emit, regulator_from_json
from loopbook.code.block import harmless, identifier
from loopbook.code.languages import languages
from loopbook.design.study import Study

OWN = Path(__file__).parents[3] / "notebooks" / "own_process"
PID = {
    "form": "standard",
    "name": "heater",
    "settings": {"K": 2.0, "Ti": 10.0, "Td": 1.0, "Tf": 0.1, "b": 0.5, "h": 0.5},
    "limits": {"u_low": 0.0, "u_high": 100.0},
    "start": {"u": 35.0, "y": 20.0},
    "signals": {
        "y": {"name": "temperature", "unit": "°C", "span": [0, 150], "raw": [0, 27648]},
        "u": {"name": "valve", "unit": "%", "span": [0, 100], "raw": [0, 4095]},
    },
}
RST = {"form": "rst", "R": [1, -1.2, 0.2], "S": [3, -1.6], "T": [1.4], "observer": [1, -0.5], "h": 1.0}
ON_OFF = {"form": "on-off", "settings": {"hysteresis": 0.5}, "limits": {"u_low": 0, "u_high": 1}}
ZONES = {
    "form": "scheduled",
    "zones": [{"K": 1.0, "Ti": 10.0, "Td": 1.0}, {"K": 2.0, "Ti": 5.0}],
    "edges": [10.0],
    "hysteresis": 1.0,
    "settings": {"h": 0.5, "Tf": 0.1},
}
SMITH = {**PID, "form": "smith", "model": {"gain": 2.0, "time_constant": 10.0, "delay": 3.3}}
ALL = {"standard": PID, "rst": RST, "on-off": ON_OFF, "scheduled": ZONES, "smith": SMITH}


def without(data: dict, *path: str) -> dict:
    data = copy.deepcopy(data)
    inside = data
    for key in path[:-1]:
        inside = inside[key]
    del inside[path[-1]]
    return data


def altered(data: dict, value, *path: str) -> dict:
    data = copy.deepcopy(data)
    inside = data
    for key in path[:-1]:
        inside = inside[key]
    inside[path[-1]] = value
    return data


@pytest.mark.parametrize("form", ALL)
def test_every_form_is_read_and_written_in_every_language(form):
    block = regulator_from_json(ALL[form])
    for target in languages():
        assert all(emit(block, target).values())
    assert controller(block).u is not None


def test_the_numbers_are_those_of_the_json():
    block = regulator_from_json(PID)
    assert block.name == "heater" and block.rest == (35.0, 20.0)
    assert {k: block.settings()[k] for k in PID["settings"]} == PID["settings"]
    assert regulator_from_json(altered(PID, None, "limits", "u_high")).settings()["u_high"] == math.inf
    assert regulator_from_json(without(PID, "settings", "Ti")).settings()["Ti"] == 0


def test_the_scaling_goes_through_both_ends():
    loop = controller(regulator_from_json(PID))
    assert (loop.measurement(0.0), loop.measurement(27648.0), loop.measurement(13824.0)) == (0, 150, 75)
    assert (loop.actuator(0.0), loop.actuator(100.0)) == (0, 4095)
    for target, words in {"c": "temperature [°C]: 0..27648", "js": "valve [%]: 0..100", "py": "0..4095"}.items():
        assert words in "".join(emit(regulator_from_json(PID), target).values())
    assert "FUNCTION FC_Heater_Measurement : REAL" in emit(regulator_from_json(PID), "st")["heater_scaling.st"]
    bare = emit(regulator_from_json(without(PID, "signals")), "c")
    assert "_measurement(lb_real" not in bare["heater.h"]


@pytest.mark.builds
def test_the_json_beside_the_notebook_is_that_of_its_record():
    shipped = json.loads((OWN / "regulator.json").read_text(encoding="utf-8"))
    designed = Study(OWN / "example.csv", u_low=0.0, u_high=100.0).results()
    for part in ("settings", "gains", "start", "limits"):
        numbers = {k: v for k, v in designed[part].items() if k != "formulas"}
        assert {k: shipped[part][k] for k in numbers} == pytest.approx(numbers, rel=1e-6)


WRONG = [
    (without(PID, "form"), "form is missing"),
    (altered(PID, "pid", "form"), "form = 'pid'; one of standard, rst"),
    (without(PID, "settings", "K"), "K is missing"),
    (altered(PID, "2", "settings", "K"), "K = '2': a number expected"),
    (altered(PID, True, "settings", "K"), "K = True: a number expected"),
    (altered(PID, math.nan, "settings", "Ti"), "Ti = nan"),
    (altered(PID, -1.0, "settings", "Ti"), "Ti = -1.0 is outside its range"),
    (altered(PID, 1.0, "settings", "Tx"), "Tx unknown"),
    (altered(PID, [], "limits"), "limits = []: an object expected"),
    (altered(PID, 200.0, "limits", "u_low"), "u_low"),
    (altered(PID, [0], "signals", "y", "span"), "two numbers expected"),
    (altered(PID, [5, 5], "signals", "y", "raw"), "two finite numbers that differ"),
    (without(PID, "signals", "y", "raw"), "span and raw belong together"),
    (altered(PID, {"u": 1.0}, "start"), "y is missing"),
    (without(RST, "S"), "S is missing"),
    (altered(RST, [1, "x"], "R"), "R = "),
    (altered(RST, [0, 1], "R"), "no term without delay"),
    (altered(RST, [1, -2], "observer"), "not stable"),
    (altered(ON_OFF, {}, "limits"), "two outputs"),
    (altered(ZONES, [1.0, 2.0], "edges"), "2 zones and 2 edges"),
    (altered(ZONES, [], "zones"), "K is missing"),
    (altered(SMITH, 0, "model", "delay"), "delay = 0"),
    (without(SMITH, "model", "gain"), "gain is missing"),
    ([1], "an object with form and settings expected"),
]


@pytest.mark.parametrize(("data", "words"), WRONG, ids=lambda v: v if isinstance(v, str) else "")
def test_what_is_wrong_is_said(data, words):
    with pytest.raises(CodeError) as said:
        regulator_from_json(data)
    assert words in str(said.value)


@pytest.mark.parametrize(("text", "words"), [("{", "no JSON"), ("\x00", "no JSON"), ("[]", "an object with form")])
def test_a_file_that_is_no_json_is_said(tmp_path, text, words):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(CodeError, match=words):
        regulator_from_json(tmp_path / "a.json")


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@given(st.sampled_from(sorted(ALL)), st.data())
def test_any_json_in_any_place_is_read_or_refused_in_words(form, data):
    value, whole = data.draw(JSON), copy.deepcopy(ALL[form])
    inside, path = whole, []
    while True:
        key = data.draw(st.sampled_from(sorted(inside) if isinstance(inside, dict) else range(len(inside))))
        path.append(key)
        if not isinstance(inside[key], dict | list) or not inside[key] or data.draw(st.booleans()):
            break
        inside = inside[key]
    inside[key] = value
    try:
        block = regulator_from_json(whole)
    except CodeError as error:
        assert str(error)
    else:
        for target in languages():
            emit(block, target)


EVIL = '*/ *) """ \\ \n\r\u2028\u2029\x85 */ #include <x> ??/ ${1} `'


def test_text_from_the_json_stays_text():
    evil = altered(altered(PID, EVIL, "signals", "y", "name"), EVIL, "signals", "u", "unit") | {
        "data": EVIL,
        "rule": EVIL,
    }
    plain, block = regulator_from_json(PID), regulator_from_json(evil | {"name": EVIL + "heater"})
    assert block.name == identifier(EVIL + "heater")
    block = block.named("heater")

    def code(text: str, begin: str) -> str:
        return text[text.index(begin) :]

    for target, begin in {"js": "function heater", "st": "FUNCTION_BLOCK", "py": "class Heater"}.items():
        name = f"heater.{target}"
        ours, theirs = (emit(b, target)[name] for b in (plain, block))
        same = [line for line in code(theirs, begin).splitlines() if "°C" not in line and "/ )" not in line]
        assert len(same) >= len(code(ours, begin).splitlines()) - 6
    for line in emit(block, "js")["heater.js"].split("function heater")[0].splitlines():
        assert line.startswith("//")
    compile(emit(block, "py")["heater.py"], "heater", "exec")


@given(st.text())
def test_a_comment_cannot_be_left(text):
    made = harmless(text)
    assert not any(mark in made for mark in ("*/", "/*", "*)", "(*", '"', "\\")) and made.isprintable()


@given(st.text())
def test_any_text_gives_a_name_that_every_language_takes(text):
    regulator_from_json(PID | {"name": text or "pid"})
    name = identifier(text)
    assert name.isidentifier() and name == name.lower() and "__" not in name
