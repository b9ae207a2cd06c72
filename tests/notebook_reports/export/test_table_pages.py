"""Tables over pages and columns of numbers: groups are named again, rows stay whole, decimal points stand in line."""

import re

import pytest
from tools.pages.page_words import in_the_text, text_of

from notebook_reports.display import Table
from notebook_reports.export.exporters.choose import export
from notebook_reports.export.model import plain
from notebook_reports.export.read.pdf_text import PdfText
from notebook_reports.export.read.tables import from_data

SAID = "The level of the lower tank follows that of the upper one, later and more slowly, and never faster than that. "


def grouped(rows_of_each, groups=("Table 5.2", "section 4.3")):
    rows = [[group, f"row {group[-1]} {n}", SAID * 2] for group in groups for n in range(rows_of_each)]
    return Table(["place", "what", "the document says"], rows, "Grouped", ["left"] * 3, groups=1)


@pytest.mark.builds
def test_the_name_of_a_group_stands_once_and_again_at_the_head_of_each_page(make):
    pdf = PdfText(export(make.notebook("# T", make.code(grouped(30), source="")), "pdf", name="a/b"))
    pages = [text_of([r for r in in_the_text(pdf) if r.page == page]) for page in range(1, len(pdf.sizes) + 1)]
    rows = {page: set(re.findall(r"row (\d) \d+", text)) for page, text in enumerate(pages)}
    assert len(pages) > 3
    for page, text in enumerate(pages):
        for last, name in (("2", "Table 5.2"), ("3", "section 4.3")):
            assert text.count(name) == (last in rows[page]), (page, name)


@pytest.mark.builds
def test_rows_are_not_divided_between_pages(make):
    for before in range(0, 12, 3):
        prose = "\n\n".join("A paragraph before it." for _ in range(before))
        nb = make.notebook(f"# T\n\n{prose}", make.code(grouped(12, ("Table 1",)), source=""))
        pdf = PdfText(export(nb, "pdf", name="a/b"))
        for page in range(1, len(pdf.sizes) + 1):
            text = text_of([r for r in in_the_text(pdf) if r.page == page])
            assert text.count("never") == text.count("The level"), "sentences begin and end on the same page"
            assert text.count("never") == 2 * len(re.findall(r"row 1 \d+", text))


def test_on_the_screen_a_repeated_name_is_there_for_who_searches(make):
    page = make.html(make.notebook("# T", make.code(grouped(2))))
    assert page.count('<td class="again">Table 5.2</td>') == 1 and page.count("<td>Table 5.2</td>") == 1
    shown = grouped(2)._repr_mimebundle_()["text/html"]
    assert shown.count("Table 5.2") == 1 and shown.count("<tr>") == 5


def pads(*numbers):
    grid = from_data(Table(["a", "b"], [["x", n] for n in numbers]).data())
    return [cell.pad for cell in grid.cells if cell.x == 1 and cell.y]


@pytest.mark.parametrize(
    ("numbers", "wanted"),
    [
        (("0.075", "4.98", "12"), ["", "0", ".000"]),
        (("1", "2"), ["", ""]),
        (("1.5", "2.5"), ["", ""]),
        (("3.66 s", "0.5 s"), ["", "0"]),
        (("−1.25", "3"), ["", ".00"]),
        (("1.5e−6", "3.25"), ["", ""]),
        (("1.5", "none"), ["", ""]),
        (("0.00000001", "123456789"), ["", ""]),
    ],
)
def test_decimal_points_stand_below_each_other_where_that_costs_little(numbers, wanted):
    assert pads(*numbers) == wanted


@pytest.mark.builds
def test_on_the_page_decimal_points_are_in_line(make):
    numbers = ("0.075", "4.98", "12.5", "3")
    table = make.code(Table(["a", "b"], [[f"x{n}", n] for n in numbers], "Numbers"), source="")
    runs = list(PdfText(export(make.notebook("# T", table), "pdf", name="a/b")).runs())
    ends = {}
    for run in runs:
        text = run.text.strip()
        if text in numbers:
            ends[text] = run.x1
    wide = ends["0.075"]
    digit = (wide - ends["12.5"]) / 2
    assert len(ends) == 4 and 3.5 < digit < 6
    assert ends["4.98"] == pytest.approx(wide - digit, abs=0.15)
    assert ends["3"] < ends["12.5"] - 1.2 * digit


def test_on_the_screen_numbers_leave_the_room_of_what_they_lack(make):
    page = make.html(make.notebook("# T", make.code(Table(["a", "b"], [["x", "0.075"], ["y", "12"]]))))
    assert 'style="padding-right:calc(.6rem + 3.5ch)">12</td>' in page and ">0.075</td>" in page


def test_of_a_marked_sentence_only_the_symbol_is_coloured(make):
    rows = [["a", SAID], ["b", "holds"]]
    table = Table(["what", "verdict"], rows, "Marks", ["left", "left"], (), ["good", "good"])
    page = make.html(make.notebook("# T", make.code(table)))
    assert f'<td class="long"><span class="symbol good">✓</span> {SAID.strip()}' in page
    assert '<td class="good"><span class="symbol good">✓</span> holds</td>' in page
    assert plain(from_data(table.data()).cells[-1].children) == "holds"
