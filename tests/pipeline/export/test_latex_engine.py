"""The LaTeX route: what it says without TeX, what its template mends, what it reads in TeX's log."""

import shutil

import pytest
from nbconvert.exporters.latex import LatexExporter

from loopbook.pipeline.export import ExportError, export
from loopbook.pipeline.export.latex import LatexPdfExporter, read_log


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
