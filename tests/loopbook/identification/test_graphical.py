"""The documents' graphical rules on records: exact on their own model, refusing what they cannot read."""

from dataclasses import replace

import numpy as np
import pytest

from loopbook.identification.graphical import first_step, graphical_readings
from loopbook.identification.models import FIRST_ORDER
from loopbook.records.reading import read_record
from loopbook.records.record import Record
from tools import example_record as example


def made(noise=0.0, length=120.0):
    time = np.arange(0.0, length, 0.1)
    u = np.where(time >= 5, 2.0, 0.0)
    y = 1.5 * FIRST_ORDER.response(time, [(float(time[np.argmax(u)]), 2.0)], (10.0,), 4.0)
    return Record(time, u, y + np.random.default_rng(0).normal(0, noise, len(time)))


@pytest.mark.parametrize(("noise", "tolerance"), [(0.0, 0.02), (0.01, 0.12)])
def test_both_rules_find_a_first_order_model(noise, tolerance):
    found = {r.rule: r.values for r in graphical_readings(made(noise))}
    for rule in ("tangent and 63 %", "28.3 % and 63.2 %"):
        assert found[rule]["Kp"] == pytest.approx(1.5, rel=0.01)
        assert found[rule]["T"] == pytest.approx(10.0, rel=tolerance)
        assert found[rule]["L"] == pytest.approx(4.0, rel=2 * tolerance)


def test_a_process_that_falls_and_an_input_that_is_measured_are_read_alike():
    plain = made(0.01)
    noisy = replace(plain, u=plain.u + np.random.default_rng(1).normal(0, 0.004, len(plain.u)))
    for record, sign in (
        (plain, 1),
        (replace(plain, y=30 - plain.y), -1),
        (replace(plain, u=80 - plain.u), -1),
        (noisy, 1),
    ):
        for reading in graphical_readings(record)[:2]:
            assert reading.values["Kp"] == pytest.approx(1.5 * sign, rel=0.01), reading
            assert reading.values["T"] == pytest.approx(10.0, rel=0.05)


def test_reasons_name_rules_not_functions():
    reasons = [r.reason for r in graphical_readings(made(length=20)) + graphical_readings(made())]
    assert any("take the final tangent" in r for r in reasons) and any(
        "take the tangent and 63 %" in r for r in reasons
    )
    assert not any("integrating_step" in r or "estimate" in r for r in reasons)


def test_a_response_that_has_not_settled_is_refused_with_the_reason():
    found = {r.rule: r for r in graphical_readings(made(length=20))}
    assert not found["28.3 % and 63.2 %"].values and "no steady state" in found["28.3 % and 63.2 %"].reason


def test_only_the_first_step_is_read(tmp_path):
    file = tmp_path / "example.csv"
    file.write_text(example.text(), encoding="utf-8")
    record = read_record(file)
    assert len(first_step(record).time) == 165 and first_step(made()).time[-1] == made().time[-1]
    found = {r.rule: r.values for r in graphical_readings(record)}
    assert found["tangent and 63 %"]["Kp"] == pytest.approx(2.4, rel=0.02)


def test_the_shipped_example_is_the_made_one():
    from pathlib import Path

    shipped = Path(__file__).parents[3] / "notebooks" / "own_process" / "example.csv"
    assert shipped.read_text(encoding="utf-8") == example.text()
