"""A share of `make prove-plant`: records on a cluster whose worker is killed, the bad ones first, the bytes of here."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "acceptance"))
import prove_plant

pytestmark = [pytest.mark.builds, pytest.mark.long]


@pytest.mark.whole
def test_a_killed_worker_costs_a_retry_and_the_bad_stand_first(tmp_path):
    pytest.importorskip("distributed")
    assert prove_plant.prove(14, tmp_path, workers=1, every=7, compared=2) == []


def test_the_ten_that_are_bad_are_refused(tmp_path):
    from loopbook.design.plant.one import DesignJob, design_one

    for way, path in prove_plant.spoiled(tmp_path).items():
        found = design_one(DesignJob(path.stem, path.name, path.read_bytes(), ()))
        assert found.row.state == "refused", way
