"""A share of `make prove-course`: each sheet of the project at a few draws, against a solution by hand."""

import re
import sys
from pathlib import Path

import pytest

from loopbook.course.release.one import runner
from notebook_reports.project.source import read_source

sys.path.insert(0, str(Path(__file__).parent / "proof"))
import prove_course as prove

CHAPTERS = sorted(p for p in (prove.ROOT / "notebooks").glob("*/[0-9]*.ipynb"))


@pytest.mark.long
@pytest.mark.parametrize("path", prove.SHEETS, ids=lambda p: p.stem)
def test_a_sheet_agrees_with_its_solution_by_hand_and_bears_rounded_inputs(path, share):
    if prove.SHEETS.index(path) % share(3, 1):
        pytest.skip("looked at by `make test WHOLE=1`")
    proof = prove.prove(path, draws=400, close=1, whole=False)
    assert not proof.faults and proof.good and proof.looked


def test_there_is_a_sheet_for_each_chapter_and_sixty_questions():
    questions = [c for p in prove.SHEETS for c in runner(p.stem, p.read_bytes()).sheet.cells if "question" in c.tags]
    assert len(prove.SHEETS) == len(CHAPTERS) == 17 and len(questions) >= 60


def test_each_chapter_leads_to_its_sheet_by_its_title_and_number_of_questions():
    words = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight")
    found = {}
    for path in CHAPTERS:
        [text] = [c.text for c in read_source(path).cells if c.id == "exercises"]
        title, name, number = re.match(
            r"\*\*Exercises\.\*\* \[(.*)\]\(\.\./exercises/(\w+)\.ipynb\): (\w+) ", text
        ).groups()
        sheet = runner(name, (prove.ROOT / "notebooks" / "exercises" / f"{name}.ipynb").read_bytes()).sheet
        assert (title, number) == (sheet.title, words[sum("question" in c.tags for c in sheet.cells)])
        found[path.stem] = name
    assert sorted(found.values()) == sorted(p.stem for p in prove.SHEETS)


def test_the_proof_sees_a_wrong_key_and_an_answer_that_rounding_moves(monkeypatch):
    path = next(p for p in prove.SHEETS if p.stem == "forms")
    right = prove.by_hand("forms")

    def wrong(n, own):
        found = right(n, own)
        return {**found, "Kd": (found["Kd"][0] * 1.002, found["Kd"][1])}

    monkeypatch.setattr(prove, "by_hand", lambda sheet: wrong)
    assert any("Kd: by hand" in fault for fault in prove.prove(path, 90, 2, whole=False).faults)
    monkeypatch.undo()
    monkeypatch.setattr(prove, "half_a_digit", lambda value: 0.05 * value)
    assert any("half a digit of" in fault for fault in prove.prove(path, 90, 1, whole=False).faults)
