"""A share of `make prove-design`: synthetic records through the whole design, every loop run on its true process."""

import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "acceptance"))
import prove_design as prove
from synthetic import FAULTS, GUISES, make

from loopbook.identification.choice import identify
from loopbook.records.reading import read_record
from loopbook.records.record import RecordError

pytestmark = pytest.mark.long


def test_designed_loops_hold_on_the_true_process(tmp_path, share):
    number = share(6, 40)
    results = prove.prove(range(number), tmp_path)
    bad = [str(r) for r in results if r.verdict in ("absurd", "error", "unstable")]
    assert not bad, bad
    held = [r for r in results if r.verdict == "held"]
    refused = [str(r) for r in results if r.made.good and r.verdict == "refused"]
    assert len(held) >= 0.8 * number, [str(r) for r in results if r.verdict != "held"]
    assert len(refused) <= 0.1 * number, refused


def test_the_records_come_in_every_guise_and_with_every_fault(tmp_path):
    made = [make(seed, tmp_path) for seed in range(120)]
    without = set() if find_spec("pyarrow") else {"parquet"}
    assert {m.guise for m in made} == set(GUISES) - without and {m.fault for m in made} == set(FAULTS)


def test_a_wrong_design_does_not_hold(tmp_path, monkeypatch, share):
    """The judge tells a loop that is right from one that is not: with gains five times too large most fall."""
    from loopbook.design.study import Study

    results = Study.results

    def too_large(self):
        found = results(self)
        found["gains"] = {n: 5 * v if n in ("p_1", "p_2", "p_5") else v for n, v in found["gains"].items()}
        found["start"] = {"x": 0.0, "I": found["operating_point"]["u0"]}
        return found

    monkeypatch.setattr(Study, "results", too_large)
    verdicts = [r.verdict for r in prove.prove(range(share(3, 6)), tmp_path)]
    assert verdicts.count("held") < len(verdicts) / 2


def test_a_settling_process_that_is_not_determined_is_not_taken_for_an_integrating_one(tmp_path):
    """A long ramp beside a second input: the lag is open, and a settling model explains it far better all the same."""
    made = make(1000, tmp_path)
    with pytest.raises(RecordError, match="not determined: of the best fit"):
        identify(read_record(made.file))
