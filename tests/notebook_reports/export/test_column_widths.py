"""The cells that decide the widths of columns, against the engine's own measure of every cell."""

import json
import random

import pytest
import typst

from notebook_reports.export.model import Cell, Code, Grid, Math, Text
from notebook_reports.export.write.column_widths import SIZE, breakable_words, deciding, extent, row_heights, unbroken
from notebook_reports.export.write.typst_engine import fonts
from notebook_reports.export.write.typst_text import typst_string

pytestmark = pytest.mark.builds

VOCABULARY = (
    *(
        "the",
        "regulator",
        "illimitable",
        "oscillates",
        "WWW",
        "mmm",
        "I/O",
        "T_i",
        "0.35",
        "−12.5",
        "e.g.",
        "stability",
    ),
    *(
        "MIGO",
        "iii",
        "(PI)",
        "of",
        "a",
        "with",
        "antiwindup,",
        "first-order;",
        "proportional",
        "1000",
        "WARNING",
        "jiffy",
    ),
    *("fill", "Ms=1.4", "bandwidth", "overshoot", "%", "minimum"),
)


def column(texts, align="left", head=True):
    cells = [Cell([Text(text)], 0, y, align=align, head=head and y == 0) for y, text in enumerate(texts)]
    return Grid(cells, 1, len(texts), int(head))


def measured(texts, tmp_path):
    """The width of each text in points as the engine sets it, the first one bold."""
    bodies = ", ".join(f"[#{'strong' if i == 0 else ''}[#{typst_string(t)}]]" for i, t in enumerate(texts))
    source = f'#set text(font: ("Libertinus Serif", "DejaVu Sans"), size: {SIZE}pt, number-type: "lining")\n'
    source += f"#context [#metadata(({bodies},).map(b => measure(b).width / 1pt)) <widths>]"
    (tmp_path / "main.typ").write_text(source, encoding="utf-8")
    compiler = typst.Compiler(str(tmp_path / "main.typ"), root=str(tmp_path), font_paths=fonts())
    return json.loads(compiler.query("<widths>", field="value", one=True))


@pytest.mark.parametrize("seed", range(12))
def test_the_widest_cell_is_among_those_measured(seed, tmp_path):
    draw = random.Random(seed)
    texts = [" ".join(draw.choices(VOCABULARY, k=draw.randint(1, 9))) for _ in range(40)]
    widths = measured(texts, tmp_path)
    (chosen,) = deciding(column(texts)).widest
    assert max(widths[place] for place in chosen) == pytest.approx(max(widths), rel=1e-12)
    assert len(chosen) < len(texts)


@pytest.mark.parametrize("seed", range(12))
def test_the_longest_word_is_in_a_cell_that_is_measured(seed, tmp_path):
    draw = random.Random(seed)
    texts = [" ".join(draw.choices(VOCABULARY, k=draw.randint(3, 9))) for _ in range(40)]
    (chosen,) = deciding(column(texts, head=False)).solid
    each = sorted({word for text in texts for word in breakable_words(text)})
    width = dict(zip(each, measured(["", *each], tmp_path)[1:], strict=True))
    longest = [max(width[word] for word in breakable_words(text)) for text in texts]
    assert max(longest[place] for place in chosen) == pytest.approx(max(longest), rel=1e-12)


def test_estimates_are_near_the_engines_measure(tmp_path):
    texts = ["", *(" ".join(VOCABULARY[i : i + 4]) for i in range(0, len(VOCABULARY) - 4))]
    estimates = [extent(Cell([Text(text)]))[1] for text in texts[1:]]
    for estimate, width in zip(estimates, measured(texts, tmp_path)[1:], strict=True):
        assert estimate == pytest.approx(width, rel=0.15)


def test_cells_that_differ_in_their_digits_only_are_measured_once():
    numbers = [f"{n / 100:.2f}" for n in range(100, 200)]
    assert deciding(column(numbers, "right", head=False)).widest == ((0,),)


def test_a_formula_is_measured_where_it_may_be_the_widest_and_decides_for_no_text():
    fraction = Math(r"\frac{a + b + c + d + e + f + g + h}{i}")
    grid = column(["a text that is much wider than any letter", "x", "y", "a short text"], head=False)
    grid.cells[1].children, grid.cells[2].children = [fraction], [Math("K")]
    assert deciding(grid).widest == ((0, 1),)
    grid.cells[0].children = [Text("a text of some words")]
    assert deciding(grid).widest == ((0, 1),), "read as text the formula is longer, set it may not be"


def test_numbers_and_a_few_letters_are_not_broken_but_sentences_are():
    assert unbroken(Cell([Text("1.0 and more words")], align="right")) and unbroken(Cell([Text("T_i of K")]))
    assert not unbroken(Cell([Text("a whole sentence")]))
    assert unbroken(Cell([Text("from rounded inputs")], mark="note"))
    assert not unbroken(Cell([Text("a sentence that carries the colour of a verdict")], mark="note"))
    assert not unbroken(Cell([Text("phase margin in degrees")], align="right", head=True))


def test_letters_of_code_are_equally_wide():
    assert extent(Cell([Code("ill")])) == extent(Cell([Code("mmm")])) != extent(Cell([Code("mm")]))


def test_a_table_gets_higher_with_its_rows_and_with_what_they_hold():
    low, long, many = column(["a"] * 3), column(["a", "word " * 80, "c"]), column(["a"] * 30)
    assert sum(row_heights(low)) < sum(row_heights(long)) < sum(row_heights(many))


def test_a_column_of_numbers_is_tight_whatever_its_head():
    grid = column(["a head of many words", "1.5", "2.5"], "right")
    assert deciding(grid).tight == (True,)
    grid.cells[1].children, grid.cells[1].align = [Text("a sentence among the numbers")], "left"
    assert deciding(grid).tight == (False,)


def test_one_long_cell_does_not_decide_what_a_column_needs():
    long, even = column(["head", "word " * 60, *["word"] * 20]), column(["head", *["word " * 20] * 21])
    assert deciding(long).weight[0] < deciding(even).weight[0]
    assert deciding(column(["only a head"])).weight == (0.0,)
