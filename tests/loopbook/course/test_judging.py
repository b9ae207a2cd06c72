"""Verdicts: every way to be wrong that has a name, what follows from it, rounding, units, garbage; and the points."""

import json
import sys
from pathlib import Path

import pytest

from loopbook.course.grade.judging import judge_all
from loopbook.course.grade.verdicts import (
    METHOD,
    MISSING,
    OWN,
    RIGHT,
    ROUNDED,
    SIGN,
    UNIT,
    UNREADABLE,
    WRONG,
    Given,
)
from loopbook.course.notebooks import as_bytes
from loopbook.course.release.one import runner
from loopbook.course.release.release import why_not
from loopbook.course.release.student import screen_sheet
from loopbook.course.release.variants import Variants

sys.path.insert(0, str(Path(__file__).parent / "proof"))
import class_of
from prove_course import SHEETS

NOTHING = {UNREADABLE, MISSING, WRONG}


def first_good(ran):
    variants = Variants(ran.sheet)
    return next(n for i in range(variants.count) if not why_not(ran, n := variants.at(7 * i % variants.count)))


def given(ran, numbers, found):
    """Answers as they come out of a student's notebook, whose last cell is run here."""
    released = json.loads(as_bytes(screen_sheet(ran.sheet, ran.solve(numbers, show="texts"), "s1")))
    space = {}
    exec(class_of.hand_in(released, found)["cells"][-1]["source"], space)
    return {name: Given(value) for name, value in space["answers"].items()}


def verdicts(ran, numbers, found):
    return {j.name: j for j in judge_all(ran, numbers, given(ran, numbers, found))[1]}


@pytest.mark.long
@pytest.mark.parametrize("path", SHEETS, ids=lambda p: p.stem)
def test_right_rounded_each_wrong_method_with_its_consequences_and_garbage(path, share):
    if SHEETS.index(path) % share(4, 1):
        pytest.skip("looked at by `make test WHOLE=1`")
    sheet, ran = path.stem, runner(path.stem, path.read_bytes())
    numbers = first_good(ran)
    right = verdicts(ran, numbers, class_of.answers(sheet, numbers, "right"))
    assert {j.verdict for j in right.values()} <= {RIGHT} and all(j.points == j.of for j in right.values())
    rounded = verdicts(ran, numbers, class_of.answers(sheet, numbers, "rounded"))
    assert {j.verdict for j in rounded.values()} <= {RIGHT, OWN, ROUNDED}, rounded
    methods = class_of.wrong_methods(sheet, numbers)
    assert methods
    for which, (name, method) in enumerate(methods):
        found = verdicts(ran, numbers, class_of.answers(sheet, numbers, "method", which))
        assert (found[name].verdict, found[name].method, found[name].points) == (METHOD, method, 0), found[name]
        others = [j for j in found.values() if j.name != name]
        assert [(name, method, j) for j in others if j.verdict not in (RIGHT, OWN) or j.points != j.of] == []
        assert [(j.name, j.own) for j in others if j.verdict == OWN and name not in j.own] == []
    garbage = verdicts(ran, numbers, class_of.answers(sheet, numbers, "garbage"))
    assert sum(j.points for j in garbage.values()) <= 1  # `True` is an answer to a choice


SIMPLE = {"K": 2.3, "T": 14.0}
KC, RISE = 14 / 2.3 / 30, 30 * 2.1972246


@pytest.mark.parametrize(
    ("answers", "name", "verdict", "words"),
    [
        ({}, "Kc", MISSING, "missing"),
        ({"Kc": 0.203}, "Kc", RIGHT, "right"),
        ({"Kc": 0.20}, "Kc", ROUNDED, "right method, rounded too early"),
        ({"Kc": 0.467}, "Kc", METHOD, "that is the value with this mistake: gain left out"),
        ({"Kc": 203.0}, "Kc", UNIT, "wrong unit (factor 1000)"),
        ({"rise": RISE / 60}, "rise", UNIT, "wrong unit (factor 60, minutes for seconds)"),
        ({"Kc": -0.203}, "Kc", SIGN, "the size is right, the sign is not"),
        ({"Kc": 0.35}, "Kc", WRONG, "this is not the value"),
        ({"Kc": "0,203"}, "Kc", UNREADABLE, '"0,203" is a text, not a number: write 0.203, without quotes'),
        ({"Kc": 0.4, "rise": RISE * KC / 0.4}, "rise", OWN, "right from your own Kc"),
        ({"Kc": 0.4, "rise": RISE * KC / 0.4, "half": RISE * KC / 0.8}, "half", OWN, "right from your own Kc"),
        ({"rise": 50.0, "half": 25.0}, "half", OWN, "right from your own rise"),
        ({"Kc": 0.4, "rise": 50.0, "half": 25.0}, "half", OWN, "right from your own rise"),
        ({"Kc": 0.4, "rise": RISE}, "rise", RIGHT, "right"),
        ({"Kc": 0.4, "rise": -RISE * KC / 0.4}, "rise", SIGN, "the size is right, the sign is not, from your own Kc"),
        ({"Kc": 0, "rise": RISE}, "rise", RIGHT, "right"),
        ({"Kc": 1e300, "rise": 1.0}, "rise", WRONG, "this is not the value"),
    ],
)
def test_the_words_a_student_reads(runner_of, answers, name, verdict, words):
    _, judged = judge_all(runner_of(), SIMPLE, {n: Given(v) for n, v in answers.items()})
    found = {j.name: j for j in judged}[name]
    assert (found.verdict, found.words) == (verdict, words)


def test_a_value_that_the_sheet_cannot_go_on_with_is_left_out(runner_of, head):
    cells = (
        *head,
        ("md", "**1.** ?", "question"),
        ("code", "a = answer('a', 2.0)\nb = answer('b', 3.0)", "solution"),
        ("md", "**2.** ?", "question"),
        ("code", "c = answer('c', b / math.sqrt(a))", "solution"),
    )
    _, judged = judge_all(runner_of(*cells), SIMPLE, {"a": Given(-2.0), "b": Given(6.0), "c": Given(6 / 2**0.5)})
    assert [(j.verdict, j.own) for j in judged][2] == (OWN, ("b",))


def test_a_sheet_that_would_run_for_ever_with_a_student_s_value_is_stopped(runner_of, head, monkeypatch):
    monkeypatch.setattr("loopbook.course.grade.judging.SECONDS", 0.3)
    cells = (
        *head,
        ("md", "**1.** ?", "question"),
        ("code", "a = answer('a', 2.0)\nwhile a > 5:\n    pass\nb = answer('b', a + 1)", "solution"),
    )
    _, judged = judge_all(runner_of(*cells), SIMPLE, {"a": Given(9.0), "b": Given(3.0)})
    assert [j.verdict for j in judged] == [WRONG, RIGHT]


def test_conditions_are_named_where_they_fail(runner_of, head):
    cells = (
        *head,
        ("md", "**1.** ?", "question"),
        (
            "code",
            "a = answer('a', [1.0, 2.0], holds=lambda x, y: {'y is above x': y > x, 'x is above 0': 1 / x > 0})",
            "solution",
        ),
    )
    words = {}
    for raw in ([3.0, 4.0], [4.0, 3.0], [0.0, 1.0], "x"):
        words[str(raw)] = judge_all(runner_of(*cells), SIMPLE, {"a": Given(raw)})[1][0].words
    assert words["[3.0, 4.0]"] == "right: y is above x; x is above 0"
    assert words["[4.0, 3.0]"] == "this does not hold: y is above x"
    assert "cannot be computed" in words["[0.0, 1.0]"] and "in square brackets" in words["x"]
