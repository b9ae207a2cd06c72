"""A release: the same bytes again, nothing that gives an answer away, and a scanner that sees what was planted."""

import base64
import io
import json
import zipfile

import pytest

from loopbook.course.notebooks import as_bytes, source_of
from loopbook.course.release.leaks import LeakScanner
from loopbook.course.release.one import ReleaseJob, as_report, release_one, runner
from loopbook.course.release.student import paper_sheet, screen_sheet
from loopbook.course.release.zips import zipped

pytestmark = pytest.mark.builds

SECRET = b"0123456789abcdef0123456789abcdef"
NUMBERS = {"K": 1.7, "T": 17.0}  # Kc = 1/3, rise = 65.9, half = 33.0


@pytest.fixture
def ran(sheet_file, head, tail):
    drawing = (
        "code",
        "from loopbook.plots.curves import curves\nfrom notebook_reports.display import figure\n"
        "figure(curves({'y': {'lag': ([0, 7, 9], [0, 7, 8])}}, 'seen'), 'What was seen', 'A curve that rises')",
        "given",
    )
    path = sheet_file(*head, drawing, *tail)
    return runner("lag", path.read_bytes())


@pytest.fixture
def solved(ran):
    return ran.solve(NUMBERS, show="all")


@pytest.fixture
def scan(ran, solved):
    scanner = LeakScanner(ran.sheet, solved, SECRET)
    return lambda **files: [leak.what for leak in scanner.scan({n.replace("_", "."): c for n, c in files.items()})]


@pytest.fixture
def screen(ran, solved):
    return screen_sheet(ran.sheet, solved, "s1")


def test_a_student_gets_texts_figure_places_for_answers_and_nothing_else(screen, scan):
    texts = [source_of(c) for c in screen["cells"]]
    whole = "\n".join(texts)
    assert "The process $1.700/(17.00 s + 1)$" in whole and "![A curve that rises](attachment:c4-1.svg)" in whole
    assert "<details><summary>Hint</summary>\n\nThe logarithm of nine." in whole
    assert "→ `Kc`: a number, 3 digits (2 points)" in whole and "answer(" not in whole and "require" not in whole
    assert texts[-1].splitlines()[1] == '    "Kc": None,    # a number, 3 digits'
    assert scan(a_ipynb=as_bytes(screen)) == []
    import nbformat

    nbformat.validate(nbformat.from_dict(screen))


def test_two_releases_are_equal_byte_by_byte(ran, sheet_file):
    content = sheet_file().read_bytes()
    job = ReleaseJob("lag", content, "s1", NUMBERS, SECRET)
    one, two = release_one(job), release_one(job)
    assert one == two and not one.leaks
    assert set(one.student) == set(one.teacher) == {"lag.ipynb", "lag.pdf"}
    key = json.loads(one.teacher["lag.ipynb"])
    assert "K: float = 1.7  # {1.7, 2.3, 3.1}" in [source_of(c).splitlines()[0] for c in key["cells"]]
    assert one.keys["Kc"] == pytest.approx(1 / 3) and "**0.333**" in json.dumps(key)
    assert zipped(one.student) == zipped(dict(reversed(one.student.items())))


def _with(screen, change):
    content = json.loads(as_bytes(screen))
    change(content)
    return as_bytes(content)


def _attachment(mime, data):
    return lambda nb: (
        nb["cells"][0].setdefault("attachments", {}).update({"x": {mime: base64.b64encode(data).decode()}})
    )


def _drawing(text):
    return _attachment("image/svg+xml", f'<svg xmlns="http://www.w3.org/2000/svg">{text}</svg>'.encode())


PLANTED = {
    "the answer in a text": lambda nb: nb["cells"][0].update(source="about 0.3333 it is"),
    "a rounded answer in a hint": lambda nb: nb["cells"][-3].update(source="<!-- 65.9 -->"),
    "an output": lambda nb: nb["cells"][-1].update(outputs=[{"output_type": "stream", "name": "stdout", "text": "x"}]),
    "the answer in a cell's metadata": lambda nb: nb["cells"][2]["metadata"].update(key="MC4zMzMz"),
    "the answer in the notebook's metadata": lambda nb: nb["metadata"].update(note=65.91),
    "the numbers of the draw in the metadata": lambda nb: nb["metadata"]["loopbook"]["course"].update(variant=3),
    "a picture with notes": _attachment("image/png", b"\x89PNG....tEXtkey\x000.333"),
    "words in a drawing": _drawing("<text>K = 0.333</text>"),
    "a comment in a drawing": _drawing("<!-- 65.91 -->"),
    "an attribute in a drawing": _drawing('<g data-key="0.3333"/>'),
    "the secret": lambda nb: nb["cells"][0].update(source=SECRET.hex()),
    "the solution's source": lambda nb: nb["cells"][0].update(
        source='Kc = answer("Kc", T/K/30, points=2, wrong={"gain left out": T / 30})'
    ),
    "code": lambda nb: nb["cells"][-1].update(source="answers = {'Kc': 1 / 3}"),
}


@pytest.mark.parametrize("what", PLANTED)
def test_what_was_planted_in_a_notebook_is_found(what, screen, scan):
    assert scan(a_ipynb=_with(screen, PLANTED[what]))


def test_what_was_planted_in_a_pdf_or_an_archive_is_found(ran, solved, screen, scan):
    paper = paper_sheet(ran.sheet, solved, "s1")
    clean = as_report(paper, ran.sheet, "pdf")
    assert scan(a_pdf=clean) == []
    told = [{**c} for c in paper["cells"]]
    told[0]["source"] += "\n\nIt is 0.3333."
    leaking = as_report({**paper, "cells": told}, ran.sheet, "pdf")
    assert scan(a_pdf=leaking) == ["the answer Kc is printed"]
    assert scan(a_pdf=clean + b"\n% /EmbeddedFile") == ["a file inside the PDF"]
    assert scan(a_pdf=clean + SECRET) == ["the course's secret"]
    good = {"a.ipynb": as_bytes(screen), "a.pdf": clean}
    assert scan(a_zip=zipped(good)) == []
    assert scan(a_zip=zipped({**good, "key.txt": b"x"})) == ["key.txt: a file that belongs to no release"]
    assert scan(a_zip=zipped({**good, "b.pdf": leaking})) == ["b.pdf: the answer Kc is printed"]
    with zipfile.ZipFile(made := io.BytesIO(), "w") as archive:
        archive.comment = b"0.3333"
    assert scan(a_zip=made.getvalue()) == ["the archive has a comment"]


def test_an_id_may_have_any_digits(sheet_file):
    job = ReleaseJob("lag", sheet_file().read_bytes(), "c-65.9-0.333", NUMBERS, SECRET)
    assert release_one(job).leaks == []


def test_figures_may_have_axes(ran, solved, scan):
    """The numbers beside an axis are the scale of a figure, whatever an answer happens to be."""
    text = '<g id="ytick_1"><text>0.3333</text></g><path d="M 0.3333 65.9"/>'
    content = json.loads(as_bytes(screen_sheet(ran.sheet, solved, "s1")))
    _drawing(text)(content)
    assert scan(a_ipynb=as_bytes(content)) == []
