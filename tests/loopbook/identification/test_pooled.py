"""Several records of one process: tighter intervals, a record held back, a word on whether they agree."""

import numpy as np
import pytest

from loopbook import identify
from loopbook.design.study import Study
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record, RecordError

pytestmark = pytest.mark.long

TRUE = (2.0, 15.0, 3.0)


def tried(seed: int, gain: float = 2.0, sigma: float = 0.05, height: float = 1.0, name: str = "") -> Record:
    t = np.arange(0.0, 90.0, 0.5)
    y = 20 + seed + height * Process.fopdt(gain, 15.0, 3.0).step(t - 10.0)
    noise = np.random.default_rng(seed).normal(0, sigma, len(t))
    return Record(t, np.where(t >= 10, height, 0.0), y + noise, source=name or f"r{seed}.csv")


def test_pooled_records_hold_the_truth_in_tighter_intervals():
    hits, shares = np.zeros(3), []
    for seed in (0, 4):
        together = identify([tried(seed + i, height=(1.0, -0.5, 2.0)[i]) for i in range(3)]).chosen
        alone = identify(tried(seed, height=1.0), model="first order")
        hits += [p.interval[0] <= v <= p.interval[1] for p, v in zip(together.parameters, TRUE, strict=True)]
        shares.append([a.half_width / b.half_width for a, b in zip(together.parameters, alone.parameters, strict=True)])
    assert hits.sum() >= 5, hits
    assert (np.max(shares, axis=0) < 0.95).all(), shares


def test_records_that_agree_and_a_third_held_back_are_told():
    found = identify([tried(1), tried(2), tried(3)])
    text = " ".join(found.reasons)
    assert "The records agree" in text and "r3.csv was held back" in text and "as well as a model made for it" in text
    assert not found.warnings


def test_records_of_different_gains_are_told_apart():
    """Among those that are pooled, and the one that is held back."""
    found = identify([tried(1), tried(2, gain=2.6), tried(3, gain=3.5)])
    assert any("do not agree" in text and "Kp is r1.csv 2" in text for text in found.warnings)
    assert any("worse than" in text for text in found.warnings)


def test_a_record_that_gives_no_model_is_named():
    bad = tried(2, sigma=5.0)
    with pytest.raises(RecordError, match=r"r2\.csv: "):
        identify([tried(1), bad])


def test_a_design_takes_further_records_beside_the_first(tmp_path):
    for seed in (1, 2, 3):
        record = tried(seed)
        rows = [f"{t:g},{u:g},{y:.6g}" for t, u, y in zip(record.time, record.u, record.y, strict=True)]
        (tmp_path / f"r{seed}.csv").write_text("\n".join(["time,u,y", *rows]), encoding="utf-8")
    study = Study(tmp_path / "r1.csv", more="r2.csv; r3.csv")
    assert study.model.gain == pytest.approx(2.0, rel=0.02) and study.results()["process"]["half_widths_95"]["Kp"] > 0
    assert "One model of 2 records together (r1.csv, r2.csv)" in study.identified.reasons[0]
