"""What a notebook shows carries its content as data beside what Jupyter draws."""

import pytest
import sympy

from notebook_reports.display import (
    EQUATION_MIME,
    FIGURE_MIME,
    TABLE_MIME,
    Equation,
    Figure,
    Table,
    equation,
    figure,
    number,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (8360, "8360"),
        (0.65, "0.65"),
        (-1.5e-7, "−1.5e−7"),
        (float("inf"), "∞"),
        (float("nan"), "nan"),
        (1 / 3, "0.33333"),
    ],
)
def test_number(value, text):
    assert number(value) == text


def test_a_table_carries_rows_caption_and_alignment():
    table = Table(["method", "$K$"], [["PI", 4.13333], ["a < b", "–"]], "Settings", notes=["from a step"])
    bundle = table._repr_mimebundle_()
    assert bundle[TABLE_MIME]["rows"] == [["PI", "4.1333"], ["a < b", "–"]]
    assert bundle[TABLE_MIME]["align"] == ["left", "right"]
    assert "a &lt; b" in bundle["text/html"] and "<caption>Settings</caption>" in bundle["text/html"]


def test_a_table_refuses_rows_of_another_length():
    with pytest.raises(ValueError, match="row 2 has 1 cells, the head has 2"):
        Table(["a", "b"], [["1", "2"], ["3"]])
    with pytest.raises(ValueError, match="align takes one of"):
        Table(["a"], [["1"]], align=["middle"])
    with pytest.raises(ValueError, match="marks: 2 given for 1 rows"):
        Table(["a"], [["1"]], marks=["good", "bad"])


def test_an_equation_carries_its_number():
    shown = equation(sympy.Eq(sympy.Symbol("p_1"), 1 / sympy.Symbol("h")), "4.8", "pid-report")
    assert shown._repr_mimebundle_()[EQUATION_MIME] == {
        "latex": r"p_{1} = \frac{1}{h}",
        "label": "4.8",
        "document": "pid-report",
        "anchor": "eq-pid-report-4.8",
    }
    assert r"\tag{4.8}" in shown._repr_mimebundle_()["text/latex"]
    assert Equation("a").anchor == ""


def test_a_figure_is_vector_graphics_with_searchable_text_and_no_date():
    from matplotlib.figure import Figure as MatplotlibFigure

    def draw():
        fig = MatplotlibFigure(figsize=(2, 1))
        fig.subplots().set_title("Step response")
        return figure(fig, "The response.", "A rising curve.")

    first, second = draw(), draw()
    assert first.svg == second.svg
    assert "Step response" in first.svg and "dc:date" not in first.svg
    assert first._repr_mimebundle_()[FIGURE_MIME] == {"caption": "The response.", "alt": "A rising curve."}


@pytest.mark.parametrize("missing", ["caption", "alt"])
def test_a_figure_needs_caption_and_alternative_text(missing):
    words = {"caption": "What it shows.", "alt": "A curve."} | {missing: " "}
    with pytest.raises(ValueError, match=f"needs a {missing}"):
        Figure("<svg/>", **words)
