"""docs/teaching.md, done as it stands: a new course, its secret, a release, grades; and its table of our sheets."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from loopbook.course.new import new_course
from notebook_reports.project.project import UsageError

ROOT = Path(__file__).parents[3]
TEACHING = (ROOT / "docs" / "teaching.md").read_text(encoding="utf-8")


def commands() -> list[list[str]]:
    """The lines of the page that are commands for a course."""
    return [line.split() for line in re.findall(r"^    (loopbook course .*)$", TEACHING, re.MULTILINE)]


@pytest.mark.builds
def test_the_page_to_the_letter(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    said = {}
    for words in commands():
        arguments = [word.replace("~", str(tmp_path)) for word in words[1:]]
        done = CliRunner().invoke(main, arguments, catch_exceptions=False)
        assert done.exit_code == 0, (words, done.output)
        said[words[2]] = done.output
        if words[2] == "new":
            monkeypatch.chdir(tmp_path / words[3])
        if words[2] == "release":
            released = json.loads(Path("out/students/s01/first.ipynb").read_text())
            released["cells"][-1]["source"] = "answers = {'Kc': 1e9, 'rise': 2}"
            Path("submissions").mkdir()
            Path("submissions/any name.ipynb").write_text(json.dumps(released))
            Path("submissions/first.csv").write_text("id;Kc;rise\ns02;1,5;16,5\n")
    assert "variants" in said["check"] and "2 judged" in said["grade"]
    files = {p.relative_to(Path.cwd()).as_posix() for p in Path.cwd().rglob("*") if p.is_file()}
    for name in re.findall(r"`((?:out|grades)/[^`<]*(?:<id>[^`]*)?)`", TEACHING):
        wanted = name.replace("<id>", "s02")
        assert any(f == wanted or f.startswith(wanted.rstrip("/") + "/") for f in files), name
    assert "first.xml" in files and Path("grades/grades.csv").read_text().count("\n") == 4


@pytest.mark.builds
@pytest.mark.whole
def test_the_tutorial_to_the_letter(tmp_path, monkeypatch):
    page = (ROOT / "docs/tutorials/first-sheet.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    new_course(tmp_path / "practice")
    monkeypatch.chdir(tmp_path / "practice")
    (secret,) = re.findall(r'echo "(.*)" > ../practice.secret', page)
    Path("../practice.secret").write_text(f"{secret}\n")
    said = []
    for words in (line.split() for line in re.findall(r"^ +(loopbook course .*)$", page, re.MULTILINE)):
        if words[2] == "grade":
            Path("submissions").mkdir()
            for student, name in re.findall(r"out/students/(\w+)/first.ipynb submissions/(\w+).ipynb", page):
                (values,) = re.findall(rf"`{name}.ipynb` \| `(.*)` \| `(.*)` \|", page)
                released = json.loads(Path(f"out/students/{student}/first.ipynb").read_text())
                released["cells"][-1]["source"] = f"answers = {{'Kc': {values[0]}, 'rise': {values[1]}}}"
                Path(f"submissions/{name}.ipynb").write_text(json.dumps(released))
            (typed,) = re.findall(r"printf '(.*)' > submissions/first.csv", page)
            Path("submissions/first.csv").write_text(typed.replace("\\n", "\n"))
        done = CliRunner().invoke(main, words[1:], catch_exceptions=False)
        assert done.exit_code == 0, (words, done.output)
        said.append(done.output)
    check, release, grade = said
    assert all(f"`{line}`" in page and line in check for line in ("Kc = 1.88 %/cm", "rise = 16.5 s"))
    assert release.strip().splitlines()[-1] in page and grade.splitlines()[0] in page
    shown = re.search(r"^ +student,name,first(.*?)\n\n", page, re.MULTILINE | re.DOTALL).group()
    assert Path("grades/grades.csv").read_text().split() == shown.split()
    words = re.sub(r"\s+", " ", Path("grades/feedback/s02/first.html").read_text())
    assert "gain of the tank left out" in words and "right from your own Kc" in words


def test_a_course_is_made_whole_or_not(tmp_path):
    names = [p.as_posix() for p in new_course(tmp_path / "c")]
    assert names == [".gitignore", "README.md", "roster.csv", "sheets/first.ipynb"]
    with pytest.raises(UsageError, match="not empty"):
        new_course(tmp_path / "c")
    ignored = (tmp_path / "c" / ".gitignore").read_text().split()
    assert {"out/", "submissions/", "grades/", "*.secret"} <= set(ignored)


def test_the_page_names_every_sheet_every_tag_and_every_verdict():
    sheets = {p.stem for p in (ROOT / "notebooks" / "exercises").glob("*.ipynb")}
    table = TEACHING.partition("## The sheets that are here")[2].partition("Licence:")[0]
    assert set(re.findall(r"`(\w+)` \|", table)) == sheets
    assert "CC BY 4.0" in TEACHING and "Attribution 4.0 International" in (ROOT / "LICENSE-CONTENT").read_text()


def test_mistakes_of_a_teacher_are_one_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    new_course(tmp_path / "c")
    (tmp_path / "key").write_text("a secret that is long enough")
    sheet = "c/sheets/first.ipynb"
    given = ["--students", "c/roster.csv", "--secret", "key", "-o", "out"]
    for words, message in (
        (["check", "nothing"], "no sheet 'nothing'"),
        (["release", sheet, *given[:3], "none", *given[4:]], "the secret none cannot be read"),
        (["release", sheet, "--students", "none", *given[2:]], "none: No such file"),
        (["release", sheet, sheet.replace("first", "first"), *given], "two sheets are named first"),
        (["grade", "c", "-o", "g"], "which release? there is none in this folder"),
        (["grade", "c", "-o", "g", "--release", "c"], "No such file"),
        (["grade", "c", "-o", "g", "--format", "odt"], "unknown format odt"),
        (["secret", "key"], "is there already"),
        (["new", "c"], "not empty"),
    ):
        done = CliRunner().invoke(main, ["course", *words], catch_exceptions=False)
        assert done.exit_code == 2 and message in done.output and "Traceback" not in done.output, (words, done.output)
