"""The command: exit codes, and one line for what a person can mend."""

import csv
import io
import json
import re

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from notebook_reports.build import apply, verify
from notebook_reports.build.work import Outcome
from notebook_reports.ledger import files as ledger_files
from notebook_reports.ledger.row import from_columns

pytestmark = pytest.mark.builds


@pytest.fixture
def loopbook(bench):
    def run(*arguments: str):
        return CliRunner().invoke(main, ["--root", str(bench.root), *arguments])

    return run


@pytest.fixture
def ledger(bench, loopbook):
    """A project with a small ledger."""
    value = {
        "document": "double-tank",
        "place": "Table 5",
        "id": "rise",
        "quantity": "rise time",
        "printed": "3.66",
        "unit": "s",
        "kind": "computed",
        "exact": "3.6634",
        "from_inputs": "",
        "verdict": "reproduced",
        "reason": "",
        "notebook": "double_tank/03",
    }
    odd = {
        **value,
        "id": "settling",
        "quantity": "settling time",
        "printed": "9.9",
        "verdict": "differs",
        "reason": "why",
    }
    other = {**value, "document": "pid-report", "place": "Table 5.2"}
    claim = {"document": "double-tank", "place": "section 4", "id": "stable", "says": "the loop is stable"}
    claim |= {"verdict": "fails", "evidence": "a pole at 1.02", "notebook": "double_tank/03"}
    (bench.root / "reports").mkdir()
    for table, rows in (("value", [value, odd, other]), ("claim", [claim])):
        (bench.root / "reports" / ledger_files.FILES[table]).write_bytes(
            ledger_files.render(table, [from_columns(table, row) for row in rows])
        )
    return loopbook


@pytest.mark.builds
def test_exit_codes_of_build(bench, loopbook):
    assert loopbook("build").exit_code == 2
    bench.write("a/good", "# A title", ("q: float = 0.5  # pole, [0, 1)", "parameters"), "q")
    bench.write("a/bad", "# Bad", "1 / 0")
    assert loopbook("build", "a/good", "--format", "ipynb").exit_code == 0
    assert loopbook("build", "--format", "ipynb").exit_code == 1
    for wrong in (["nowhere"], ["a/good", "-p", "r", "1"], ["--format", "docx"], ["-j", "0"]):
        assert loopbook("build", *wrong).exit_code == 2
    (bench.root / "file").write_text("")
    result = loopbook("build", "a/good", "-o", str(bench.root / "file" / "sub"), "--format", "ipynb")
    assert result.exit_code == 3
    assert result.output.startswith("loopbook: cannot write") and result.output.count("\n") == 1


def test_list(bench, loopbook):
    bench.write("a/good", "# A title", ("q: float = 0.5  # pole, [0, 1)", "parameters"), "q")
    bench.write("b/other", "# Another", "1")
    listed = "a/good  A title\n          -p q 0.5  # pole, [0, 1)\n"
    assert loopbook("list", "a/good").output == loopbook("list", "a").output == listed
    assert loopbook("list").output.count("title") == 1 and "b/other" in loopbook("list").output
    assert loopbook("list", "nowhere").exit_code == 2


def test_check_says_in_twenty_lines_what_holds_and_then_what_does_not(ledger):
    result = ledger("check")
    assert result.exit_code == 0
    summary, rest = result.output.split("\n\n")
    assert len(summary.splitlines()) <= 20
    assert ["values", "reproduced", "1", "1", "2"] in [line.split() for line in summary.splitlines()]
    assert "settling time = 9.9 s; computed 3.6634: why" in rest
    assert "the loop is stable: a pole at 1.02" in rest and "rise" not in rest


def test_check_of_one_place_shows_every_row(ledger):
    result = ledger("check", "double-tank", "table 5")
    head, *rows = result.output.partition("\n\n")[2].splitlines()
    assert re.split(r"  +", head) == ["quantity", "printed", "exact", "verdict", "why"]
    assert sorted(re.split(r"  +", row) for row in rows) == [
        ["rise time", "3.66 s", "3.6634", "reproduced"],
        ["settling time", "9.9 s", "3.6634", "differs", "why"],
    ]


def test_check_of_an_unknown_place(ledger):
    result = ledger("check", "double-tank", "Table 6")
    assert result.exit_code == 2
    assert "the ledger has no place 'Table 6'; there is Table 5" in result.output


def test_check_as_data(ledger):
    rows = json.loads(ledger("check", "--format", "json").output)
    assert [r["table"] for r in rows] == ["value", "value", "value", "claim"]
    assert (
        list(csv.DictReader(io.StringIO(ledger("check", "--format", "csv").output)))[3]["evidence"] == "a pole at 1.02"
    )
    assert ledger("check", "--format", "md").output.count("|---") > 10


def test_check_without_a_ledger(loopbook):
    result = loopbook("check")
    assert result.exit_code == 2 and "`loopbook build` writes it" in result.output


def test_check_fails_after_a_build_that_failed(bench, ledger):
    (bench.root / ".cache").mkdir()
    (bench.root / ".cache/failures.txt").write_text("a/b: broken\n")
    result = ledger("check")
    assert result.exit_code == 1 and "the last build failed" in result.output


@pytest.mark.builds
def test_doctor(bench, loopbook):
    bench.write("a/b", "# A")
    (bench.root / "environment.txt").write_text("click==0.0.1 \\\n    --hash=sha256:00\nsympy==99\n")
    result = loopbook("doctor")
    lines = {line[6:28].strip(): line for line in result.output.splitlines()}
    assert lines["Python"].startswith("ok") and lines["kernel"].startswith("ok")
    assert lines["locked versions"].startswith("FAIL") and "locked 0.0.1" in lines["locked versions"]
    assert result.exit_code == 3


def test_verify_tells_equal_from_different(capsys):
    assert verify.report({"a.pdf": "1" * 64}, {"a.pdf": "1" * 64}) == 0
    assert capsys.readouterr().out.endswith("1 files, equal in both folders\n")
    assert verify.report({"a.pdf": "1" * 64}, {"a.pdf": "2" * 64, "b.csv": "3" * 64}) == 1
    assert "2 of 1 files differ: a.pdf, b.csv" in capsys.readouterr().out
    assert verify.report({}, {}) == 1


@pytest.mark.builds
def test_two_builds_in_two_folders_are_equal(bench, tmp_path_factory):
    """Everything that could differ: hashes of strings, addresses, paths, warnings, figures, times."""
    text = "import warnings\nwarnings.warn('x')\nprint(hash('a'), {c for c in 'abc'}, object())\n__file__ = 1"
    plot = "import matplotlib.pyplot as plt\nplt.plot([1, 2]); plt.title('a');"
    hashes = []
    for jobs, folder in enumerate((bench.root, tmp_path_factory.mktemp("a-longer-name")), 1):
        copy = type(bench)(folder)
        copy.module("noisy.py", "import warnings\n\ndef warn():\n    warnings.warn('from a module', stacklevel=1)\n")
        copy.write("a/one", "# One", text, "import noisy; noisy.warn()", "1 + 1")
        copy.write("a/two", "# Two", plot)
        assert copy.build(formats=("ipynb", "html"), jobs=jobs).code == 0
        hashes.append(verify.hashes_of(folder / "reports"))
    assert len(hashes[0]) == 4
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize(
    ("options", "again"),
    [((), []), (("-o", "out", "--format", "pdf,json"), ["-o", "out", "--format", "pdf,json"])],
)
def test_what_repeats_failed_designs_writes_the_same_reports(loopbook, bench, monkeypatch, options, again):
    asked = {}
    monkeypatch.setattr(apply, "apply", lambda *_, **told: asked.update(told) or Outcome(1))
    record = bench.root / "record.csv"
    record.write_text("t,u,y\n")
    assert loopbook("design", str(record), *options).exit_code == 1
    assert list(asked["repeat"]) == ["loopbook", "design", *again]


def test_verify_builds_under_two_of_everything(bench, capfd):
    code = "import os, time\nprint(os.getcwd(), os.path.expanduser('~') != '', time.localtime().tm_gmtoff, {'a', 'b'})"
    bench.write("a/b", "# T", code)
    assert verify.verify(bench.project, ("a/b",)) == 0
    told = capfd.readouterr().out
    first, second = (line for line in told.splitlines() if line.startswith("building in"))
    differ = [("-j1", "-j4"), ("home /,", "home/of-another"), (" C,", "sv_SE.UTF-8"), ("umask 022", "umask 077")]
    for one, other in differ:
        assert one in first and other in second
    assert "user" in first and "files, equal in both folders" in told


def test_another_user_is_one_who_can_read_this_python(monkeypatch):
    monkeypatch.setattr(verify.os, "geteuid", lambda: 1000)
    assert verify._other_user() is None
