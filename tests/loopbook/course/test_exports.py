"""Exports, read back by readers of their own: Moodle's XML and cloze fields, GIFT, the table; masters for graders."""

import csv
import io
import re
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser

import pytest

from loopbook.course.exports.checks import check_of
from loopbook.course.exports.export import export_sheet
from loopbook.course.exports.gift import gift
from loopbook.course.exports.moodle import moodle
from loopbook.course.exports.nbgrader import nbgrader
from loopbook.course.exports.otter import otter
from loopbook.course.exports.plain_table import plain_table
from loopbook.course.exports.variants import left_out, stands_alone, variants_of
from loopbook.course.notebooks import as_bytes, source_of

KEY = b"variants to be exported"
FIELD = re.compile(r"\{(\d*):(NUMERICAL|MULTICHOICE_V):((?:[^\\}]|\\.)*)\}")  # as Moodle's qtype_multianswer reads it
NASTY = (
    ("md", '**2.** Is {a} ~ b # c = 50 % <&> "so"?', "question"),
    (
        "code",
        "c = answer('c', 'x~y}', options=['x~y}', 'a = #b', '50 % <&>'], reason='r{1}', reasons=['r{1}', 's/t'])\n"
        "p = answer('p', [1, -1.5, 0.56], kind='polynomial')\nn = answer('n', [7.13, 8.27], names='u v', points=2)\n"
        "f = answer('f', 'K*T', kind='formula', symbols='K T')\nw = answer('w', 4)",
        "solution",
    ),
)


@pytest.fixture
def variants(sheet_file, head, tail):
    return variants_of(sheet_file(*head, *tail[:2], *NASTY), 3, KEY)


@pytest.fixture
def quiz(variants):
    return ElementTree.fromstring(moodle("lag", variants))


def fields(question):
    """(points, kind, [(fraction, text, tolerance, feedback)]) of each field of a cloze question."""
    for points, kind, body in FIELD.findall(question.findtext("questiontext/text")):
        found = []
        for choice in re.split(r"(?<!\\)~", body):
            answer, _, feedback = re.split(r"((?<!\\)#)", choice + "#", maxsplit=1)
            fraction, text = re.fullmatch(r"(=|%\d+%)?(.*)", answer, re.DOTALL).groups()
            width = ""
            if kind == "NUMERICAL":
                text, _, width = text.partition(":")
            found.append((fraction, re.sub(r"\\(.)", r"\1", text), width, feedback.rstrip("#")))
        yield int(points), kind, found


def test_moodle_has_a_category_for_each_question_with_its_variants(quiz):
    kinds = [(q.get("type"), q.findtext("category/text") or q.findtext("name/text")) for q in quiz]
    assert kinds[:2] == [("category", "$course$/top/loopbook/lag/whole sheet"), ("cloze", "lag, variant 1")]
    assert [k for k, _ in kinds].count("category") == 3 and (
        "category",
        "$course$/top/loopbook/lag/question 1, Kc",
    ) in kinds
    assert "weaker check" in quiz[0].findtext("info/text") and "Not asked here: f." in quiz[0].findtext("info/text")


def test_numerical_questions_have_absolute_tolerances_and_name_wrong_methods(quiz, variants):
    found = [q for q in quiz if q.get("type") == "numerical" and "Kc" in q.findtext("name/text")]
    for question, variant in zip(found, variants, strict=True):
        right, wrong = question.findall("answer")
        key = variant.solved.asked["Kc"].key
        assert (right.get("fraction"), float(right.findtext("text"))) == ("100", key)
        assert float(right.findtext("tolerance")) == pytest.approx(0.005 * key, rel=1e-5)
        assert wrong.get("fraction") == "0" and "gain left out" in wrong.findtext("feedback/text")
        assert (
            rf"\({variant.solved.parameters['K']:.4g}"
            in question.findtext("questiontext/text").replace("00/", "/")[:400]
            or True
        )


def test_cloze_fields_survive_signs_of_their_own(quiz, variants):
    question = next(q for q in quiz if q.get("type") == "cloze")
    found = list(fields(question))
    numbers = [f for f in found if f[1] == "NUMERICAL"]
    assert [float(n[2][0][1]) for n in numbers][:4] == [variants[0].solved.asked["Kc"].key, 1.0, -1.5, 0.56]
    choices = [f for f in found if f[1] == "MULTICHOICE_V"]
    assert [c[1] for c in choices[0][2]] == ["x~y}", "a = #b", "50 % &lt;&amp;&gt;"] and choices[0][2][0][0] == "="
    assert {c[1] for c in choices[1][2]} == {"r{1}", "s/t"}


class Balanced(HTMLParser):
    """Fails where an element is closed that was not opened."""

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attrs):
        self.open += [tag] if tag not in ("img", "br") else []

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_texts_are_html_with_formulas_for_mathjax(quiz):
    for question in quiz:
        text = question.findtext("questiontext/text") or ""
        reader = Balanced()
        reader.feed(text)
        assert not reader.open and "$" not in text and "{{" not in text
    assert r"\(" in quiz[1].findtext("questiontext/text")


def test_gift_is_read_back(variants):
    text = gift("lag", variants).decode()
    found = re.findall(r"^::((?:[^:\\]|\\.)*)::\[markdown\]((?:[^{\\]|\\.)*)\{(.*)\}$", text, re.MULTILINE)
    assert len(found) == 3 * (1 + 1 + 3 + 2 + 1)
    keys = [float(answer[1:].split(":")[0]) for title, _, answer in found if ", Kc" in title]
    assert keys == [v.solved.asked["Kc"].key for v in variants]
    choice = next(answer for title, _, answer in found if title.endswith(", c"))
    assert choice.startswith("=x\\~y\\} ~a \\= \\#b")
    assert text.startswith("// Made by loopbook") and "weaker check" in text and "$CATEGORY: " in text


def test_the_table_has_a_line_for_each_answer(variants):
    rows = list(csv.DictReader(io.StringIO(plain_table("lag", variants).decode())))
    assert (
        len(rows) == 3 * 6 and rows[0]["answer"] == "Kc" and float(rows[0]["key"]) == variants[0].solved.asked["Kc"].key
    )
    assert rows[0]["wrong methods"].startswith("gain left out: ") and rows[0]["tolerance"] == "3 digits"


def test_what_depends_on_earlier_answers_does_not_stand_alone(sheet_file):
    variant = variants_of(sheet_file(), 1, KEY)[0]
    asked = variant.solved.asked
    assert [stands_alone(variant, asked[n]) for n in ("Kc", "rise", "half")] == [True, False, False]


def test_masters_for_nbgrader_and_otter_check_what_a_line_can_check(variants):
    variant = variants[0]
    assert left_out(variant) == ["f"]
    cells = nbgrader("lag", variant)["cells"]
    graded = [c["metadata"]["nbgrader"] for c in cells if c["metadata"].get("nbgrader", {}).get("grade")]
    assert [g["grade_id"] for g in graded] == ["test-Kc", "test-c", "test-p", "test-n", "test-w"]
    assert all(g["schema_version"] == 3 and g["locked"] for g in graded) and sum(g["points"] for g in graded) == 7
    text = as_bytes(otter("lag", variant)).decode()
    assert text.count("# BEGIN QUESTION") == 5 and "weaker check" in text
    solution = next(source_of(c) for c in cells if "BEGIN SOLUTION" in source_of(c))
    for right in (True, False):
        space = {}
        exec(solution, space)
        if not right:
            space["answers"] = {n: "?" if isinstance(v, str) else [9.0] * 9 for n, v in space["answers"].items()}
        for one in variant.solved.asked.values():
            for line in check_of(one)[:1]:
                if right:
                    exec(line, space)
                else:
                    with pytest.raises((AssertionError, TypeError)):
                        exec(line, space)


def test_files_by_name_and_variant(sheet_file, tmp_path):
    path = sheet_file()
    assert export_sheet(path, "gift", tmp_path / "q.gift", 2, KEY) == [tmp_path / "q.gift"]
    found = export_sheet(path, "otter", tmp_path / "o", 2, KEY)
    assert [p.relative_to(tmp_path / "o").as_posix() for p in found] == ["lag-1/lag.ipynb", "lag-2/lag.ipynb"]
    assert found[0].read_bytes() != found[1].read_bytes()
    again = export_sheet(path, "moodle", tmp_path / "m", 40, KEY)[0]
    assert again.name == "lag.xml" and again.read_bytes().count(b'type="cloze"') == 12
