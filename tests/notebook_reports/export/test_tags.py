"""Tags of cells that a chapter uses: a note in the margin, a box to try, a folded section, code that is not shown."""

import re

import pytest
from tools.pages.notebook_words import compare

from notebook_reports.display import Table, prose
from notebook_reports.export.exporters.choose import export

pytestmark = pytest.mark.builds


def tagged(make, text, *tags):
    cell = make.markdown(text)
    cell["metadata"]["tags"] = list(tags)
    return cell


def proof():
    return Table(
        ["place", "correct"], [["eq. 1", "$+3$"], ["eq. 2", "$x$"]], "Misprints", anchors=["misprint-sign", ""]
    )


def test_a_note_stands_in_the_margin_and_leads_to_its_proof(make):
    note = tagged(make, "In print the exponent is $-3$; [proof](#misprint-sign).", "margin")
    nb = make.notebook("# T", note, make.code(proof()))
    page, source = make.html(nb), make.typst(nb)
    assert re.search(r'<aside class="margin"><p>In print .*<a href="#misprint-sign">proof</a>', page)
    assert page.count('id="misprint-sign"') == 1
    assert "#aside[" in source and source.count('label("misprint-sign")') == 2  # the link and the place
    assert export(nb, "pdf", name="a/b").startswith(b"%PDF")


def test_the_rows_of_one_place_each_keep_their_anchor(make):
    rows = [["eq. 1", "$+3$"], ["eq. 1", "$x$"], ["eq. 1", "$y$"]]
    table = Table(["place", "correct"], rows, "Misprints", groups=1, anchors=["first", "second", "third"])
    nb = make.notebook("# T", "[proof](#second), [proof](#third)", make.code(table))
    assert [make.html(nb).count(f'id="{name}"') for name in table.anchors] == [1, 1, 1]
    assert export(nb, "pdf", name="a/b").startswith(b"%PDF")


def test_a_question_to_try_stands_in_a_box(make):
    nb = make.notebook("# T", tagged(make, "**Try it.** Set `q` to $0.7$.", "try-it"))
    assert re.search(r'<div class="alert info" role="note"><p><strong>Try it.</strong>', make.html(nb))
    assert '#alert("info")[' in make.typst(nb)


def test_a_section_is_folded_up_to_the_next_heading_of_its_level(make):
    cells = ["# T", "## One", tagged(make, "## Verdicts\n\nAll of them.", "folded"), make.code(proof())]
    nb = make.notebook(*cells, "### Details", "deep", "## Two", "after")
    page = make.html(nb)
    inside = re.search(r"<details class=\"section\">(.*?)</details>", page, re.DOTALL)[1]
    assert inside.startswith('<summary><h2 id="Verdicts">')
    assert "All of them." in inside and "Details" in inside and "deep" in inside and 'id="misprint-sign"' in inside
    assert "after" not in inside and page.count("<details") == page.count("</details>") == 1
    assert 'label("Verdicts")' in make.typst(nb)


def test_a_folded_section_within_another_and_at_the_end(make):
    nb = make.notebook("# T", tagged(make, "## A", "folded"), "a", tagged(make, "### B", "folded"), "b")
    page = make.html(nb)
    assert page.count("<details") == page.count("</details>") == 2
    assert page.index("<h2") < page.index("<h3") < page.index("</details>")


def test_a_computed_sentence_is_prose_without_its_code(make):
    cell = make.code(prose("It needs **8360** W."), source='prose(f"It needs **{x}** W.")', tags=["remove-input"])
    nb = make.notebook("# T", cell)
    page = make.html(nb)
    assert "It needs <strong>8360</strong> W." in page and "prose(" not in page
    assert compare(nb, "T It needs 8360 W.").lost == []


def test_a_proof_in_a_row_that_does_not_repeat_its_place_is_found(make):
    rows = [["Figure 5.12", "one"], ["Figure 5.12", "other"]]
    table = Table(["place", "correct"], rows, "Misprints", anchors=["misprint-one", "misprint-other"], groups=1)
    nb = make.notebook("# T", tagged(make, "Wrong; [proof](#misprint-other).", "margin"), make.code(table))
    assert make.html(nb).count('id="misprint-other"') == 1
    assert make.typst(nb).count('label("misprint-other")') == 2
    assert export(nb, "pdf", name="a/b").startswith(b"%PDF")
