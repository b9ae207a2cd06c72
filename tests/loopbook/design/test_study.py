"""A whole design from a file, as an engineer has it: what is read, refused, warned of, recommended and handed over."""

import json
from pathlib import Path

import numpy as np
import pytest

from loopbook.design import page, placement, tables
from loopbook.design.model import ModelError
from loopbook.design.ready import derive
from loopbook.design.recommendation import AIMS
from loopbook.design.study import Study
from loopbook.identification import graphical
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.records.record import RecordError
from tools import example_record as example

pytestmark = pytest.mark.long

EXAMPLE = Path(__file__).parents[3] / "notebooks" / "own_process" / "example.csv"
HEATED = Process.fopdt(0.68, 150.0, 18.0)


def logged(path: Path, seed: int = 0, rows: int = 500, before: int = 1) -> Path:
    """A heater's log: 0.8 s between samples, a sensor of 0.32 degrees, hardly a sample before the step, no settling."""
    time = 0.79 * np.arange(rows)
    u = np.where(np.arange(rows) >= before, 50.0, 0.0)
    y = 20.9 + 50 * HEATED.step(time - time[before]) + np.random.default_rng(seed).normal(0, 0.1, rows)
    sensor = np.round(y / 0.322) * 0.322
    lines = [
        f"{t:.2f};{s:.2f};{s / 2 + 10:.2f};{q:.1f}".replace(".", ",") for t, s, q in zip(time, sensor, u, strict=True)
    ]
    path.write_text("\n".join(["Time;T1;T2;Q1", *lines]) + "\n", encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    file = tmp_path_factory.mktemp("record") / "example.csv"
    file.write_text(example.text(), encoding="utf-8")
    return Study(file, u_low=0.0, u_high=100.0)


def shown(found):
    """All text of the first page."""
    return "\n".join(
        " ".join(r) for t in (page.recorded, page.entered, page.switched_on, page.watched) for r in t(found).rows
    )


def test_the_example_gives_its_process_back_and_a_robust_loop_on_it(study):
    fit = study.identified.chosen
    for parameter, true in zip(fit.parameters, (2.4, 40.0, 12.0, 8.0), strict=True):
        assert parameter.interval[0] <= true <= parameter.interval[1], parameter
    on_the_truth = Loop(example.PROCESS, study.recommendation.chosen.candidate.pid)
    assert on_the_truth.margins().Ms.value <= 1.65


def test_every_model_of_the_uncertainty_closes_every_stable_loop(study):
    stable = {e.candidate.name for e in study.evaluations if e.stable}
    assert set(study.spread) == stable and all(r.models == 20 for r in study.spread.values())
    chosen = study.spread[study.recommendation.chosen.candidate.name]
    assert chosen.stable == 20 and chosen.Ms <= 1.6


def test_the_results_are_plain_data_with_the_numbers_of_the_report(study):
    found = json.loads(json.dumps(study.results(), allow_nan=False))
    assert found["data"] == "example.csv" and found["rule"] == study.recommendation.chosen.candidate.name
    assert found["process"]["half_widths_95"]["L"] == pytest.approx(study.identified.chosen.parameters[-1].half_width)
    assert found["gains"] == study.program.gains and found["limits"] == {"u_low": 0.0, "u_high": 100.0}
    assert found["expected"]["Ms"] == pytest.approx(study.running.Ms, rel=1e-3)
    assert found["operating_point"] == {"u0": 40.0, "y0": study.rest[1]} and found["limits_confirmed"]


def test_the_program_stays_within_the_limits_and_settles(study):
    run = study.simulation
    u0 = study.rest[0]
    assert (-u0 - 1e-9 <= run.u).all() and (run.u <= 100 - u0 + 1e-9).all()
    assert run.y[-1] == pytest.approx(run.reference[-1], rel=0.02)
    assert f"uhigh = {100.0!r}" in study.program.listing()


def test_the_summary_and_the_tables_say_what_there_is_to_mind(tmp_path):
    found = Study(logged(tmp_path / "log.csv"), time="Time", input="Q1", output="T1")
    said = shown(found)
    assert "log.csv" in said and "Only 1 sample before the first step" in said and "extrapolation" in said
    read = "\n".join(row[1] for row in tables.assumptions(found).rows)
    assert "decimals by ','" in read and "Output: column 'T1'" in read and "1 step of the input found" in read
    assert any("not determined" in row[1] for row in tables.fits(found).rows)
    reasons = "\n".join(row[1] for row in tables.choice(found).rows)
    assert "explains" in reasons


def test_a_log_of_a_coarse_sensor_keeps_its_promise_from_the_file_on(tmp_path):
    hits = np.zeros(3)
    for seed in range(10):
        found = Study(logged(tmp_path / "log.csv", seed, rows=1100, before=40), input="Q1", output="T1")
        chosen = found.identified.chosen
        assert chosen.structure.name.startswith("first order"), seed
        truth = (0.68, 150.0, 18.0)
        hits += [p.interval[0] <= v <= p.interval[1] for p, v in zip(chosen.parameters, truth, strict=True)]
    assert (hits >= 9).all(), hits


def test_a_measured_ultimate_point_is_what_the_frequency_rules_get(tmp_path):
    file = tmp_path / "p.toml"
    file.write_text("[process]\ngain = 2\ntime_constants = [10]\ndelay = 5\n", encoding="utf-8")
    plain, measured = Study(file), Study(file, K180=0.5, T180=16.0)
    first, second = ({e.candidate.name: e.candidate.pid for e in s.evaluations} for s in (plain, measured))
    assert second["Ziegler-Nichols ultimate, PID"].K == pytest.approx(0.6 / 0.5)
    assert second["Ziegler-Nichols ultimate, PID"].Ti == pytest.approx(8.0)
    assert {n for n in first if first[n] != second[n]} == {
        *("Ziegler-Nichols ultimate, PI", "Ziegler-Nichols ultimate, PID"),
        *("Tyreus-Luyben, PI", "Tyreus-Luyben, PID"),
        *("AMIGO frequency, PI", "AMIGO frequency, PID"),
    }
    file.write_text(file.read_text() + "[experiment]\nK180 = 0.5\nT180 = 16\n", encoding="utf-8")
    assert Study(file).model.frequency == measured.model.frequency


@pytest.mark.parametrize("aim", AIMS)
def test_a_model_without_a_record_serves_every_aim(tmp_path, aim):
    file = tmp_path / "process.toml"
    file.write_text("[process]\ngain = -2\ntime_constants = [10, 3]\ndelay = 4\n", encoding="utf-8")
    found = Study(file, aim=aim)
    assert found.recommendation.chosen.candidate.pid.K < 0
    assert "Nothing was fitted" in tables.assumptions(found).rows[0][1]
    assert found.results()["process"]["half_widths_95"] is None
    assert tables.graphical(found).rows and tables.fits(found).rows and tables.choice(found).rows


def test_an_integrating_model_gets_a_whole_design(tmp_path):
    file = tmp_path / "level.toml"
    file.write_text("[process]\ngain = 0.2\ndelay = 3\nintegrating = true\n", encoding="utf-8")
    found = Study(file)
    assert found.recommendation.chosen.stable and "K" in shown(found)
    assert found.program.settings.h < 3 and json.dumps(found.results(), allow_nan=False)


def test_the_placed_regulators_are_written_out(study):
    rows = placement.polynomials(study.placements).rows
    assert [row[1] for row in rows[:3]] == ["$R$", "$S$", "$T$"] and len(rows) == 9
    assert rows[0][2].startswith("1,  ")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"K180": 1.0}, "needs both, or neither"),
        ({"u_low": 5.0, "u_high": 1.0}, "u_low = 5.0 must be below u_high = 1.0"),
    ],
)
def test_options_that_contradict_each_other_are_refused(options, message):
    with pytest.raises(ModelError, match=message):
        Study("example.csv", **options)


def test_a_record_without_a_step_is_refused_in_words(tmp_path):
    file = tmp_path / "flat.csv"
    file.write_text("time,u,y\n" + "".join(f"{t},40,{20 + t % 3}\n" for t in range(50)), encoding="utf-8")
    with pytest.raises(RecordError, match="no step found: the input 'u' is 40 from the first sample to the last"):
        _ = Study(file).model


def test_after_derive_a_design_derives_nothing_more(tmp_path):
    from loopbook.controllers import generated
    from loopbook.experiments import two_points
    from loopbook.identification import models
    from loopbook.tuning import migo_branch

    derive()
    file = tmp_path / "example.csv"
    file.write_text(example.text(), encoding="utf-8")
    cached = (generated.program_gains, two_points._formulas, models._function, migo_branch._branch_functions)
    before = [f.cache_info() for f in cached]
    Study(file).results()
    graphical.graphical_readings(Study(file).record)
    for f, was in zip(cached, before, strict=True):
        now = f.cache_info()
        assert now.misses == was.misses and now.hits > was.hits, f


def test_the_setting_is_given_in_every_controller_s_form(tmp_path):
    """The same numbers in JSON, in percent only where the ranges are known, refused with the reason."""
    study = Study(EXAMPLE, u_low=0, u_high=100, y_low=0, y_high=150)
    forms = {form["form"]: form for form in study.results()["enter"]}
    pid = study.recommendation.chosen.candidate.pid
    entries = {e["name"]: e["value"] for e in forms["rockwell-pide-dependent"]["entries"]}
    assert entries["PGain"] == pytest.approx(abs(pid.K) * 150 / 100)
    assert entries["IGain"] == pytest.approx(pid.Ti / 60)
    assert forms["siemens-pid-compact"]["Ms"] == pytest.approx(study.recommendation.chosen.Ms, rel=1e-6)
    refused = forms["honeywell-udc-gain"]
    assert ("refused" in refused) is bool(pid.Td)
    unknown = {form["form"]: form for form in Study(EXAMPLE).results()["enter"]}
    gain = unknown["rockwell-pide-dependent"]["entries"][0]
    assert gain["value"] is None and gain["per_span"] * 150 == pytest.approx(entries["PGain"], rel=1e-6)


def test_half_a_measuring_range_is_refused():
    with pytest.raises(ModelError, match="a measuring range has both"):
        Study(EXAMPLE, y_low=0.0)
