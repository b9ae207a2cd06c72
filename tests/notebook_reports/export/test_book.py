"""One PDF of many notebooks."""

import pytest

from notebook_reports.display import Equation, Table
from notebook_reports.export import book
from notebook_reports.export.book import Chapter, LinkedTable, Page, export_book
from notebook_reports.export.exporters.choose import ExportError
from notebook_reports.export.write import typst_engine

pytestmark = pytest.mark.builds


@pytest.fixture
def written(monkeypatch):
    """Builds a book; gives its Typst source."""
    sources = []
    compiled = book.compile_settled

    def spy(write):
        return compiled(lambda turned: (sources.append(write(turned)), sources[-1])[1])

    monkeypatch.setattr(book, "compile_settled", spy)

    def build(*arguments, **told):
        assert export_book(*arguments, **told).startswith(b"%PDF")
        return sources[-1][0]

    return build


@pytest.fixture
def chapters(make):
    table = make.code(Table(["a"], [["x"]], "Caption"))
    one = make.notebook(
        "# First\n\n## Same\n\n[next](02.ipynb#Same)[^1]\n\n[^1]: n", table, make.code(Equation("x", "1", "d"))
    )
    two = make.notebook("# Second\n\n## Same\n\n[back](notebook:d/01#eq-d-1) and [all](notebook:d/01)", table)
    return [Chapter("d/01", one, part="One", document="d"), Chapter("d/02", two, part="Two", document="d")]


def test_one_numbering_and_links_inside(chapters, written):
    ledger = LinkedTable(
        Table(["place", "page"], [["Table 1", ""]], "All"),
        {(0, 0): "notebook:d/01#cell-2", (0, 1): "notebook:d/01#cell-2"},
        frozenset({(0, 1)}),
    )
    told = {
        "title": "Book",
        "lines": ["$n = 2$ chapters"],
        "appendix": [Page("Ledger", [ledger, "See [one](notebook:d/01)."])],
    }
    source = written(chapters, **told)
    for piece in (
        '#part("I")',
        '#part("II")',
        '#chapter(2, "1", (label("d/01"), label("d/01#First"),))',
        '#section(3, "1.1", label("d/01#Same"))',
        '#section(3, "2.1", label("d/02#Same"))',
        '"Table 1.1"',
        '"Table 2.1"',
        '#inner(label("d/02#Same"))',
        '#inner(label("d/01#eq-d-1"))',
        '#chapter(2, "A", ',
        '"Table A.1"',
        '#page-of(label("d/01#cell-2"))',
    ):
        assert piece in source, piece
    pdf = export_book(chapters, **told)
    assert pdf.startswith(b"%PDF") and pdf == export_book(chapters, **told)


def test_what_stands_below_the_title_of_a_part(make, written):
    one = Chapter("a", make.notebook("# A"), part="One", about="About $x$")
    assert '#part("I", about: [#"About ";#m(' in written([one], title="B")
    two = Chapter("b", make.notebook("# B"), part="One", about="not the first")
    assert "not the first" not in written([one, two], title="B")


def test_without_parts_chapters_are_the_first_level(make, written):
    source = written([Chapter("a", make.notebook("# A\n\n## S"))], title="B")
    assert '#chapter(1, "1", ' in source and '#section(2, "1.1", ' in source


@pytest.mark.parametrize(
    ("link", "told"),
    [
        ("notebook:d/09", "a link to no chapter d/09 of this book"),
        ("02.ipynb#Gone", "a link to no place #Gone in d/02 of this book"),
    ],
)
def test_dead_links_are_named(make, chapters, link, told):
    bad = Chapter("d/03", make.notebook("# Third", f"[x]({link})"))
    with pytest.raises(ExportError, match=f"d/03, cell 2: {told}"):
        export_book([*chapters, bad], title="Book")


def test_a_page_that_cannot_be_set_names_its_chapter_and_cell(make, chapters):
    with pytest.raises(ExportError, match="d/03, cell 2: no font of the report has '水'"):
        export_book([*chapters, Chapter("d/03", make.notebook("# Third", "水"))], title="Book")


def test_empty_books_and_names_twice(chapters):
    with pytest.raises(ValueError, match="at least one chapter"):
        export_book([], title="Book")
    with pytest.raises(ValueError, match="twice here: d/01"):
        export_book([chapters[0], chapters[0]], title="Book")


def test_a_table_that_a_report_turned_is_not_found_too_wide_again(make, monkeypatch):
    wide = make.code(Table([f"column {x}" for x in range(16)], [["1234.5"] * 16] * 3, "Wide"))
    chapter = Chapter("d/01", make.notebook("# First", wide))
    monkeypatch.setattr(typst_engine, "_wide", set())
    written = []
    compiled = typst_engine.compile_pdf

    def spy(source, files):
        written.append(source)
        return compiled(source, files)

    monkeypatch.setattr(typst_engine, "compile_pdf", spy)
    alone = export_book([chapter], title="Book")
    assert ["#landscape[" in source for source in written] == [False, True]
    assert export_book([chapter], title="Book") == alone and len(written) == 3
    other = make.notebook("# First", make.code(Table(["column"], [["1234.5"]] * 3, "Narrow")))
    export_book([Chapter("d/01", other)], title="Book")
    assert len(written) == 4 and "#landscape[" not in written[-1], "the same place holds another table now"
