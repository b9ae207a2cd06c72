"""What the page writes and reads: addresses, numbers, programs, models, words."""

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loopbook.code import emit, pid_block, regulator_from_json
from loopbook.controllers.pid_forms import FormError, PidParallel, PidSeries, PidStandard
from loopbook.design.model_file import read_model
from loopbook.tuner_page.files import of_file
from loopbook.tuner_page.settings import settings as page_settings

NUMBERS = st.floats(allow_nan=False, allow_infinity=False, width=64)
PLAIN = st.floats(1e-6, 1e6).map(lambda x: float(f"{x:.6g}"))


@settings(max_examples=300)
@given(NUMBERS)
def test_a_number_is_written_as_python_writes_it(ask, x):
    assert ask("page.pythonNumber", x) == repr(x)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1,5", 1.5),
        (" 2.25 ", 2.25),
        ("−3", -3.0),
        ("1e-3", 1e-3),
        ("1 000,5", 1000.5),
        (" inf", math.inf),
        ("∞", math.inf),
        (".5", 0.5),
    ],
)
def test_a_typed_number_is_read(ask, text, value):
    assert ask("page.typed", text) == value


@pytest.mark.parametrize("text", ["", "abc", "1.2.3", "1,2,3", "--1", "1e", "0x10", "NaN"])
def test_what_is_no_number_is_not_read(ask, text):
    assert ask("(text) => Number.isNaN(page.typed(text))", text) is True


KNOBS = {
    "K": PLAIN,
    "T1": PLAIN,
    "T2": PLAIN,
    "L": PLAIN,
    "Kc": PLAIN,
    "Ti": PLAIN | st.just(math.inf),
    "Td": PLAIN,
    "N": PLAIN,
}


@settings(max_examples=100)
@given(
    st.fixed_dictionaries(KNOBS),
    st.booleans(),
    st.sampled_from(["standard", "parallel", "series"]),
    st.none() | PLAIN,
    st.sampled_from(["pid", "rst"]),
)
def test_everything_is_in_the_address_and_comes_back(ask, knobs, integrating, form, high, kind):
    state = {
        **ask("() => page.DEFAULTS"),
        **knobs,
        "integrating": integrating,
        "form": form,
        "high": high,
        "kind": kind,
    }
    text = ask("(s) => page.toText(s, page.DEFAULTS)", state)
    back = ask("(text) => page.fromText(text, page.DEFAULTS)", text)
    assert back.keys() == state.keys()
    for key, value in state.items():
        assert back[key] == (pytest.approx(value, rel=1e-11) if type(value) is float else value), key
    assert set(text) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789=&.+-")


@pytest.mark.parametrize(
    "text",
    ["", "Q=3", "K=abc", "K=", "form=magic", "kind=", "Ti=NaN", "K", "&&", "__proto__=1", "constructor=1", "low=none"],
)
def test_a_broken_address_leaves_what_it_does_not_say(ask, text):
    assert ask("(text) => page.fromText(text, page.DEFAULTS)", text) == ask("() => page.DEFAULTS")


@settings(max_examples=60)
@given(PLAIN, PLAIN, PLAIN, st.floats(1, 50), st.sampled_from(["parallel", "series"]))
def test_the_forms_are_those_of_python(ask, K, Ti, Td, N, form):
    standard = PidStandard(K, Ti, Td, b=1.0, c=1.0, N=N)
    state = {"Kc": K, "Ti": Ti, "Td": Td, "N": N}
    found = ask("(form, s) => page.FORMS[form].read(s)", form, state)
    try:
        ours = getattr(standard, form)()
    except FormError:
        assert found is None
        return
    if found is None:  # on the border both may be right
        assert (Ti + Td / N) ** 2 == pytest.approx(4 * Ti * (Td + Td / N), rel=1e-9)
        return
    if isinstance(ours, PidParallel):
        assert found == pytest.approx({"P": ours.P, "I": ours.I, "D": ours.D, "Np": ours.N}, rel=1e-9)
    else:
        assert isinstance(ours, PidSeries)
        assert found["Ks"] == pytest.approx(ours.K, rel=1e-6) and found["Tis"] == pytest.approx(ours.Ti, rel=1e-6)
    back = ask("(form, v, s) => page.FORMS[form].write(v, s)", form, found, state)
    assert back["Kc"] == pytest.approx(K, rel=1e-6) and back["Ti"] == pytest.approx(Ti, rel=1e-6)
    assert back["Td"] == pytest.approx(Td, rel=1e-5)


SETTINGS = (
    {"K": 0.65, "Ti": 45.0, "Td": 6.0, "Tf": 0.6, "b": 0.5, "c": 0.0, "h": 2.0, "u_low": -1.5, "u_high": 3.25},
    {"K": -1e-7, "Ti": 1e20, "Td": 0.0, "Tf": 0.0, "b": 1.0, "c": 1.0, "h": 1e-5},
)


@pytest.mark.parametrize("given", SETTINGS)
def test_the_programs_of_the_page_are_those_that_are_emitted(ask, given):
    """C and Structured Text with the page's numbers: byte for byte what Python emits for these settings."""
    block = pid_block(**given)
    numbers = {**given, "u_low": given.get("u_low", -math.inf), "u_high": given.get("u_high", math.inf), "rate": 0.0}
    numbers["Tt"] = block.settings()["Tt"]
    found = ask("page.programTexts", numbers)
    assert found == {**emit(block, "c"), **emit(block, "st")}


STATE = {"K": 2.4, "T1": 40.0, "T2": 12.0, "T3": 0, "Tz": 0, "L": 8.0, "integrating": False}
REGULATOR = {"Kc": 0.7, "Ti": 32.5, "Td": 6.0, "N": 3.0, "b": 0.0, "c": 0.0, "low": -40.0, "high": None, "windup": True}


def test_the_model_is_one_that_a_design_reads(ask, tmp_path):
    state = {**ask("() => page.DEFAULTS"), **STATE}
    path = tmp_path / "process.toml"
    path.write_text(ask("(s) => page.modelToml(s, null)", state), encoding="utf-8")
    model = read_model(path)
    assert (model.gain, model.lags, model.delay, model.integrating) == (2.4, (40.0, 12.0), 8.0, False)
    assert ask("(s) => page.modelToml(s, null)", {**state, "T1": -4.0}) is None


def test_the_regulator_is_one_that_code_and_tune_read(ask, tmp_path):
    state = {**ask("() => page.DEFAULTS"), **STATE, **REGULATOR}
    text = ask("(s, h) => page.regulatorJson(s, null, h, 'oven', null)", state, 2.0)
    block = regulator_from_json(json.loads(text))
    assert block.name == "oven" and block.settings()["K"] == 0.7 and block.settings()["u_low"] == -40.0
    path = tmp_path / "regulator.json"
    path.write_text(text, encoding="utf-8")
    again = of_file(path).data["state"]
    for key in ("K", "T1", "T2", "L", "Kc", "Ti", "Td", "N", "b", "low", "high"):
        assert again[key] == pytest.approx(state[key]), key


EVALUATE = """(state, given) => {
    const usual = { ...page.DEFAULTS, ...state }, result = page.evaluate(usual, given ?? null);
    return {
        words: page.summary(usual, result, 1.83), numbers: page.numbersOf(result), found: result.numbers,
        stable: result.stable, error: result.error ?? "", Ms: result.margins && result.margins.Ms.value,
        ends: result.run && [result.run.y.length, result.span],
    };
}"""


def test_an_unstable_loop_has_words_and_no_numbers(ask):
    found = ask(EVALUATE, {"Kc": 9.0}, None)
    assert not found["stable"] and found["numbers"] == [] and found["found"] is None
    assert "Unstable: 2 poles in the right half plane" in found["words"] and "no settling time" in found["words"]
    assert found["ends"][0] > 100  # it is drawn all the same


@pytest.mark.parametrize(
    "state",
    [
        pytest.param({}, id="usual"),
        pytest.param({"h": 2.0}, id="sampled"),
        pytest.param({"low": -0.5, "high": 0.6}, id="limits"),
        pytest.param({"integrating": True, "T1": 5.0, "T2": 0.0, "Kc": 0.05}, id="integrating"),
        pytest.param({"L": 0.0}, id="no dead time"),
        pytest.param({"Tz": -5.0}, id="inverse response"),
        pytest.param({"kind": "rst", "h": 4.0, "speed": 0.05, "rest": 0.05, "observer": 0.2}, id="placed"),
        pytest.param({"T1": -40.0, "T2": 0.0, "L": 2.0, "K": -1.0, "Kc": 8.0, "Ti": 60.0}, id="unstable process"),
    ],
)
def test_every_kind_of_loop_is_evaluated(ask, state):
    found = ask(EVALUATE, state, None)
    assert found["error"] == "" and found["stable"] and len(found["numbers"]) == 11
    assert found["words"].startswith("Stable and ") and found["Ms"] >= 1


def test_the_numbers_are_those_of_python(ask):
    from loopbook.loop.continuous import Loop
    from loopbook.process.construct import tf

    data = page_settings(tf(2, [[40, 1], [12, 1]], 8), PidStandard(0.65, 45, 6, b=0.5, N=10))
    found = ask(EVALUATE, data["state"], None)
    loop = Loop(tf(2, [[40, 1], [12, 1]], 8), PidStandard(0.65, 45, 6, b=0.5, N=10))
    step = loop.step("reference").metrics()
    assert found["Ms"] == pytest.approx(loop.margins().Ms.value, rel=1e-9)
    assert found["found"]["overshoot"] == pytest.approx(step.overshoot, rel=1e-7, abs=1e-9)
    assert found["found"]["settling"] == pytest.approx(step.settling, rel=1e-7)
    assert found["found"]["iae"] == pytest.approx(loop.step("load").iae(), rel=1e-7)
