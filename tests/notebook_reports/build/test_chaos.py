"""A few of the faults of `make chaos`, without kernels; and that they would matter."""

import importlib.util
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.builds, pytest.mark.skipif(sys.platform == "win32", reason="it forks")]
spec = importlib.util.spec_from_file_location("chaos", Path(__file__).parents[3] / "tools" / "chaos.py")
chaos = importlib.util.module_from_spec(spec)
sys.modules["chaos"] = chaos
spec.loader.exec_module(chaos)


@pytest.fixture(scope="module", autouse=True)
def loaded():
    chaos.preload()


def test_faults_leave_nothing_wrong_that_the_next_build_does_not_mend():
    tally = chaos.run(15, 1, verified=True, kernels=False)
    assert tally.wrong == [] and tally.not_mended == []
    assert tally.drawn == dict.fromkeys(chaos.KINDS, 3) and sum(tally.landed.values()) >= 8
    assert tally.lines()[1] == "wrong reports: 0"


def test_a_damaged_report_is_found_and_without_verification_is_not(tmp_path):
    """The same fault on both: the test of the harness."""
    for verified in (True, False):
        world = chaos.World(tmp_path / str(verified), verified, kernels=False)
        world.root.mkdir()
        world.prepare()
        report = world.root / "reports/a/one.html"
        report.write_bytes(report.read_bytes().replace(b"1111111", b"1111112"))
        code, _ = world.finished(world.start())
        assert code == 0 and world.wrong(world.values) == ([] if verified else ["a/one.html"])


def test_a_state_that_is_not_mended_is_counted(monkeypatch):
    monkeypatch.setattr(chaos.World, "wrong", lambda self, *possible: ["a/one.html"])
    tally = chaos.run(5, 1, verified=True, kernels=False)
    assert len(tally.not_mended) == 5 and len(tally.wrong) >= 5
    assert "states that the next build did not mend: 5" in tally.lines()
