"""From a model to a regulator: every rule judged by exact loops, the choice by its aim, the program by its own run."""

import json
import math

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design import placement, tables
from loopbook.design.candidates import Candidate, candidates
from loopbook.design.evaluation import evaluate, robustness, total_variation
from loopbook.design.model import Model, ModelError
from loopbook.design.model_file import TEMPLATE, read_fixed, read_model
from loopbook.design.program import round_down, sampled_program
from loopbook.design.recommendation import AIMS, AimError, recommend
from loopbook.design.running import Running
from loopbook.design.speed import at_closed, at_speed
from loopbook.design.speed import rules as speed_rules
from loopbook.documents.pid_report.printed_programs import ProgramController
from loopbook.loop.continuous import Loop
from loopbook.numerics.signals import Signal
from loopbook.tuning import Tuning, tune

FOPDT = Model(2.0, (10.0,), 3.0, covariance=np.diag([0.03, 0.2, 0.2]) ** 2)


def own(pid: PidStandard) -> Candidate:
    return Candidate("own", pid, Tuning(pid, "own", "given"))


@pytest.fixture(scope="module")
def judged():
    accepted, refused = candidates(FOPDT)
    return [evaluate(FOPDT, c) for c in accepted], refused


def test_rules_get_the_numbers_of_the_model(judged):
    found = {e.candidate.name: e.candidate for e in judged[0]}
    assert found["SIMC, PI"].pid.K == pytest.approx(tune(FOPDT.process, "simc-pi").K)
    assert found["AMIGO step, PID"].pid.Ti == pytest.approx(tune(FOPDT.step_data, "amigo-step-pid").Ti)
    assert found["AMIGO step, PID"].pid.Tf == pytest.approx(found["AMIGO step, PID"].pid.Td / 10)
    assert {r.name for r in judged[1]} >= {"SIMC, PID"}


def test_margins_and_errors_are_those_of_the_loop(judged):
    e = next(e for e in judged[0] if e.candidate.name == "SIMC, PI")
    assert e.Ms == pytest.approx(1.59, abs=0.01)  # the published value for closed = L
    Ti, K = e.candidate.pid.Ti, e.candidate.pid.K
    assert e.iae_load == pytest.approx(Ti / K, rel=1e-9)  # the error does not change its sign: IAE = |integral of e|
    assert (Ti, K) == (pytest.approx(10), pytest.approx(5 / 6))
    slower = Loop(FOPDT.process, e.candidate.pid).with_delay(e.delay_margin * 0.999)
    faster = Loop(FOPDT.process, e.candidate.pid).with_delay(e.delay_margin * 1.001)
    assert slower.is_stable and not faster.is_stable


def test_a_falling_process_gets_the_same_loops_with_the_other_sign(judged):
    falling = Model(-2.0, (10.0,), 3.0)
    turned = {e.name: e for e in candidates(falling)[0]}
    for e in judged[0]:
        mirrored = evaluate(falling, turned[e.candidate.name])
        assert mirrored.candidate.pid.K == pytest.approx(-e.candidate.pid.K)
        assert mirrored.stable == e.stable
        if e.stable and e.candidate.name == "SIMC, PI":
            assert mirrored.iae_load == pytest.approx(e.iae_load)


def test_an_integrating_process_gets_its_own_rules():
    accepted, _ = candidates(Model(0.2, (), 3.0, integrating=True))
    names = {c.name for c in accepted}
    assert names >= {"AMIGO step, PI", "SIMC, PI", "MIGO, PID"} and not names & {"lambda, PI", "SIMC, PID"}


def test_rules_that_cannot_be_used_say_why():
    _, refused = candidates(Model(2.0, (10.0,), 0.0))
    reasons = {r.name: r.reason for r in refused}
    assert "dead time" in reasons["Ziegler-Nichols step, PID"] and "AMIGO step, PI" in reasons


@pytest.mark.parametrize("aim", AIMS)
def test_the_recommendation_keeps_what_its_aim_asks_and_is_best_at_it(judged, aim):
    found = recommend(judged[0], aim)
    wanted = AIMS[aim]
    assert not found.compromise and wanted.admits(found.chosen, found.chosen.Ms)
    better = [
        e for e in judged[0] if e.stable and wanted.admits(e, e.Ms) and wanted.cost(e) < wanted.cost(found.chosen)
    ]
    assert not better and found.reasons


def test_uncertainty_counts_against_a_setting(judged):
    spread = {e.candidate.name: robustness(FOPDT, e.candidate, 6) for e in judged[0] if e.stable}
    assert all(r.models == 6 for r in spread.values())
    found = recommend(judged[0], "robust", spread)
    assert spread[found.chosen.candidate.name].Ms <= 1.6


def test_an_aim_that_nobody_meets_is_a_compromise_and_an_unknown_one_an_error(judged):
    wild = [e for e in judged[0] if e.stable and e.Ms > 2]
    assert recommend(wild, "robust").compromise
    with pytest.raises(AimError, match="aim = 'bold': one of robust, fast, no-overshoot, quiet"):
        recommend(judged[0], "bold")
    unstable = evaluate(FOPDT, own(PidStandard(50.0)))
    assert not unstable.stable and math.isnan(unstable.Ms)
    with pytest.raises(AimError, match="no rule gives a stable loop"):
        recommend([unstable], "robust")


def test_total_variation_counts_every_turn():
    up_and_down = Signal(np.array([0.0, 1.0, 2.0]), np.array([[1.5, 0.5], [1.5, -0.5]]))
    assert total_variation(up_and_down) == pytest.approx(1 + 1 + 1)  # jump to 1, up to 2, down to 1
    jump = Signal(np.array([0.0, 1.0, 2.0]), np.array([[1.0], [-2.0]]))
    assert total_variation(jump) == pytest.approx(4)


def test_the_program_runs_as_the_documents_program(judged):
    chosen = next(e for e in judged[0] if e.candidate.name == "AMIGO step, PID")
    program = sampled_program(chosen, 10.0, limits=(-0.3, 0.3))
    run = Running(FOPDT, program, 60.0, 1.0, 0.2, 0.0, (0.0, 0.0)).clean
    assert abs(run.u).max() <= 0.3
    own_program = ProgramController("4.13", program.settings)
    again = [own_program.step(y, r) for y, r in zip(run.measured, run.reference, strict=True)]
    assert np.allclose(again, run.demanded.clip(-0.3, 0.3), atol=1e-12)
    assert program.data()["gains"]["p_5"] == pytest.approx(
        program.settings.K * program.settings.h / program.settings.Ti
    )
    assert json.loads(json.dumps(program.data()))["limits"] == {"u_low": -0.3, "u_high": 0.3}
    assert "v = " in program.listing() and f"p5 = {program.gains['p_5']!r}" in program.listing()


def test_the_sampling_interval_follows_its_rules(judged):
    chosen = next(e for e in judged[0] if e.candidate.name == "AMIGO step, PID")
    program = sampled_program(chosen, 10.0)
    assert program.settings.h <= min(10 / 5, chosen.candidate.pid.Tf / 2)
    assert 0.9 < program.delay_margin_left < 1
    assert [round_down(v) for v in (0.999, 2.0, 0.049)] == [0.5, 2.0, 0.02]


def test_pole_placement_puts_the_poles_and_gets_slower_more_robust():
    model = Model(2.0, (10.0, 4.0), 3.0)
    found = placement.placements(model, 10.0)
    assert [p.closed for p in found] == [10.0, 5.0, 2.5]
    assert found[-1].settling < found[0].settling and found[-1].margins.delay < found[1].margins.delay
    assert len(placement.table(found).rows) == 3


def test_models_are_drawn_around_the_estimate():
    drawn = FOPDT.variations(200, seed=1)
    assert np.std([m.delay for m in drawn]) == pytest.approx(0.2, rel=0.2)
    assert np.mean([m.gain for m in drawn]) == pytest.approx(2.0, abs=0.01)
    assert Model(2.0, (10.0,), 3.0).variations(5) == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"process"),
        ("[process]\ngain = 2\n", "lacks delay"),
        ("[process]\ngian = 2\ndelay = 1\n", "no entry 'gian'; did you mean gain"),
        ("[process]\ngain = '2'\ndelay = 1\n", "gain = '2': a number is expected"),
        ("[process]\ngain = 2\ndelay = -1\ntime_constants = [3]\n", "delay = -1.0 s is negative"),
        ("[process]\ngain = 2\ndelay = 1\n", "give time_constants"),
        ("[process]\ngain = 0\ndelay = 1\ntime_constants = [3]\n", "other than zero"),
        ("[process]\ngain = 2\ndelay = 1\ntime_constants = [3]\n[experiment]\nK180 = 1\n", "needs K180 and T180"),
        ("[process", "p.toml: "),
        ("[process]\ngain = 2\ndead_time = 1\ntime_constants = [3]\n", "no entry 'dead_time'; did you mean delay"),
        ("[proces]\ngain = 2\n", "no entry 'proces'; did you mean process"),
        ("process = 3\n", r"process"),
    ],
)
def test_a_process_file_that_cannot_be_used_says_why(tmp_path, text, message):
    file = tmp_path / "p.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=message):
        read_model(file)


def test_a_process_file_is_read(tmp_path):
    file = tmp_path / "p.toml"
    file.write_text(
        "[process]\ngain = -2\ntime_constants = [4, 10.0]\ndelay = 3\n[experiment]\nK180 = 0.2\nT180 = 20\n"
    )
    model = read_model(file)
    assert (model.gain, model.lags, model.delay) == (-2.0, (10.0, 4.0), 3.0)
    assert model.frequency.Ku == 5.0
    assert model.latex() == r"G(s) = \frac{-2}{(1 + 10 s) (1 + 4 s)} e^{-3 s}"


def test_a_single_time_constant_is_a_number(tmp_path):
    file = tmp_path / "p.toml"
    for text in ("time_constants = 3", "time_constant = 3.0", "time_constants = [3]"):
        file.write_text(f"[process]\ngain = 2\ndelay = 0\n{text}\n", encoding="utf-8")
        assert read_model(file).lags == (3.0,)


def test_the_template_is_a_model_file(tmp_path):
    file = tmp_path / "p.toml"
    file.write_text(TEMPLATE, encoding="utf-8")
    assert read_model(file).lags == (10.0, 4.0)


def test_many_lags_print_as_powers_or_as_a_product():
    assert Model(2.0, (3.0,) * 30, 1.0).latex() == r"G(s) = \frac{2}{(1 + 3 s)^{30}} e^{-1 s}"
    assert r"\prod_{i=1}^{30} (1 + T_i s)" in Model(2.0, tuple(np.arange(1.0, 31.0)), 1.0).latex()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("K", "write K=2"),
        ("Q=3", "write K=2"),
        ("K=x", "a number is expected"),
        ("T=3 fortnights", "is no time"),
        ("K=0", "other than zero"),
        ("T=-3", "not negative"),
        ("T=3, T1=4", "not both"),
        ("K=2, gain=3", "given twice"),
    ],
)
def test_parameters_that_cannot_be_fixed_say_why(text, message):
    with pytest.raises(ModelError, match=message):
        read_fixed(text)


def test_the_knob_goes_from_slow_to_fast():
    points = [at_speed(FOPDT, s) for s in (0.0, 0.5, 1.0)]
    assert points[0].closed > points[1].closed > points[2].closed == FOPDT.delay
    assert at_closed(FOPDT, points[1].closed).speed == pytest.approx(0.5)
    gains = [[c.pid.K for c in candidates(FOPDT, speed_rules(FOPDT, p))[0]] for p in points]
    assert all(a < b < c for a, b, c in zip(*gains, strict=True))
    with pytest.raises(ModelError, match="from 0"):
        at_speed(FOPDT, 1.5)


def test_tables_hold_every_setting(judged):
    spread = {e.candidate.name: robustness(FOPDT, e.candidate, 2) for e in judged[0] if e.stable}
    assert len(tables.settings(judged[0]).rows) == len(judged[0])
    assert len(tables.robustness(judged[0], spread).columns) == 8
    assert len(tables.performance(judged[0]).rows) == len(judged[0])
    assert any("does not apply" in row[1] for row in tables.validity(*judged).rows)
