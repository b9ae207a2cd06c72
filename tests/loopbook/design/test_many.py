"""Many designs in one call, of the real notebook: each record its report, a bad one named, forked from one process."""

import io
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from loopbook.process.transfer_function import Process
from notebook_reports.build.apply import apply, items
from notebook_reports.project.console import Console
from notebook_reports.project.project import project_at
from notebook_reports.run import warm

pytestmark = pytest.mark.builds

NOTEBOOK = Path(__file__).parents[3] / "notebooks" / "own_process" / "design.ipynb"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def record(path: Path, gain: float, height: float) -> Path:
    time = np.arange(0.0, 60.0, 0.5)
    clean = height * Process.fopdt(gain, 8.0, 2.0).step(time - 5)
    noisy = clean + np.random.default_rng(0).normal(0, 0.01, len(time))
    rows = [f"{t},{height * (t >= 5)},{y:.4f}" for t, y in zip(time, noisy, strict=True)]
    path.write_text("\n".join(["time,u,y", *rows]) + "\n", encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("records")
    model = folder / "model.toml"
    model.write_text("[process]\ngain = 0.5\ntime_constants = [30]\ndelay = 6\n", encoding="utf-8")
    files = [record(folder / "one.csv", 2.0, 1.0), record(folder / "flat.csv", 2.0, 0.0), model]
    wanted = items(files, folder / "out", "design", ["json", "pdf"])
    forked, fork = [], warm.Warm.fork
    out = Terminal()
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv(warm.PLAIN, raising=False)
        patch.setattr(warm.Warm, "fork", lambda self, *order: forked.append(fork(self, *order)) or forked[-1])
        derive = "loopbook.design.ready:derive"
        outcome = apply(
            project_at(folder), NOTEBOOK, wanted, [("unlimited", "True")], console=Console(out), ready=derive
        )
    return folder, outcome, out.getvalue(), forked


def test_every_good_record_has_its_reports(run):
    folder, outcome, *_ = run
    assert outcome.code == 1 and len(outcome.done) == 3
    assert {p.name for p in (folder / "out").iterdir()} == {
        *("one-design.json", "one-design.pdf", "model-design.json", "model-design.pdf")
    }
    assert (folder / "out" / "one-design.pdf").read_bytes().startswith(b"%PDF")
    one = json.loads((folder / "out" / "one-design.json").read_text(encoding="utf-8"))
    process = one["process"]
    assert process["gain"] == pytest.approx(2.0, abs=process["half_widths_95"]["Kp"] * 2)
    assert one["limits"]["u_low"] is None and one["expected"]["Ms"] <= 1.6


def test_the_bad_record_is_named_with_its_reason_and_the_command(run):
    folder, _, said, _ = run
    last = said[said.index("1 failed:") :]
    assert "flat" in last and "no step found: the input 'u' is 0 from the first sample to the last" in last
    assert f"Repeat: loopbook design {folder / 'flat.csv'} -p unlimited True" in last
    assert "ok    one" in said and "ok    model" in said and str(folder / "out" / "one-design.pdf") in said


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="kernels are forked on Linux only")
def test_the_kernels_are_forked_with_the_derivations_done(run):
    assert len(run[3]) == 3 and all(run[3])
