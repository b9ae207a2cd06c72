"""The record says what happened: one project with every way to fail, built once; all other notebooks still run."""

import json
import tempfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.builds
TITLE = "# A notebook"
NOTEBOOKS = {
    "good/one": [TITLE, "1 + 1"],
    "good/shell": [TITLE, "!echo hello", "words = !echo two words\nwords"],
    "good/raises": [TITLE, ("1 / 0", "raises-exception"), "'went on'"],
    "good/warns": [TITLE, "import warnings\nwarnings.warn('an old habit')\n3"],
    "good/streams": [TITLE, "import sys\nfor i in range(3):\n    print(i)\n    print(-i, file=sys.stderr, flush=True)"],
    "bad/killed": [TITLE, "1", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "2"],
    "bad/slow": [TITLE, "import threading; threading.Event().wait()", "2"],
    "bad/false": [TITLE, "!false", "2"],
    "bad/captured": [TITLE, "x = !ls /no/such/folder", "2"],
    "bad/leaves": [TITLE, "import os; os._exit(0)", "2"],
    "bad/system_exit": [TITLE, "import sys; sys.exit(0)", "2"],
    "bad/error": [TITLE, "def f(x):\n    return 1 / x\n\nf(1)\nf(0)"],
    "bad/tame": [TITLE, ("1 + 1", "raises-exception")],
    "bad/syntax": [TITLE, "if True"],
    "bad/parameters": [TITLE, ("q: float = 1 / 2", "parameters")],
}


@pytest.fixture(scope="module")
def built(shared):
    for id, cells in NOTEBOOKS.items():
        shared.write(id, *cells)
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(tempfile, "tempdir", folder)
        shared.outcome = shared.build(jobs=4, timeout=2)
        shared.left = list(Path(folder).iterdir())
    return shared


def test_the_exit_code_and_that_all_ran(built):
    assert built.outcome.code == 1
    assert len(built.outcome.done) == len(NOTEBOOKS) - 1  # the one with a derived parameter never starts a kernel
    assert {f.notebook for f in built.outcome.failures} == {id for id in NOTEBOOKS if id.startswith("bad/")}


@pytest.mark.parametrize(
    ("id", "cell", "message"),
    [
        ("bad/killed", 3, "the kernel died"),
        ("bad/slow", 2, "not finished after 2 s"),
        ("bad/false", 2, "CalledProcessError: Command 'false' returned non-zero exit status 1."),
        ("bad/captured", 2, "CalledProcessError: Command 'ls /no/such/folder'"),
        ("bad/leaves", 2, "the kernel died"),
        ("bad/system_exit", 2, "SystemExit: 0"),
        ("bad/error", 2, "ZeroDivisionError: division by zero"),
        ("bad/tame", 2, "is tagged `raises-exception` and raised nothing"),
        ("bad/syntax", 2, "SyntaxError: expected ':'"),
        ("bad/parameters", 0, "cell 2 (parameters), line 1: q = 1 / 2 is derived"),
    ],
)
def test_each_failure_names_the_cell_and_the_command(built, id, cell, message):
    failure = next(f for f in built.outcome.failures if f.notebook == id)
    assert failure.cell == cell
    assert message in failure.what
    assert failure.repeat == f"loopbook build {id}"


def test_the_line_in_the_cell_is_shown(built):
    failure = next(f for f in built.outcome.failures if f.notebook == "bad/error")
    assert failure.more[0] == "line 5: f(0)"


def test_nothing_of_a_failed_notebook_looks_finished(built):
    assert built.reports() == sorted(f"{id}.html" for id in NOTEBOOKS if id.startswith("good/"))
    for folder in ("executed", "stamps"):
        assert not list((built.root / ".cache" / folder).rglob("bad/*"))


def test_what_a_failed_run_got_to_can_be_looked_at(built):
    seen = json.loads((built.root / ".cache/failed/bad/killed.ipynb").read_text())
    first, _, last = [c["execution_count"] for c in seen["cells"] if c["cell_type"] == "code"]
    assert first == 1 and last is None


def test_the_summary_has_fifteen_lines_at_most_and_the_whole_list_is_in_a_file(built):
    summary = built.said[built.said.index("failed:") :].splitlines()
    assert len(summary) + 1 <= 15
    everything = (built.root / ".cache/failures.txt").read_text()
    assert all(id in everything for id in NOTEBOOKS if id.startswith("bad/"))


def test_one_line_per_notebook(built):
    lines = built.said.splitlines()
    assert sum(line.startswith("ok    ") for line in lines) == 5
    assert sum(line.startswith("FAIL  ") for line in lines) == len(built.outcome.done) - 5


def test_warnings_are_shown(built):
    assert "warn  good/warns, cell 2: UserWarning: an old habit" in built.said


def test_an_expected_exception_is_shown_and_the_rest_runs(built):
    first, second = [c for c in built.executed("good/raises")["cells"] if c["cell_type"] == "code"]
    assert first["outputs"][0]["ename"] == "ZeroDivisionError"
    assert second["outputs"][0]["data"]["text/plain"] == "'went on'"


def test_shell_commands_that_succeed_do_as_always(built):
    first, second = [c for c in built.executed("good/shell")["cells"] if c["cell_type"] == "code"]
    assert "hello" in first["outputs"][0]["text"]
    assert second["outputs"][0]["data"]["text/plain"] == "['two words']"


def test_streams_are_whole_however_they_came(built):
    cell = built.executed("good/streams")["cells"][1]
    assert [(o["name"], o["text"]) for o in cell["outputs"]] == [("stdout", "0\n1\n2\n"), ("stderr", "0\n-1\n-2\n")]


def test_no_kernel_leaves_its_sockets(built):
    assert built.left == []
