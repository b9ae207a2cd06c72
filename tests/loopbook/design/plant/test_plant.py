"""All loops of a plant: done once, kept, done again where something changed, ranked by what needs attention."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from loopbook.cli import main
from loopbook.design.plant import run as plant_run
from loopbook.design.plant.attention import LoopRow
from loopbook.design.plant.one import Designed, DesignJob, design_one
from loopbook.design.plant.run import Progress, design_plant
from loopbook.process.transfer_function import Process
from notebook_reports.build.apply import items
from notebook_reports.executors.executor import Serial
from notebook_reports.project.project import UsageError


def record(path: Path, gain: float = 2.0, height: float = 1.0) -> Path:
    time = np.arange(0.0, 60.0, 0.5)
    noise = np.random.default_rng(0).normal(0, 0.01, len(time))
    y = height * Process.fopdt(gain, 8.0, 2.0).step(time - 5) + noise
    rows = [f"{t},{height * (t >= 5)},{v:.4f}" for t, v in zip(time, y, strict=True)]
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(["time,u,y", *rows]) + "\n", encoding="utf-8")
    return path


class Counted(Serial):
    """Serial, and after so many broken off."""

    def __init__(self, stop=99):
        self.ran, self.stop = 0, stop

    def run(self, function, jobs):
        for found in super().run(function, jobs):
            if self.ran == self.stop:
                raise KeyboardInterrupt
            self.ran += 1
            yield found


@pytest.fixture
def quick(monkeypatch):
    """A design that costs nothing; of a record that says so it is refused, fails or is lost."""

    def design(job: DesignJob) -> Designed:
        text = job.content.decode()
        if "fails" in text:
            raise TimeoutError("not done within 5 s")
        if "refused" in text:
            return Designed(LoopRow(job.label, refused=text))
        return Designed(LoopRow(job.label, Ms=float(text), fit=99.0), {"json": repr(job).encode()})

    monkeypatch.setattr(plant_run, "design_one", design)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def given(folder: Path, *texts: str) -> list[Path]:
    folder.mkdir(exist_ok=True)
    for number, text in enumerate(texts):
        (folder / f"r{number}.csv").write_text(text)
    return sorted(folder.glob("*.csv"))


def run(files, out, executor=None, values=()):
    executor = executor or Counted()
    done = design_plant(items(files, out, "design", ["json"]), out, values, executor)
    return done, executor.ran


def test_a_run_goes_on_where_it_was_broken_off_and_does_again_what_changed_or_was_lost(quick, tmp_path):
    files = given(tmp_path / "records", "1.2", "refused", "1.4", "fails", "2.5")
    whole, ran = run(files, tmp_path / "whole")
    assert ran == 5 and [r.state for r in whole.rows] == ["failed", "refused", "fragile", "good", "good"]
    with pytest.raises(KeyboardInterrupt):
        run(files, tmp_path / "broken", Counted(stop=3))
    assert run(files, tmp_path / "broken")[1] == 2
    assert contents(tmp_path / "broken") == contents(tmp_path / "whole")
    assert run(files, tmp_path / "broken")[1] == 1  # the one that failed is tried again
    (tmp_path / "broken" / "r0-design.json").unlink()
    (tmp_path / "broken" / "r2-design.json").write_text("damaged")
    assert run(files, tmp_path / "broken")[1] == 3
    assert contents(tmp_path / "broken") == contents(tmp_path / "whole")
    assert run(files, tmp_path / "broken", values=[("aim", "fast")])[1] == 5
    files[0].write_text("refused now")
    assert run(files, tmp_path / "broken")[0].rows[1].name == "r0"
    assert (
        not (tmp_path / "broken" / "r0-design.json").exists() and (tmp_path / "broken" / "r0-design.json.old").exists()
    )


def test_files_that_cannot_be_read_or_have_one_name_cost_nobody_else(quick, tmp_path, monkeypatch):
    one, two = given(tmp_path / "a", "1.1"), given(tmp_path / "b", "1.3")
    gone = given(tmp_path / "c", "1.2", "1.2")[1]
    whole = Path.read_bytes

    def read(path):
        if path == gone:
            raise PermissionError(13, "Permission denied")
        return whole(path)

    monkeypatch.setattr(Path, "read_bytes", read)
    done, ran = run([*one, *two, gone], tmp_path / "out")
    assert ran == 2 and {r.name for r in done.rows} == {"a-r0", "b-r0", "r1"}
    assert done.rows[0].state == "failed" and "cannot be read: Permission denied" in done.rows[0].why
    assert (tmp_path / "out" / "a-r0-design.json").is_file() and (tmp_path / "out" / "b-r0-design.json").is_file()


def test_a_summary_of_others_is_not_written_over(quick, tmp_path):
    files = given(tmp_path / "records", "1.2", "1.3")
    out = tmp_path / "out"
    out.mkdir()
    (out / "summary.csv").write_text("what a colleague counted")
    with pytest.raises(UsageError, match="holds a summary that no design wrote"):
        run(files, out)
    assert (out / "summary.csv").read_text() == "what a colleague counted"
    with pytest.raises(UsageError, match="is named as a record"):
        run([*files, out / "summary.csv"], out)


def test_progress_says_how_long_the_rest_takes():
    said, times = [], iter([0.0, 30.0, 61.0, 122.0])
    progress = Progress(said.append, terminal=False, now=lambda: next(times))
    for done in (1, 2, 3):
        progress(LoopRow("x", refused="no step" if done == 1 else ""), done, 3)
    assert said == [
        "2 of 3 designed, 1 without a regulator, about 30 s left\n",
        "3 of 3 designed, 1 without a regulator\n",
    ]


@pytest.mark.long
def test_the_command_on_two_records(tmp_path):
    """The real design; what it gives is what a single one gives, and the refused record is named."""
    files = [record(tmp_path / "in" / "good.csv"), record(tmp_path / "in" / "flat.csv", height=0.0)]
    out = tmp_path / "out"
    words = ["design", *map(str, files), "-o", str(out), "--format", "json,st", "--limits", "0", "2", "-j", "1"]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 1 and "flat: no step found" in done.output and "2 records, 1 without" in done.output
    table = list(csv.DictReader(io.StringIO((out / "summary.csv").read_text(encoding="utf-8"))))
    assert [row["loop"] for row in table] == ["flat", "good"] and table[0]["state"] == "refused"
    found = json.loads((out / "good-design.json").read_bytes())
    assert found["limits"] == {"u_low": 0.0, "u_high": 2.0} and float(table[1]["Ms"]) == found["expected"]["Ms"]
    assert "END_FUNCTION_BLOCK" in (out / "good_design.st").read_text(encoding="utf-8")
    assert "good-design.json" in (out / "summary.html").read_text(encoding="utf-8")
    assert "2 from before" in CliRunner().invoke(main, words).output


@pytest.mark.builds
@pytest.mark.whole
def test_a_report_is_byte_for_byte_that_of_a_single_design(tmp_path):
    file = record(tmp_path / "in" / "one.csv")
    assert CliRunner().invoke(main, ["design", str(file), "-o", str(tmp_path), "--format", "pdf,json"]).exit_code == 0
    other = record(tmp_path / "in" / "two.csv", gain=1.5)
    words = ["design", str(file), str(other), "-o", str(tmp_path / "out"), "--format", "pdf,json"]
    assert CliRunner().invoke(main, words).exit_code == 0
    for name in ("one-design.pdf", "one-design.json"):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / name).read_bytes()


def test_a_refusal_names_no_folder_of_the_run(tmp_path):
    found = design_one(DesignJob("x", "x.csv", b"\n", (("json", "x-design"),)))
    assert found.row.state == "refused" and "/" not in found.row.why.replace("y/u", "") and found.files == {}


def test_a_cluster_is_for_many_records(tmp_path):
    done = CliRunner().invoke(main, ["design", str(record(tmp_path / "one.csv")), "--cluster", "4"])
    assert done.exit_code == 2 and "--cluster is for many records" in done.output
