"""The statement beside the reports: what was built from what, and the comparison with it."""

import json
import subprocess

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from notebook_reports.build import provenance
from notebook_reports.project.project import UsageError

pytestmark = pytest.mark.builds


@pytest.fixture
def stated(bench):
    """A small project that was built, in a repository, with a module and a table that its notebook uses."""
    bench.module("helper.py", "X = 1\n")
    (bench.root / "table.csv").write_text("1")
    bench.write("a/b", "# T", "import helper\nopen('../../table.csv').read()")
    for words in (["init", "-q"], ["add", "."], ["-c", "user.name=x", "-c", "user.email=x", "commit", "-qm", "x"]):
        subprocess.run(["git", *words], cwd=bench.root, check=True)
    assert bench.build(formats=("html", "ipynb")).code == 0
    provenance.write(bench.project)
    bench.file = bench.root / "reports" / provenance.NAME
    return bench


def verify(bench, file):
    return CliRunner().invoke(main, ["--root", str(bench.root), "verify", "--against", str(file)])


def test_it_names_every_report_and_all_it_was_built_from(stated):
    told = json.loads(stated.file.read_bytes())
    assert told["_type"] == "https://in-toto.io/Statement/v1"
    names = [entry["name"] for entry in told["subject"]]
    assert names == sorted(set(stated.reports()) - {provenance.NAME})
    sources = told["predicate"]["buildDefinition"]["resolvedDependencies"]
    assert [s["name"] for s in sources] == ["git", "notebooks/a/b.ipynb", "src/helper.py", "table.csv"]
    head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=stated.root, capture_output=True, text=True).stdout.strip()
    assert sources[0]["digest"] == {"gitCommit": head}
    text = stated.file.read_text()
    assert str(stated.root) not in text and provenance.is_of_now(stated.project)


def test_the_same_sources_give_the_same_statement(stated):
    before = stated.file.read_bytes()
    stated.build(formats=("html", "ipynb"), force=True)
    provenance.write(stated.project)
    assert stated.file.read_bytes() == before


def test_another_commit_is_another_statement(stated):
    subprocess.run(
        ["git", "-c", "user.name=x", "-c", "user.email=x", "commit", "-q", "--allow-empty", "-m", "y"],
        cwd=stated.root,
        check=True,
    )
    assert not provenance.is_of_now(stated.project)


def test_a_comparison_says_what_differs(stated):
    result = verify(stated, stated.file)
    number = len(stated.reports()) - 1
    assert result.exit_code == 0 and f"{number} of {number} reports are as" in result.output
    report = stated.root / "reports/a/b.html"
    report.write_bytes(report.read_bytes() + b" ")
    (stated.root / "table.csv").write_text("2")
    result = verify(stated, stated.file)
    assert result.exit_code == 1
    assert "report  a/b.html is another one" in result.output and "source  table.csv is another one" in result.output
    report.unlink()
    assert "a/b.html is not there" in verify(stated, stated.file).output


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "null", "{}", '{"_type": "x", "subject": []}', "[" * 100_000, '{"subject": 5, "predicate": 5}'],
)
def test_what_is_no_statement_is_one_line(stated, text):
    file = stated.root / "other.json"
    file.write_text(text)
    result = verify(stated, file)
    assert result.exit_code == 2 and "is no statement of a build" in result.output and result.output.count("\n") == 1
    assert verify(stated, stated.root / "nowhere.json").exit_code == 2


def test_a_statement_does_not_lead_out_of_the_project(stated):
    told = json.loads(stated.file.read_bytes())
    for name in ("/etc/passwd", "../x"):
        told["subject"][0]["name"] = name
        (stated.root / "other.json").write_text(json.dumps(told))
        with pytest.raises(UsageError, match="is no statement"):
            provenance.against(stated.project, stated.root / "other.json")
