"""Names that come from data, of columns, of files, in exceptions, are text: in a report, in a figure, in a terminal."""

import io

import matplotlib.pyplot as plt
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from loopbook.cli import main
from loopbook.design import figures, tables
from loopbook.design.study import Study
from notebook_reports.display import Table, literal
from notebook_reports.export.model import Text
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.project.console import Console
from notebook_reports.project.failures import Failure, everything
from notebook_reports.project.printable import printable

NAMES = ["$x^2$", "5 $", "a`b`c", "`", r"C:\new\table", r"\frac{1}{2}", "a|b*c*_d_", "<b>x</b>", r"\$", "$`$`"]


def shown(text: str) -> str:
    nodes = read_inline(text)
    assert all(isinstance(node, Text) for node in nodes), nodes
    return "".join(node.text for node in nodes)


@pytest.mark.parametrize("name", NAMES)
def test_a_literal_is_shown_as_it_is(name):
    assert shown(literal(name)) == name


@given(st.text())
def test_any_text_is_shown_as_it_is(name):
    assert shown(literal(name)) == name


def record(folder, heads, name="r.csv"):
    t = np.arange(0, 30, 0.5)
    u, y = np.where(t > 3, 1.0, 0.0), np.where(t > 5, 2 * (1 - np.exp(-(t - 5) / 4)), 0)
    rows = "\n".join(f"{a};{b};{c}" for a, b, c in zip(t, u, y, strict=True))
    path = folder / name
    path.write_text(f"t;{heads[0]};{heads[1]}\n{rows}\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("heads", [("$x^2$", "y$"), (r"u\new", r"\alpha"), ("`u`", "<b>y"), ("\x1b[31mu", "y\x07")])
def test_a_name_of_data_is_text_in_a_report(tmp_path, heads):
    study = Study(record(tmp_path, heads, "r$1$`.csv"), "t")
    rows = [shown(row[1]) for row in tables.assumptions(study).rows]
    said = " ".join(rows)
    for head in heads:
        assert printable(head) in said and "\\\\" not in said.replace(r"\\x", "")
    assert "r$1$`.csv" in shown(study_source(study))
    drawing = figures.record(study.identified)
    for axis, head in ((drawing.axes[0], heads[1]), (drawing.axes[2], heads[0])):
        label = axis.yaxis.label
        assert label.get_text().replace(r"\$", "$") == printable(head)
        text, is_math = label._preprocess_math(label.get_text())
        assert not is_math or is_math == "TeX", text
    plt.close(drawing)


def study_source(study) -> str:
    """The cell of the summary that names the record's file, without running a design."""
    return literal(study.model.source)


TERMINAL = "a\x1b[31mred\x1b]0;title\x07\u202e\x9b2J\r\u2066b"


def test_what_a_terminal_would_obey_is_written_out(bench, tmp_path):
    assert printable(TERMINAL) == r"a\x1b[31mred\x1b]0;title\x07\u202e\x9b2J\r\u2066b"
    out = io.StringIO()
    Console(out).line(TERMINAL)
    assert "\x1b" not in out.getvalue() and "\u202e" not in out.getvalue()
    assert "\x1b" not in everything([Failure("a/b", TERMINAL, more=(TERMINAL,))])
    bench.write("a/b", "# T", f"raise ValueError({TERMINAL!r})")
    assert bench.build(formats=("ipynb",)).code == 1
    assert "\x1b" not in bench.said and r"\x1b[31mred" in bench.said
    result = CliRunner().invoke(main, ["--root", str(bench.root), "build", TERMINAL])
    assert result.exit_code == 2 and "\x1b" not in result.output


def test_a_table_of_such_names_is_a_page(tmp_path):
    from notebook_reports.export.page import Page, export_page

    page = export_page(Page("Names", [Table(["name"], [[literal(name)] for name in NAMES], "A caption")]))
    for name in NAMES:
        assert name.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;") in page
    assert "<math" not in page
