"""Exercises: solutions stand last in a report of their own, in a chapter of their own in a book."""

import pytest

from notebook_reports.display import Listing
from notebook_reports.export.book import Chapter, export_book
from notebook_reports.export.exporters.choose import export
from notebook_reports.export.read.notebook import read
from notebook_reports.export.read.pdf_text import PdfText
from notebook_reports.export.read.solutions import ALONE, LAST, LEFT_OUT, arranged, has_solutions


def tagged(make, text, tag, *outputs):
    cell = make.code(*outputs) if outputs else make.notebook(text).cells[0]
    cell["metadata"]["tags"] = [tag]
    cell["source"] = text
    return cell


@pytest.fixture
def sheet(make):
    return make.notebook(
        "# A sheet\n\nText.",
        tagged(make, "hidden = 4710", "parameters", Listing("none")),
        tagged(make, "drawn(K)", "given", Listing("a drawing")),
        tagged(make, "**1.** How large?", "question"),
        tagged(make, "secret = 4711", "solution", Listing("it is four")),
        tagged(make, "Look again.", "hint"),
        tagged(make, "2. How often?", "question"),
        tagged(make, "secret = 4712", "solution", Listing("it is five")),
        tagged(make, "because", "solution"),
    )


def test_the_ways(sheet, make):
    assert [number for number, _ in arranged(sheet, LEFT_OUT)] == [1, 3, 4, 6, 7]
    texts = [cell["source"] for _, cell in arranged(sheet, ALONE)]
    assert texts == ["hidden = 4710", "**1.**", "secret = 4711", "**2.**", "secret = 4712", "because"]
    assert [cell["source"] for _, cell in arranged(sheet, LAST)][3:7] == [
        "*Hint.* Look again.",
        "2. How often?",
        "## Solutions",
        "hidden = 4710",
    ]
    plain = make.notebook("# No exercise")
    assert not has_solutions(plain) and [n for n, _ in arranged(plain, LAST)] == [1] and arranged(plain, ALONE) == []
    with pytest.raises(ValueError, match="solutions are last"):
        arranged(sheet, "first")


def test_a_given_cell_shows_what_it_gives_and_not_its_code(sheet):
    report = read(sheet, "a/sheet")
    assert [cell.number for cell in report.cells] == [1, 3, 4, 6, 7, 2, 2, 5, 5, 8, 8, 9]
    words = repr(report.cells)
    assert "a drawing" in words and "drawn(K)" not in words and "secret = 4711" in words


@pytest.mark.builds
def test_in_a_report_and_in_a_book(sheet, make):
    def words(pdf):
        return "".join(run.text for run in PdfText(pdf).runs())

    alone = words(export(sheet, "pdf", name="a/sheet"))
    assert alone.index("How often?") < alone.index("Solutions") < alone.index("4711") < alone.index("4712")
    after = Chapter("a/sheet/solutions", sheet, title="Solutions: A sheet", part="Solutions", solutions=ALONE)
    book = words(
        export_book(
            [
                Chapter("a/sheet", sheet, part="Exercises", solutions=LEFT_OUT),
                Chapter("b/x", make.notebook("# Other\n\nOther text."), part="Other"),
                after,
            ],
            title="A book",
        )
    )
    assert book.rindex("Other text.") < book.index("4711") and book.count("4711") == 1
