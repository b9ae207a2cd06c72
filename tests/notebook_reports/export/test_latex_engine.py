"""The LaTeX route: what it says without TeX, what its template mends, what it reads in TeX's log."""

import base64
import shutil

import pytest
from nbconvert.exporters.latex import LatexExporter

from notebook_reports.display import Figure, Table
from notebook_reports.export.exporters.choose import ExportError, export
from notebook_reports.export.exporters.latex import LatexPdfExporter, read_log
from notebook_reports.export.exporters.latex_outputs import DrawingsToPdf, TablesToMarkdown, pipe_table

tex = pytest.mark.skipif(
    not (shutil.which("xelatex") and shutil.which("pandoc")), reason="needs a TeX installation and pandoc"
)


def test_without_tex_the_error_says_what_to_install(make, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda program: None)
    with pytest.raises(ExportError, match=r"a/b: the LaTeX engine needs xelatex and pandoc .* or use the engine typst"):
        export(make.notebook("# T"), "pdf", name="a/b", engine="latex")


def test_the_template_defines_the_counter_of_pandocs_tables_and_a4(make):
    source, _ = LatexExporter.from_notebook_node(LatexPdfExporter(), make.notebook(make.code(source="x = 1")))
    assert r"\makeatletter\@ifundefined{c@none}{\newcounter{none}}{}\makeatother" in source
    assert r"\documentclass[11pt,a4paper]{article}" in source
    assert source.index("newcounter{none}") < source.index(r"\begin{document}")


LOG = r"""
Missing character: There is no ✓ (U+2713) in font [lmroman10-regular]:mapping=t
ex-text;!
Missing character: There is no ≤ in font nullfont!
Overfull \hbox (3.5pt too wide) in paragraph at lines 10--12
Overfull \hbox (212.86417pt too wide) in paragraph at lines 401--402
[]\T1/cmr/m/n/10 x
Overfull \hbox (40.0pt too wide) detected at line 77
"""


def test_the_log_is_read():
    assert read_log(LOG) == [
        "no ✓ in TeX's font [lmroman10-regular]; write it in another way, or use the engine typst",
        "no ≤ in TeX's font nullfont; write it in another way, or use the engine typst",
        "a line 212.86417 points too wide (in paragraph at lines 401--402 of the TeX source); write it narrower",
        "a line 40.0 points too wide (detected at line 77 of the TeX source); write it narrower",
    ]
    assert read_log("This is XeTeX\nOutput written on notebook.pdf (3 pages).") == []


def test_tables_become_pipe_tables_and_bars_end_no_cell():
    table = Table(
        ["term", "value"], [["$|S(i\\omega)|$", "a|b"], ["long words in a row", "2"]], "All", notes=["A note."]
    )
    head, rule, first, second, *rest = pipe_table(table.data()).split("\n")
    assert head == "| term | value |" and second == "| long words in a row | 2 |"
    assert first == r"| $\vert S(i\omega)\vert $ | a\|b |"
    left, right = rule.strip("|").split("|")
    assert left.startswith(":--") and right.endswith("--:") and len(left) > len(right)
    assert rest == ["", ": All", "", "A note.", ""]


def test_drawings_need_no_inkscape_and_captions_are_kept(make):
    node = make.notebook(make.code(Figure(make.svg, "A caption", "x")), make.code(Table(["a"], [["1"]])))
    for preprocessor in (TablesToMarkdown(), DrawingsToPdf()):
        preprocessor.enabled = True
        node, _ = preprocessor(node, {})
    (drawing, caption), (table,) = (cell.outputs for cell in node.cells if cell.cell_type == "code")
    assert base64.b64decode(drawing.data["application/pdf"]).startswith(b"%PDF-")
    assert caption.data == {"text/markdown": "A caption"} and table.data["text/markdown"].startswith("| a |")


@tex
def test_a_report_by_tex_has_equal_bytes_each_time(make):
    table = "# Tables\n\n| a | b |\n|---|---|\n| åäö | $x^2$ |\n"
    node = make.notebook(table, make.code(Table(["a"], [["1"]], "All")), make.code(Figure(make.svg, "Drawn", "x")))
    first, second = (export(node, "pdf", name="a/b", engine="latex") for _ in range(2))
    assert first.startswith(b"%PDF-") and first == second


@tex
@pytest.mark.parametrize(("text", "complaint"), [("# T\n\ndone ✓", "no ✓"), ("# T\n\n" + "x" * 300, "points too wide")])
def test_what_tex_loses_is_an_error(make, text, complaint):
    with pytest.raises(ExportError, match=complaint):
        export(make.notebook(text), "pdf", name="a/b", engine="latex")
