"""A class of six from roster to grades, by the command: what each handed in came from solutions by hand."""

import csv
import json
import shutil
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from notebook_reports.export.read.pdf_text import PdfText

sys.path.insert(0, str(Path(__file__).parent / "proof"))
import class_of

pytestmark = pytest.mark.builds

SHEETS = ("anti_windup", "experiments")
EXERCISES = class_of.HAND.parents[3] / "notebooks" / "exercises"


def command(*words):
    return CliRunner().invoke(main, ["course", *map(str, words)], catch_exceptions=False)


def table(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def klass(tmp_path_factory):
    """Released, handed in, graded."""
    folder = tmp_path_factory.mktemp("class")
    ids = class_of.roster(6, folder / "roster.csv")
    assert command("secret", folder / "secret").exit_code == 0
    out = folder / "out"
    files = [EXERCISES / f"{name}.ipynb" for name in SHEETS]
    order = ("release", *files, "--students", folder / "roster.csv", "--secret", folder / "secret", "-o", out)
    released = command(*order, "-j", 1)
    assert released.exit_code == 0, released.output
    manifest = json.loads((out / "teacher" / "manifest.json").read_text())
    done = {}
    for sheet in SHEETS:
        numbers = manifest["sheets"][sheet]["numbers"]
        done[sheet] = class_of.write_submissions(out, sheet, ids, numbers, folder / "in")
    (folder / "in" / ids[0] / f"{SHEETS[1]}.ipynb").unlink()
    typed = class_of.answers(SHEETS[1], manifest["sheets"][SHEETS[1]]["numbers"][ids[0]], "right")
    _on_paper(folder / "in" / "paper" / f"{SHEETS[1]}.csv", ids[0], typed, out)
    graded = command("grade", folder / "in", "--release", out, "-o", folder / "grades", "-j", 2)
    return {"folder": folder, "ids": ids, "done": done, "order": order, "graded": graded, "manifest": manifest}


def _on_paper(path, id, typed, out):
    """Answers of one student as somebody types them: decimal commas, semicolons, the letter of a reason."""
    notebook = json.loads((out / "students" / id / f"{SHEETS[1]}.ipynb").read_text())
    text = "\n".join("".join(c["source"]) for c in notebook["cells"])

    def word(value):
        if isinstance(value, tuple):
            return f"{value[0]}, {text.split(') ' + value[1])[0][-1]}"
        return f"{value:.6g}".replace(".", ",")

    path.parent.mkdir()
    path.write_text("student;" + ";".join(typed) + "\n" + id + ";" + ";".join(map(word, typed.values())) + "\n")


def test_everybody_has_numbers_and_files_of_their_own(klass):
    out = klass["folder"] / "out"
    for sheet in SHEETS:
        numbers = klass["manifest"]["sheets"][sheet]["numbers"]
        assert len({tuple(n.values()) for n in numbers.values()}) == 6
        assert all((out / "students" / id / f"{sheet}.{f}").exists() for id in klass["ids"] for f in ("ipynb", "pdf"))
        assert all((out / "teacher" / "keys" / id / f"{sheet}.pdf").exists() for id in klass["ids"])
    assert (out / "teacher").stat().st_mode & 0o077 == 0


def test_each_got_what_the_answers_are_worth(klass):
    assert klass["graded"].exit_code == 0, klass["graded"].output
    rows = table(klass["folder"] / "grades" / "answers.csv")
    verdicts = {(r["student"], r["sheet"], r["answer"]): r for r in rows}
    for sheet in SHEETS:
        numbers = klass["manifest"]["sheets"][sheet]["numbers"]
        for id, (how, which) in klass["done"][sheet].items():
            mine = [r for (student, s, _), r in verdicts.items() if (student, s) == (id, sheet)]
            found = {r["verdict"] for r in mine}
            if how == "method":
                name, method = class_of.wrong_methods(sheet, numbers[id])[which]
                bad = verdicts[id, sheet, name]
                assert bad["verdict"] == "wrong method" and method in bad["words"] and bad["points"] == "0"
                assert {r["verdict"] for r in mine if r is not bad} <= {"right", "right from own values"}, mine
            elif how == "garbage":
                assert sum(float(r["points"]) for r in mine) <= 1
            else:
                assert (
                    found <= {"right"}
                    if how == "right"
                    else found <= {"right", "rounded too early", "right from own values"}
                )
    assert verdicts[klass["ids"][0], "anti_windup", "next_integral"]["words"].startswith("right: the overshoot stays")


def test_the_tables_of_the_class(klass):
    grades = table(klass["folder"] / "grades" / "grades.csv")
    assert [g["student"] for g in grades] == klass["ids"] and list(grades[0]) == [
        "student",
        "name",
        *SHEETS,
        "total",
        "of",
    ]
    assert grades[0]["total"] == grades[0]["of"] and float(grades[5]["total"]) <= 2
    summary = table(klass["folder"] / "grades" / "summary.csv")
    assert {r["answer"] for r in summary} >= {"reached", "Ku"} and all(r["answers"] == "6" for r in summary)
    assert table(klass["folder"] / "grades" / "unread.csv") == []


def test_feedback_says_it_in_words_and_keeps_the_key(klass):
    id = klass["ids"][1]
    pdf = (klass["folder"] / "grades" / "feedback" / id / "anti_windup.pdf").read_bytes()
    words = " ".join(run.text for run in PdfText(pdf).runs())
    assert "Feedback: An actuator that ends" in words and "that is the value with this mistake" in words
    html = (klass["folder"] / "grades" / "feedback" / id / "anti_windup.html").read_text(encoding="utf-8")
    rows = [r for r in table(klass["folder"] / "grades" / "answers.csv") if r["student"] == id]
    wrong = next(r for r in rows if r["sheet"] == "anti_windup" and r["verdict"] == "wrong method")
    assert wrong["key"] not in html and "the right value" not in html


def test_released_again_nothing_moves_and_graded_again_nothing_changes(klass, tmp_path):
    before = {p: p.read_bytes() for p in (klass["folder"] / "out").rglob("*") if p.is_file()}
    roster = klass["folder"] / "roster.csv"
    lines = roster.read_text(encoding="utf-8").splitlines()
    roster.write_text("\n".join([lines[0], "late-1;Late;Comer", *lines[1:]]) + "\n", encoding="utf-8")
    assert command(*klass["order"], "-j", 1, "--no-pdf").exit_code == 0
    after = {p: p.read_bytes() for p in before}
    changed = [p.name for p in before if ".done" not in p.parts and after[p] != before[p]]
    assert changed == ["manifest.json"]
    numbers = json.loads((klass["folder"] / "out" / "teacher" / "manifest.json").read_text())["sheets"]
    for sheet in SHEETS:
        mine = dict(numbers[sheet]["numbers"])
        assert mine.pop("late-1") not in mine.values() and mine == klass["manifest"]["sheets"][sheet]["numbers"]
    shutil.copytree(klass["folder"] / "in" / klass["ids"][1], tmp_path / "in" / klass["ids"][1])
    again = command(
        "grade", tmp_path / "in", "--release", klass["folder"] / "out", "-o", tmp_path / "g", "-j", 1, "--keys"
    )
    assert again.exit_code == 0, again.output
    missing = {r["file"] for r in table(tmp_path / "g" / "unread.csv")}
    assert missing == {*klass["ids"], "late-1"} - {klass["ids"][1]}
    rows = table(tmp_path / "g" / "answers.csv")
    assert rows == [r for r in table(klass["folder"] / "grades" / "answers.csv") if r["student"] == klass["ids"][1]]
    wrong = next(r for r in rows if r["sheet"] == "anti_windup" and r["verdict"] == "wrong method")
    html = (tmp_path / "g" / "feedback" / klass["ids"][1] / "anti_windup.html").read_text(encoding="utf-8")
    assert "right is" in html and wrong["answer"] in html
