"""Small parts: where formulas break, how tables are read, what a terminal shows, inline text."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Code, Math, Text, plain
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.export.read.reading import Reading
from notebook_reports.export.read.tables import _NUMBER, align_numbers, grid_of
from notebook_reports.export.read.terminal import settle
from notebook_reports.export.write.breaking import formula_pieces
from notebook_reports.export.write.typst_text import breakable, typst_string

TOKENS = [
    "a",
    "b_1",
    " ",
    "=",
    "+",
    "-",
    r"\left(",
    r"\right)",
    "{",
    "}",
    r"\frac",
    r"\le",
    "(",
    ")",
    r"\quad",
    ",",
    "^",
]


@given(st.lists(st.sampled_from(TOKENS)).map("".join))
def test_pieces_joined_are_the_formula(latex):
    assert "".join(formula_pieces(latex)) == latex


@pytest.mark.parametrize(
    ("latex", "count"),
    [
        ("a = b + c", 3),
        ("a = -b", 2),
        (r"\frac{a + b}{c}", 1),
        (r"f(a + b) = 0", 2),
        (r"\left.x + y\right|_{x = 0} = 1", 2),
        (r"\left]a + b\right[ = I", 2),
        (r"\begin{pmatrix} a + b & c \\ d & e \end{pmatrix} = M", 2),
        (r"a &= b \\ c &= d", 1),
        (r"e^{-a} + x_{i+1}", 2),
        (r"a = b, \quad c = d", 4),
    ],
)
def test_lines_end_outside_brackets_only(latex, count):
    assert len(formula_pieces(latex)) == count


@given(st.text())
def test_a_string_literal_holds_any_text(text):
    inside = typst_string(text)[1:-1]
    assert '"' not in inside.replace("\\\\", "").replace('\\"', "") and "\n" not in inside


@given(st.text(alphabet="abc/_-. (),", max_size=200))
def test_places_to_break_change_no_character(text):
    assert breakable(text).replace("\u200b", "") == text


@pytest.mark.parametrize(
    "text", ["1", "-1.5", "−1.2e−5".replace("e−5", "e-5"), "+3.0e+05", "12 %", "nan", "0.5+0.2j", "−", "1 000"]
)
def test_numbers_are_known(text):
    assert _NUMBER.fullmatch(text)


@pytest.mark.parametrize("text", ["v1", "1 tank", "a", "e5", "2026-01-02"])
def test_other_texts_are_no_numbers(text):
    assert not _NUMBER.fullmatch(text)


def test_inline_text():
    assert read_inline(r"\$5 for $x_1$ and `a$b`") == [Text("$5 for "), Math("x_1"), Text(" and "), Code("a$b")]
    with pytest.raises(CannotShow, match="without its partner"):
        read_inline("costs $5")


@pytest.mark.parametrize(
    ("printed", "seen"),
    [
        ("a\rb", "b"),
        ("abc\rd", "dbc"),
        ("ab\b\bc", "c"),
        ("\x1b[1;31mx\x1b[0m", "x"),
        ("\x1b]8;;u\x07t", "t"),
        ("a\tb", "a       b"),
    ],
)
def test_terminal(printed, seen):
    assert settle(printed) == seen


def test_html_tables_keep_spans_heads_and_sides():
    from notebook_reports.export.read.html import read_html

    source = (
        "<table><caption>About $x$</caption><tr><th rowspan=2></th><th colspan=2>pair</th></tr>"
        "<tr><th>a</th><th>b</th></tr><tr><th>row</th><td>1.5</td><td>word</td></tr></table>"
    )
    (grid,) = read_html(source, Reading())
    assert (grid.columns, grid.rows, grid.head_rows) == (3, 3, 2)
    assert plain(grid.caption) == "About $x$"
    cells = {(c.x, c.y): c for c in grid.cells}
    assert (cells[0, 0].rowspan, cells[1, 0].colspan, cells[1, 0].align) == (2, 2, "center")
    assert (cells[1, 2].align, cells[1, 1].align, cells[2, 2].align, cells[0, 2].align) == (
        "right",
        "right",
        "left",
        "left",
    )


def test_rows_of_a_grid_with_a_span_to_the_end():
    from notebook_reports.export.model import Cell

    grid = grid_of([[Cell([], rowspan=9), Cell([])], [Cell([])]], 0)
    align_numbers(grid)
    assert [(c.x, c.y, c.rowspan) for c in grid.cells] == [(0, 0, 2), (1, 0, 1), (1, 1, 1)]
