"""Titles, headings, anchors and links: where a link leads is known before the page is written."""

import pytest

from notebook_reports.display import Equation
from notebook_reports.export.exporters.choose import ExportError, export

pytestmark = pytest.mark.builds


def test_title_is_the_first_top_heading_else_what_is_told_else_the_name(make):
    assert "<title>Two tanks</title>" in make.html(make.notebook("# Two tanks\n\ntext"))
    assert "<h1>03 pole placement</h1>" in make.html(make.notebook("text"), name="a/03_pole_placement")
    assert "<title>Told</title>" in make.html(make.notebook("# Two tanks"), title="Told")


def test_headings_are_numbered_without_gaps_and_listed_from_three_on(make):
    nb = make.notebook("# T\n\n## One\n\n#### Deep\n\n## Two\n\n### Under")
    page = make.html(nb)
    for number, tag in (("1", "h2"), ("1.1", "h3"), ("2", "h2"), ("2.1", "h3")):
        assert f'<span class="number">{number}</span>' in page
        assert f"<{tag} id=" in page
    assert page.count('<nav class="contents" aria-labelledby="contents-title">') == 1
    assert '#section(2, "2.1", label("Under"))' in make.typst(nb)
    assert "<nav" not in make.html(make.notebook("# T\n\n## One\n\n## Two"))


def test_headings_that_number_themselves_are_left_alone(make):
    assert '#section(1, "", ' in make.typst(make.notebook("# T\n\n## 1. First\n\n## 2. Second"))


def test_anchors_are_jupyters(make):
    nb = make.notebook(
        "# T\n\n## Two tanks, $q = 0$\n\n[there](#Two-tanks,-$q-=-0$) [again](#Two%20tanks,%20$q%20=%200$)"
    )
    assert make.html(nb).count('<a href="#Two-tanks,-$q-=-0$"') == 2
    assert make.typst(nb).count('#inner(label("Two-tanks,-$q-=-0$"))') == 2


def test_equal_headings_get_different_anchors(make):
    page = make.html(make.notebook("# T\n\n## Result\n\n## Result"))
    assert 'id="Result"' in page and 'id="Result-2"' in page


def test_link_to_an_equation(make):
    nb = make.notebook("[eq. 4.9](#eq-pid-report-4.9)", make.code(Equation("x = 1", "4.9", "pid-report")))
    assert '<div class="formula" id="eq-pid-report-4.9">' in make.html(nb)
    assert '#inner(label("eq-pid-report-4.9"))' in make.typst(nb)


def test_tag_in_markdown_is_an_anchor_of_the_document(make):
    nb = make.notebook("$$x = 1 \\tag{4.9}$$\n\n[that](#eq-pid-report-4.9)")
    assert 'id="eq-pid-report-4.9"' in make.html(nb, document="pid-report")


def test_an_equation_numbered_twice_is_refused(make):
    shown = make.code(Equation("x = 1", "4.9", "pid-report"))
    again = make.code(Equation("x = 2", "4.9", "pid-report"))
    with pytest.raises(ExportError, match=r"cell 2: equation \(4.9\) is numbered twice, here and in cell 1"):
        export(make.notebook(shown, again), "pdf", name="a/b")


def test_link_to_another_notebook_leads_to_its_report(make):
    nb = make.notebook("[a](notebook:double_tank/03#cell-7) [b](../double_tank/03.ipynb#Some%20part) [c](02.ipynb)")
    page = make.html(nb, name="pid_report/01")
    for url in ("../double_tank/03.html#cell-7", "../double_tank/03.html#Some part", "02.html"):
        assert f'href="{url}"' in page
    assert '"../double_tank/03.pdf#cell-7"' in make.typst(nb, name="pid_report/01")


def test_dead_link_names_the_nearest_anchor(make):
    with pytest.raises(ExportError, match=r"cell 1: a link to #The-modell.*did you mean #The-model\?"):
        export(make.notebook("# T\n\n## The model\n\n[x](#The-modell)"), "html", name="a/b")


def test_code_cells_have_anchors(make):
    nb = make.notebook("# T", make.code(make.stream("x")), "[there](#cell-2)")
    assert '<div id="cell-2">' in make.html(nb)
    assert 'label("cell-2")' in make.typst(nb)
