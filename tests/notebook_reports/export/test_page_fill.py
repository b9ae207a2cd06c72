"""Pages are filled: code and figure part, text flows in, and what introduces something stays with it."""

import pytest
from tools.pages.page_fill import fills
from tools.pages.page_words import in_the_text, text_of

from notebook_reports.display import Figure, Table
from notebook_reports.export.exporters.choose import export
from notebook_reports.export.read.pdf_text import PdfText
from notebook_reports.export.write.arrangement import Place, to_float

pytestmark = pytest.mark.builds

PROSE = "The level of the lower tank follows that of the upper one, later and more slowly, and never faster. " * 3


def drawing(height, word):
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="400" height="{height}"><rect width="400" height="{height}"'
        f' fill="none" stroke="black"/><text x="9" y="{height / 2}">{word}</text></svg>'
    )


def chapter(make, heights, code_lines=6):
    """Sections of prose, a lead-in, code and a figure of each height."""
    cells = ["# A report"]
    for i, height in enumerate(heights, start=1):
        cells += [f"## Section {i}\n\n{PROSE}\n\nHere is drawing {i}:"]
        source = "\n".join(f"line_{n} = {i}" for n in range(code_lines))
        cells += [make.code(Figure(drawing(height, f"drawn {i}"), f"Caption {i}.", f"Drawing {i}"), source=source)]
        cells += [f"{PROSE}\n\n{PROSE}"]
    return make.notebook(*cells)


def pages_of(pdf):
    """The words of each page."""
    text = PdfText(pdf)
    runs = list(in_the_text(text))
    return {page: text_of([run for run in runs if run.page == page]) for page in range(1, len(text.sizes) + 1)}


@pytest.mark.parametrize(
    "heights", [[420, 430, 440, 450, 460], [300] * 9, [560, 200, 560, 200, 560, 200]], ids=["large", "equal", "mixed"]
)
def test_no_page_is_left_empty_by_a_figure_that_did_not_fit(make, heights):
    pdf = export(chapter(make, heights), "pdf", name="a/b")
    inside = [fill for fill in fills(pdf) if fill.inside]
    assert len(inside) >= 2
    assert max(fill.empty for fill in inside) < 0.25
    words = " ".join(pages_of(pdf).values())
    captions = [words.index(f"Figure {i}.") for i in range(1, len(heights) + 1)]
    assert captions == sorted(captions), "figures keep their order"


def test_a_page_says_how_empty_it_is(make):
    below = make.markdown("More.")
    below["metadata"]["tags"] = ["new-page"]
    nb = make.notebook("# T\n\nWords.", make.code({"image/svg+xml": drawing(330, "x")}, source=""), below)
    below_that = make.markdown("Last.")
    below_that["metadata"]["tags"] = ["new-page"]
    nb["cells"].append(below_that | {"id": "cell-9"})
    first, second, third = fills(export(nb, "pdf", name="a/b", strict_alt=False))
    assert 0.4 < first.empty < 0.6, "title, words and a picture of 250 points on 694"
    assert second.empty > 0.9
    assert [fill.inside for fill in (first, second, third)] == [False, True, False]


@pytest.mark.parametrize("lines", range(20, 33))
def test_a_lead_in_stands_on_the_page_of_what_it_introduces(make, lines):
    """Wherever the page ends."""
    before = "\n\n".join(f"Line {n} of what stands before." for n in range(lines))
    table = make.code(Table(["q", "v"], [["first row", 1.0], ["second row", 2.0]], "A table"), source="show()")
    pages = pages_of(export(make.notebook(f"# T\n\n{before}\n\nThe two values are:", table), "pdf", name="a/b"))
    place = {word: page for page, words in pages.items() for word in ("two values are", "show()") if word in words}
    assert place["two values are"] == place["show()"]


def test_a_listing_leaves_no_line_alone_at_the_end_of_a_page(make):
    for lines in range(38, 46):
        before = "\n".join(f"before_{n}" for n in range(lines))
        after = "\n".join(f"after_{n:02}" for n in range(12))
        nb = make.notebook("# T", make.code(source=before), make.code(source=after))
        pages = pages_of(export(nb, "pdf", name="a/b"))
        counts = [text.count("after_") for text in pages.values() if "after_" in text]
        assert all(count >= 3 for count in counts), (lines, counts)


def test_only_figures_that_begin_a_page_or_are_overtaken_float():
    places = [Place("a/b 1 x", 1, 90.0), Place("a/b 2 y", 3, 76.5), Place("a/b 3 z", 2, 300.0), Place("c 1 w", 1, 76.5)]
    assert to_float(places, frozenset()) == {"a/b 2 y"}
    overtaken = [Place("a/b 1 x", 3, 200.0), Place("a/b 2 y", 2, 300.0)]
    assert to_float(overtaken, frozenset()) == {"a/b 1 x"}
    assert to_float(overtaken, frozenset({"a/b 1 x"})) == set()
