"""`loopbook new`: what it makes builds at once, a wrong digit turns it red by name, nothing of anybody's is touched."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from notebook_reports.cli import main
from notebook_reports.ledger.open import open_document
from notebook_reports.ledger.printed_data import PrintedDataError
from notebook_reports.project.new import TEMPLATE, new_project
from notebook_reports.project.project import UsageError

SOURCE = Path(__file__).parents[3] / "src"


def loopbook(folder: Path, *words: str) -> subprocess.CompletedProcess:
    """The press's command in a folder, as a user types it there."""
    environment = {**os.environ, "PYTHONPATH": str(SOURCE)}
    command = [sys.executable, "-m", "notebook_reports.cli", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120)


def verdicts(folder: Path) -> dict[str, str]:
    with (folder / "reports" / "ledger.csv").open(encoding="utf-8", newline="") as file:
        return {row["id"]: row["verdict"] for row in csv.DictReader(file)}


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    folder = tmp_path_factory.mktemp("somewhere") / "mine"
    made = loopbook(folder.parent, "new", "mine")
    assert made.returncode == 0 and "mine/notebooks/book.toml" in made.stdout, made.stderr
    built = loopbook(folder, "build")
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


@pytest.mark.builds
def test_the_project_builds_at_once(project):
    reports = project / "reports"
    assert (reports / "free_fall/01_stone.pdf").read_bytes().startswith(b"%PDF")
    assert "A stone falls from a bridge" in (reports / "free_fall/01_stone.html").read_text(encoding="utf-8")
    assert {"index.html", "ledger.html", "loopbook.pdf"} <= {p.name for p in reports.iterdir()}
    assert verdicts(project) == {"height": "given", "time": "reproduced", "speed": "reproduced"}


@pytest.mark.builds
def test_one_wrong_digit_turns_it_red_on_that_number(project):
    table = project / "documents/free_fall/printed/table_1.toml"
    good = table.read_text(encoding="utf-8")
    table.write_text(good.replace('"2.02"', '"2.03"'), encoding="utf-8")
    built = loopbook(project, "build")
    table.write_text(good, encoding="utf-8")
    assert built.returncode == 1
    failed = [line for line in built.stdout.splitlines() if "document prints" in line]
    assert len(failed) == 1 and "(time): document prints 2.03, computed 2.0192751" in failed[0]
    assert "1 failed:" in built.stdout


DOCUMENT = """document = "second-book"
place = "Table 7"

value = [
  { id = "sum", quantity = "sum", printed = "3", kind = "computed" },
  { id = "product", quantity = "product", printed = "3", kind = "computed" },
]
"""
PART = '\n[[part]]\nfolder = "second_book"\ntitle = "A second book"\n'
CELLS = [
    "from notebook_reports.ledger.open import open_document",
    'book = open_document("second-book")\nbook.check("Table 7", exact={"sum": 1 + 2, "product": 1 * 2})',
]


@pytest.mark.builds
def test_a_document_is_a_folder_of_data_a_folder_of_notebooks_and_a_part_of_the_book(tmp_path):
    """Nothing else is made or edited; one digit is right, one wrong, and the build is red on exactly that one."""
    folder = tmp_path / "mine"
    new_project(folder)
    printed = folder / "documents/second_book/printed"
    printed.mkdir(parents=True)
    (printed / "table_7.toml").write_text(DOCUMENT, encoding="utf-8")
    text = json.loads((folder / "notebooks/free_fall/01_stone.ipynb").read_text(encoding="utf-8"))
    prose, cell = text["cells"][0], text["cells"][1]
    prose["source"] = "# A second book"
    text["cells"] = [prose, *({**cell, "id": f"c{i}", "source": c} for i, c in enumerate(CELLS))]
    (folder / "notebooks/second_book").mkdir()
    (folder / "notebooks/second_book/01_table.ipynb").write_text(json.dumps(text), encoding="utf-8")
    with (folder / "notebooks/book.toml").open("a", encoding="utf-8") as book:
        book.write(PART)
    built = loopbook(folder, "build")
    failed = [line for line in built.stdout.splitlines() if "second-book" in line and "new, " not in line]
    assert built.returncode == 1 and len(failed) == 1
    assert "second_book/01_table, cell 3: second-book, Table 7, product (product): document prints 3" in failed[0]
    assert verdicts(folder)["sum"] == "reproduced"
    (printed / "table_7.toml").write_text(DOCUMENT.replace('product", printed = "3"', 'product", printed = "2"'))
    built = loopbook(folder, "build")
    assert built.returncode == 0, built.stdout + built.stderr
    assert verdicts(folder)["product"] == "reproduced"


@pytest.mark.parametrize("name", ["a_file", "full"])
def test_what_is_there_is_left_alone(tmp_path, name):
    (tmp_path / "a_file").write_text("mine")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").write_text("mine")
    made = CliRunner().invoke(main, ["new", str(tmp_path / name)])
    assert made.exit_code == 2 and f"{name} is there already and not empty" in made.output
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["a_file", "full", "thesis.txt"]


def test_an_empty_folder_is_filled_and_parents_are_made(tmp_path):
    (tmp_path / "empty").mkdir()
    assert new_project(tmp_path / "empty") == new_project(tmp_path / "a" / "b")
    with pytest.raises(UsageError):
        new_project(tmp_path / "empty")


def test_a_notebook_opens_a_document_of_the_project_around_it(tmp_path, monkeypatch):
    new_project(tmp_path / "mine")
    monkeypatch.chdir(tmp_path / "mine/notebooks/free_fall")
    assert open_document("free-fall").value("height") == 20
    with pytest.raises(PrintedDataError, match="unknown document 'free-fal'"):
        open_document("free-fal")


def test_the_template_has_no_outputs():
    for path in TEMPLATE.rglob("*.ipynb"):
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            assert not cell.get("outputs") and cell.get("execution_count") is None and cell["id"]
