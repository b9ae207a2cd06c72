"""``loopbook code`` and ``loopbook design --format c,st,js,py``: files, exit codes, nothing half-written."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from loopbook.code.files import PROGRAMS, with_all_files
from notebook_reports.build.apply import items
from notebook_reports.project.project import UsageError

ROOT = Path(__file__).parents[3]
RECORD = ROOT / "notebooks" / "own_process" / "example.csv"
PID = {"form": "standard", "name": "Oven 3", "settings": {"K": 2.0, "Ti": 8.0, "h": 0.5}}
PID["limits"] = {"u_low": 0.0, "u_high": 100.0}


@pytest.fixture
def regulator(tmp_path):
    path = tmp_path / "regulator.json"
    path.write_text(json.dumps(PID))
    return path


def run(*words):
    return CliRunner().invoke(main, ["--root", str(ROOT), "code", *map(str, words)])


def names(folder):
    return sorted(p.name for p in folder.iterdir() if p.name != "regulator.json")


def test_one_target_to_a_file_names_the_program_after_it(regulator, tmp_path):
    done = run(regulator, "--target", "c", "-o", tmp_path / "out" / "pid.c", "--test-main", "--arduino")
    assert done.exit_code == 0, done.output
    assert names(tmp_path / "out") == ["pid.c", "pid.h", "pid.ino", "pid_test.c"]
    assert "pid_settings" in (tmp_path / "out" / "pid.h").read_text()
    assert done.output.splitlines() == [str(tmp_path / "out" / n) for n in ("pid.c", "pid.h", "pid_test.c", "pid.ino")]


def test_several_targets_go_to_a_folder(regulator, tmp_path):
    assert run(regulator, "--target", "c,st,js,py", "-o", tmp_path / "out", "--double").exit_code == 0
    wanted = [f"oven_3.{ending}" for ending in ("c", "h", "js", "mjs", "py", "st")]
    assert names(tmp_path / "out") == wanted
    assert "typedef double lb_real;" in (tmp_path / "out" / "oven_3.h").read_text()
    assert "LREAL#2.0" in (tmp_path / "out" / "oven_3.st").read_text()


def test_a_name_may_be_given(regulator, tmp_path):
    assert run(regulator, "--target", "st", "-o", tmp_path / "x.st", "--name", "heater_pid").exit_code == 0
    assert "FUNCTION_BLOCK FB_HeaterPid" in (tmp_path / "x.st").read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--target", "fortran"], "fortran: no such language; one of c, js, py, st"),
        (["--target", "c,st", "-o", "pid.c"], "is one file, 2 languages"),
        (["--target", "c", "-o", "pid.st"], "C99 ends in .c or .h"),
        (["--target", ","], "no target"),
    ],
)
def test_what_is_asked_wrongly_is_said_and_nothing_written(regulator, tmp_path, words, said):
    done = run(regulator, *words)
    assert done.exit_code == 2 and said in done.output
    assert names(tmp_path) == []


def test_a_regulator_that_is_not_there_or_wrong_is_said(tmp_path):
    done = run(tmp_path / "none.json")
    assert done.exit_code == 2 and "cannot be read" in done.output
    (tmp_path / "bad.json").write_text(json.dumps(PID | {"settings": {"K": 0, "h": 1}}))
    done = run(tmp_path / "bad.json")
    assert done.exit_code == 2 and "K = 0 is outside its range" in done.output


def test_a_sketch_needs_limits(tmp_path):
    (tmp_path / "free.json").write_text(json.dumps(PID | {"limits": {}}))
    done = run(tmp_path / "free.json", "--arduino")
    assert done.exit_code == 2 and "both limits" in done.output


def test_files_that_are_there_are_written_anew_and_whole(regulator, tmp_path):
    for _ in range(2):
        assert run(regulator, "--target", "py", "-o", tmp_path / "pid.py").exit_code == 0
    assert names(tmp_path) == ["pid.py"]


def test_a_design_writes_all_files_of_a_language(tmp_path):
    formats = with_all_files(["pdf", "c", "js", "st", "py"])
    assert formats == ["pdf", "c", "h", "js", "mjs", "st", "py"]
    record = tmp_path / "heater 2.csv"
    record.write_text("")
    (item,) = items([record], None, "design", formats, more=tuple(PROGRAMS))
    wanted = [*(f"heater_2_design.{e}" for e in ("c", "h", "js", "mjs", "py", "st")), "heater 2-design.pdf"]
    assert sorted(p.name for p in item.outputs.values()) == sorted(wanted)
    with pytest.raises(UsageError, match="unknown format xyz"):
        items([record], None, "design", ["xyz"], more=tuple(PROGRAMS))


@pytest.mark.builds
@pytest.mark.parametrize(
    "output",
    [*(pytest.param(name, marks=pytest.mark.whole) for name in (None, "out", "x.pdf")), "my loop.pdf"],
    ids=str,
)
def test_the_files_of_a_design_find_each_other_whatever_they_are_called(tmp_path, output):
    record = tmp_path / "heater 2.csv"
    record.write_bytes(RECORD.read_bytes())
    target = [] if output is None else ["-o", str(tmp_path / output)]
    done = CliRunner().invoke(main, ["design", str(record), *target, "--page", "--format", "pdf,c"])
    assert done.exit_code == 0, done.output
    (source,) = tmp_path.rglob("*.c")
    (named,) = re.findall(r'#include "(.+)"', source.read_text())[:1]
    assert (source.parent / named).is_file()
    text = (source.parent / named).read_text()
    assert "temperature [°C]" in text and " * Mind: " in text


def test_what_a_press_gets_of_a_design_belongs_together():
    texts = {ending: PROGRAMS[ending](PID, "oven_design").decode() for ending in ("c", "h")}
    assert '#include "oven_design.h"' in texts["c"]
    assert "oven_3_step" in texts["h"]
