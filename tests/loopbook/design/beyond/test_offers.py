"""Structures beyond one PID: compared with the best PID, offered only where clearly better, refused with the reason."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design import candidates as rules
from loopbook.design import evaluation
from loopbook.design.beyond import cascade, measured_disturbance, scheduling, smith
from loopbook.design.beyond.offer import Offer, best_pid, integrated_error, vanished
from loopbook.design.model import Model
from loopbook.design.study import Study
from loopbook.loop.continuous import Loop
from loopbook.loop.smith import SmithLoop
from loopbook.process.transfer_function import Process

pytestmark = pytest.mark.long


def loops_of(model: Model):
    """The rules that do best on such models; all of them would only take longer."""
    wanted = {name: rule for name, rule in rules.of_rules(model).items() if "AMIGO" in name or "lambda" in name}
    return [evaluation.evaluate(model, c) for c in rules.candidates(model, wanted)[0]]


@pytest.fixture(scope="module")
def late():
    model = Model(2.0, (10.0,), 60.0)
    return model, loops_of(model)


def test_a_predictor_is_offered_where_dead_time_dominates_and_says_how_wrong_it_may_be(late):
    offer = smith.smith_offer(*late, Ms=2.0)
    assert offer.offered and "20 % less" in offer.verdict
    numbers = dict(offer.numbers)
    loop = SmithLoop(late[0].process, PidStandard(numbers["K"], numbers["Ti"]))
    low, high = loop.robustness().delay
    assert f"between {low:.3g} and {high:.3g} s" in offer.says[1] and low <= 45 and high >= 75
    assert loop.with_delay(high - 60 - 0.5).is_stable and not loop.with_delay(high - 60 + 0.5).is_stable


def test_the_predictor_s_error_is_known_by_hand(late):
    """Model and process alike, closed = lambda: the error after a load step in closed form.

    y = P (1 - H e^-Ls) with H = 1/(1 + lambda s): for T > lambda it never turns, and its integral is Kp (L + lambda).
    """
    model = late[0]
    for share in (0.2, 0.5):
        closed = share * model.delay
        loop = SmithLoop(model.process, PidStandard(10 / (2 * closed), 10.0))
        y_integral = 2.0 * (model.delay + closed)
        assert integrated_error(loop, "load", vanished(loop, (10.0,), 60.0)) == pytest.approx(y_integral, rel=1e-3)
        assert integrated_error(loop, "reference", vanished(loop, (10.0,), 60.0)) == pytest.approx(
            model.delay + closed, rel=1e-3
        )


def test_a_predictor_is_not_tried_without_dead_time_or_for_an_integrator():
    for model, why in ((Model(2.0, (10.0,), 3.0), "does not dominate"), (Model(0.1, (), 5.0, True), "integrates")):
        assert why in smith.smith_offer(model, loops_of(model), 1.6).refused


def test_feedforward_takes_away_what_arrives_late_enough():
    model = Model(2.0, (10.0, 4.0), 3.0)
    pid = best_pid(loops_of(model), 1.6)
    late = measured_disturbance.compared("w", model, Model(1.5, (12.0,), 5.0), pid)
    assert late.offered and dict(late.numbers)["static gain"] == pytest.approx(-0.75)
    early = measured_disturbance.compared("w", model, Model(1.5, (2.0,), 0.0), pid)
    assert not early.offered and "arrives 3 s before" in early.says[0]
    by_itself = Loop(model.process, pid.candidate.pid, Process.fopdt(1.5, 12.0, 5.0))
    assert late.pid == pytest.approx(by_itself.step("disturbance").iae(), rel=1e-3)


def test_a_cascade_is_offered_for_a_load_inside_the_inner_loop():
    whole = Model(2.0, (40.0, 5.0), 5.0)
    offer = cascade.compared(Model(2.0, (5.0,), 1.0), Model(1.0, (40.0,), 4.0), loops_of(whole), 1.6)
    assert offer.offered and offer.theirs < 0.3 * offer.pid
    assert {name for name, _ in offer.numbers} == {"inner K", "inner Ti", "outer K", "outer Ti"}


def test_a_schedule_is_offered_where_the_points_differ_and_checked_between_them():
    far = scheduling.schedule_offer([(60.0, Model(3.0, (12.0,), 3.0)), (20.0, Model(1.0, (20.0,), 4.0))], 1.6)
    assert far.offered and "between them, 3 steps each" in far.says[0]
    assert next(name for name, _ in far.numbers) == "K at 20"
    near = scheduling.schedule_offer([(20.0, Model(1.0, (20.0,), 4.0)), (60.0, Model(1.05, (20.0,), 4.0))], 1.6)
    assert not near.offered and not near.refused


@pytest.mark.parametrize(
    ("points", "why"),
    [
        ([(1.0, Model(1.0, (2.0,), 1.0))], "two operating points"),
        ([(1.0, Model(1.0, (2.0,), 1.0)), (2.0, Model(-1.0, (2.0,), 1.0))], "changes its sign"),
        ([(1.0, Model(1.0, (2.0,), 1.0)), (2.0, Model(1.0, (2.0, 1.0), 1.0))], "different structures"),
    ],
)
def test_points_that_make_no_schedule_are_refused(points, why):
    assert why in scheduling.schedule_offer(points, 1.6).refused


def test_what_is_not_clearly_better_is_not_offered():
    assert Offer("x", "a step", 0.8, 1.0).offered and not Offer("x", "a step", 0.85, 1.0).offered
    assert "15 % less; 20 % less are asked" in Offer("x", "a step", 0.85, 1.0).verdict
    assert "5 % more" in Offer("x", "a step", 1.05, 1.0).verdict


def _written(path, **columns):
    head, rows = ",".join(columns), zip(*columns.values(), strict=True)
    path.write_text("\n".join([head, *[",".join(f"{v:.6g}" for v in row) for row in rows]]), encoding="utf-8")
    return path


def test_a_record_with_an_inner_measurement_and_a_disturbance_is_offered_both(tmp_path):
    t, random = np.arange(0.0, 500.0, 1.0), np.random.default_rng(0)
    u, w = np.where(t >= 20, 1.0, 0.0), np.where(t >= 280, 1.0, 0.0)
    P1, P2 = Process([2.0], [5.0, 1.0], 1.0), Process([1.0], [40.0, 1.0], 4.0)
    inner = P1.step(t - 20) + random.normal(0, 0.01, len(t))
    y = (P1 * P2).step(t - 20) + Process.fopdt(0.8, 30.0, 12.0).step(t - 280) + random.normal(0, 0.01, len(t))
    file = _written(tmp_path / "r.csv", time=t, u=u, jacket=inner + 30, y=y + 50, disturbance=w)
    study = Study(file, input="u", output="y", inner="jacket")
    found = {offer.what: offer for offer in study.beyond}
    assert found["cascade"].offered and found["feedforward from disturbance"].offered
    data = {entry["what"]: entry for entry in study.results()["beyond"]}
    assert data["cascade"]["numbers"]["outer Ti"] > 0 and not data["Smith predictor"]["offered"]


def test_records_at_two_operating_points_are_scheduled(tmp_path):
    t, random = np.arange(0.0, 150.0, 0.5), np.random.default_rng(1)
    u = np.where(t >= 10, 1.0, 0.0)
    for name, gain, T, rest in (("a", 1.0, 20.0, 20.0), ("b", 3.0, 12.0, 60.0)):
        y = rest + Process.fopdt(gain, T, 4.0).step(t - 10) + random.normal(0, 0.01, len(t))
        _written(tmp_path / f"{name}.csv", time=t, u=u + rest / 2, y=y)
    study = Study(tmp_path / "a.csv", points="b.csv")
    offer = next(o for o in study.beyond if o.what == "gain scheduling")
    assert offer.offered and [name.split()[0] for name, _ in offer.numbers] == ["K", "Ti", "Td"] * 2
