"""`lb.tuner` and what it shows: the page's data, its figure, the page itself, the command, a widget."""

import importlib.metadata
import importlib.util
import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

import loopbook as lb
from loopbook.cli import main
from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.controllers.settings import PidSettings
from loopbook.tuner_page import running
from loopbook.tuner_page.files import of_file
from loopbook.tuner_page.page import POLICY, page
from loopbook.tuner_page.script import MIME, script
from loopbook.tuner_page.settings import TunerError, settings
from loopbook.tuner_page.shown import complete, shown
from loopbook.tuner_page.still import loop_of, process_of, regulator_of, still_svg
from loopbook.tuner_page.turned import tuner
from loopbook.tuner_page.widget import module, widget
from notebook_reports.export import scripts

W = 1j * np.geomspace(1e-3, 10, 40)
PROCESSES = {
    "one lag": lb.tf(2, [10, 1], 3),
    "three lags": lb.tf(2, [[10, 1], [4, 1], [0.5, 1]], 3),
    "equal lags": lb.tf(1, [1, 3, 3, 1], 0.1),
    "integrating": lb.tf(0.3, [[5, 1], [1, 0]], 1),
    "only integrating": lb.tf(0.3, [1, 0], 1),
    "a zero": lb.tf([-2, 1], [[5, 1], [3, 1]], 1),
    "unstable": lb.tf(1, [5, -1], 0.2),
    "negative": lb.tf(-4, [[5, 1], [3, 1]], 1),
    "complex poles": lb.tf(1, [4, 1, 1], 1),
    "four lags": lb.tf(1, [[4, 1], [3, 1], [2, 1], [1, 1]], 1),
    "two integrators": lb.tf(1, [1, 0, 0], 0.1),
    "two zeros": lb.tf([1, 1, 1], [[4, 1], [3, 1], [2, 1]], 1),
}
AS_POLYNOMIALS = {"complex poles", "four lags", "two integrators", "two zeros"}


@pytest.mark.parametrize("name", PROCESSES)
def test_the_knobs_are_the_process(name):
    process = PROCESSES[name]
    data = settings(process, 0.1)
    assert process_of(data)(W) == pytest.approx(process(W), rel=1e-9)
    assert ("process" in data) == (name in AS_POLYNOMIALS)
    json.dumps(data, allow_nan=False)


REGULATORS = [
    PidStandard(0.6, 12, 2, b=0.5, N=8),
    PidStandard(0.6),
    PidParallel(0.5, 0.05, 1.0, 20.0, b=1.0, c=0.0),
    lb.PidSeries(0.5, 12, 2, N=10),
    lb.tune(PROCESSES["one lag"], "amigo", "PID"),
    PidSettings(K=0.5, Ti=10.0, Td=1.0, Tf=0.1, h=0.5, u_low=-1.0, u_high=2.0),
    0.4,
]


@pytest.mark.parametrize("regulator", REGULATORS, ids=lambda r: type(r).__name__)
def test_the_knobs_are_the_regulator(regulator):
    data = settings(PROCESSES["one lag"], regulator)
    loop = loop_of(data)
    if isinstance(regulator, PidSettings):
        assert data["state"]["h"] == 0.5 and (data["state"]["low"], data["state"]["high"]) == (-1.0, 2.0)
        regulator = PidStandard(0.5, 10.0, 1.0, b=1.0, c=0.0, Tf=0.1)
    if data["state"]["h"]:
        sampled, loop = loop, lb.Loop(process_of(data), regulator_of(data))
        assert sampled.regulator.h == 0.5 and sampled.regulator.S[0] == pytest.approx(0.5 + 0.5 * 1.0 / (0.1 + 0.5))
    assert loop.transfer(W) == pytest.approx(lb.Loop(PROCESSES["one lag"], regulator).transfer(W), rel=1e-9)


def test_without_a_regulator_one_is_chosen():
    assert settings(PROCESSES["one lag"])["state"]["Kc"] == pytest.approx(lb.tune(PROCESSES["one lag"], "simc").K)
    assert loop_of(settings(PROCESSES["complex poles"])).process == PROCESSES["complex poles"]


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda: settings(PROCESSES["one lag"], object()), "object has no knobs: give a PID form"),
        (lambda: settings(PROCESSES["one lag"], poles={"speed": 1.0}), "give h, the sampling interval"),
    ],
)
def test_what_has_no_knobs_is_refused(ask, says):
    with pytest.raises(TunerError, match=says):
        ask()


def test_a_record_is_thinned_and_keeps_its_steps():
    t = np.arange(10_000) * 0.1
    u = np.where(t > 123.4, 2.0, 1.0)
    record = settings(PROCESSES["one lag"], 0.4, record={"t": t, "u": u, "y": np.sin(t), "u0": 1.0, "y0": 0.0})[
        "record"
    ]
    assert len(record["t"]) <= 1501 and len(record["t"]) == len(record["y"]) == len(record["u"])
    moved = record["u"].index(2.0)
    assert record["t"][moved] == pytest.approx(t[u == 2.0][0])


def test_a_notebook_shows_the_figure_and_carries_the_data():
    turned = tuner(PROCESSES["one lag"], PidStandard(0.6, 12))
    shown_as = turned._repr_mimebundle_()
    assert list(shown_as) == [MIME, "application/vnd.loopbook.figure+json", "image/svg+xml", "text/plain"]
    assert shown_as[MIME] == turned.data and shown_as["image/svg+xml"].startswith("<?xml")
    assert lb.tuner is tuner
    assert turned.pid == PidStandard(0.6, 12) and turned.loop.margins().Ms.value > 1


def test_the_figure_is_the_same_at_each_run_and_shows_the_loop():
    data = settings(PROCESSES["one lag"], PidStandard(0.6, 12))
    assert still_svg(data) == still_svg(data)
    Ms = lb.Loop(PROCESSES["one lag"], PidStandard(0.6, 12)).margins().Ms.value
    assert f"{Ms:.3g}" in still_svg(data) and "unstable" in still_svg(settings(PROCESSES["one lag"], 40.0))


def test_a_pole_placement_is_shown_as_its_sampled_loop():
    data = settings(PROCESSES["three lags"], h=2.0, poles={"speed": 0.2, "damping": 0.7, "rest": 0.3, "observer": 0.5})
    loop = loop_of(data)
    wanted = np.exp(2.0 * 0.2 * np.array([-0.7 + 1j * math.sqrt(1 - 0.49), -0.7 - 1j * math.sqrt(1 - 0.49)]))
    assert all(abs(loop.poles - z).min() < 1e-6 for z in wanted) and loop.is_stable
    assert "svg" in still_svg(data)


def test_the_page_is_complete_and_its_policy_strict():
    data = settings(PROCESSES["one lag"], 0.5, name="</script><b>", names={"y": "<i>T</i> [°C]"})
    text = page(data, "A <title>", "and & more")
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', text)[1]
    (own,) = re.findall(r"<script>(.*?)</script>", text, re.S)
    assert own == script() and scripts.policy([own]).split(";")[1] == policy.split(";")[1]
    assert (
        policy.startswith("default-src 'none'; script-src 'sha256-")
        and "connect" not in policy
        and "unsafe-eval" not in policy
    )
    assert POLICY.count("'none'") == 3 and not re.findall(r"https?:(?!//www\.w3\.org/)", text)
    (inside,) = re.findall(r'<script type="application/json" class="data">(.*?)</script>', text, re.S)
    assert json.loads(inside) == data and "<title>A &lt;title&gt;</title>" in text


def test_the_press_is_offered_the_script_and_the_page():
    found = {point.name: point for point in importlib.metadata.entry_points(group="notebook_reports.scripts")}
    assert found[MIME].load() is shown
    pages = {point.name: point for point in importlib.metadata.entry_points(group="notebook_reports.pages")}
    assert pages["tuner.html"].load() is complete
    assert shown({"state": {}})[0] == script()
    with pytest.raises(ValueError, match="have a state"):
        shown({"other": 1})


MODEL = "[process]\ngain = 2.0\ntime_constants = [10.0, 4.0]\ndelay = 3.0\n"
REGULATOR = {
    "form": "standard",
    "process": {"gain": 2.0, "time_constants": [10.0, 4.0], "delay": 3.0, "integrating": False},
    "settings": {"K": 0.6, "Ti": 12.0, "h": 0.5},
    "limits": {"u_low": 0.0, "u_high": 100.0},
    "operating_point": {"u0": 40.0, "y0": 1.0},
}


def run(*arguments):
    return CliRunner().invoke(main, ["tune", *map(str, arguments)])


def data_in(path):
    text = path.read_text(encoding="utf-8")
    return json.loads(re.search(r'class="data">(.*?)</script>', text, re.S)[1])["state"]


def test_the_command_writes_a_page_of_a_model_and_of_a_regulator(tmp_path):
    model, regulator = tmp_path / "oven.toml", tmp_path / "oven.json"
    model.write_text(MODEL, encoding="utf-8")
    regulator.write_text(json.dumps(REGULATOR), encoding="utf-8")
    told = run(model)
    assert told.exit_code == 0 and told.output.strip() == str(tmp_path / "oven-tuner.html")
    assert data_in(tmp_path / "oven-tuner.html")["T1"] == 10.0
    assert run(regulator, "-o", tmp_path / "page.html").exit_code == 0
    state = data_in(tmp_path / "page.html")
    assert (state["Kc"], state["Ti"], state["low"], state["high"]) == (0.6, 12.0, -40.0, 60.0)


def test_the_command_without_data_writes_a_first_example(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = run()
    assert told.exit_code == 0 and (tmp_path / "tuner.html").exists() and told.output.strip() == "tuner.html"


@pytest.mark.long
def test_a_record_gives_the_recommended_loop_with_the_record_behind(tmp_path):
    from pathlib import Path

    record = Path(__file__).parents[3] / "notebooks" / "own_process" / "example.csv"
    data = of_file(record).data
    state = data["state"]
    assert state["T1"] == pytest.approx(39.76, abs=0.1) and state.get("low") is None
    assert len(data["record"]["t"]) == 301 and data["names"]["y"] == "temperature [°C]"
    assert 0 < state["uT"] < 10 and 0 < state["uL"] < 20


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.json", "{", "no JSON that can be read"),
        ("a.json", "[]", "process is missing"),
        ("a.json", json.dumps({**REGULATOR, "form": "rst"}), "form = 'rst': a PID regulator"),
        ("a.json", json.dumps({**REGULATOR, "settings": {"Ti": 3}}), "'K' is missing"),
        ("a.json", json.dumps({**REGULATOR, "settings": {"K": "x"}}), "no number that it can be"),
        ("a.json", json.dumps({**REGULATOR, "process": {"gain": 1, "time_constants": [1], "delay": -1}}), "negative"),
        ("a.toml", "[process]\ngain = 2.0\n", "lacks delay"),
        ("a.csv", "nothing\n", "a.csv"),
    ],
)
def test_data_that_cannot_be_used_is_refused_in_a_sentence(tmp_path, name, text, says):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    told = run(path)
    assert told.exit_code == 2 and says in told.output and "Traceback" not in told.output
    assert not list(tmp_path.glob("*.html"))


def test_a_file_that_is_not_there_is_named(tmp_path):
    told = run(tmp_path / "none.csv")
    assert told.exit_code == 2 and "there is no file" in told.output


def test_the_widget_says_what_it_needs_and_has_a_module():
    text = module()
    assert text.endswith("export default loopbookTuner.widget;\n") and "render(" in text
    if importlib.util.find_spec("anywidget") is None:
        with pytest.raises(ModuleNotFoundError, match=r"pip install 'loopbook\[widget\]'"):
            widget(settings(PROCESSES["one lag"], 0.5))


BEFORE, AFTER = (
    PidSettings(K=4.0, Ti=2.0, Td=0.4, Tf=0.1, h=0.1, u_low=0.0, u_high=1.5),
    PidSettings(K=5.0, Ti=2.0, Td=0.8, Tf=0.1, b=0.5, h=0.1, u_low=0.0, u_high=1.5),
)
PROGRAMMED = {
    "limits": {"limits": (-0.1, 0.7)},
    "an interval": {"h": 0.5},
    "a sine that is folded": {"h": 0.5, "wave": (0.2, 1.9)},
    "a sine": {"wave": (0.2, 0.1)},
    "other settings": {"before": PidStandard(0.5, 12.0, 1.0, N=5), "limits": (-2.0, 2.0)},
}
RUN = """(state, pins) => {
    const s = { ...page.DEFAULTS, ...state };
    return page.evaluate(s, null, {}, { before: s.jump ? { ...s, ...pins[0] } : undefined }).run;
}"""


@pytest.mark.parametrize("what", PROGRAMMED)
@pytest.mark.parametrize("bumpless", [True, False], ids=["bumpless", "bare"])
def test_the_figure_runs_the_program_that_the_page_runs(ask, what, bumpless):
    data = settings(PROCESSES["three lags"], PidStandard(0.9, 11.0, 2.0, b=0.6, N=8), **PROGRAMMED[what])
    data["state"]["smooth"] = bumpless
    assert running.is_programmed(data)
    page_run = ask(RUN, data["state"], data.get("pins", []))
    h = page_run["h"]
    ours = running.run_program({**data, "state": {**data["state"], "h": h}}, process_of(data), page_run["span"])
    assert page_run["u"] == pytest.approx(ours.u, abs=1e-9)
    assert page_run["seen"] == pytest.approx(ours.measured, abs=1e-9)


def test_new_settings_jump_where_nothing_is_done_about_it():
    data = settings(lb.tf(1, [1, 2, 1]), AFTER, before=BEFORE, steps=(1.0, 0.0))
    assert data["state"]["jump"] and data["pins"][0]["Kc"] == 4.0
    moved = []
    for bumpless in (True, False):
        course = running.run_program({**data, "state": {**data["state"], "smooth": bumpless}}, process_of(data), 30.0)
        half = len(course.u) // 2
        moved.append(abs(course.u[half] - course.u[half - 1]))
    assert moved[0] < 1e-3 and moved[1] > 0.9


def test_what_is_uncertain_is_met_by_the_regulator_that_was_placed(ask):
    process, h = lb.tf(2, [[7, 1], [5, 1]], 2), 1.0
    data = settings(process, h=h, poles={"speed": 0.6931, "damping": 1.0, "rest": 0.6931, "observer": 0.0})
    asked = """(state) => { const s = { ...page.DEFAULTS, ...state }, own = page.evaluate(s, null);
        return [own.stable, page.evaluate(s, null, { L: 2.3 }, { placed: own.placed }).margins.Ms.value,
            page.evaluate(s, null, { L: 2.4 }, { placed: own.placed }).stable]; }"""
    stable, Ms, longer = ask(asked, data["state"])
    loop = loop_of(data)
    assert stable and loop.is_stable and loop.margins().delay < 0.4
    assert Ms == pytest.approx(loop.with_delay(0.3).margins().Ms.value, rel=1e-7)
    assert not longer and not loop.with_delay(0.4).is_stable
