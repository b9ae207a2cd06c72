"""The site's sources: a page for each public name, calls that run, links that a missing file betrays."""

import re
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from docs_site import gallery, reference
from docs_site.docstrings import as_rst

import loopbook as lb

ROOT = Path(__file__).parents[2]


def test_every_public_name_has_a_page_that_says_something(tmp_path):
    reference.write(tmp_path)
    names = reference.names()
    assert len(names) > 60 and set(dir(lb)) >= {n for n in names if "." not in n}
    for name in names:
        text = (tmp_path / f"{name}.rst").read_text(encoding="utf-8")
        assert text.startswith(f"lb.{name}\n") and len(text) > 80, name
    listed = (tmp_path / "index.md").read_text(encoding="utf-8")
    assert all(f"[{name}]({name}.rst)" in listed for name in names)


@pytest.mark.parametrize(
    ("lines", "wanted"),
    [
        (["a * b | c_"], ["a \\* b \\| c\\_"]),
        (["see `Loop`"], ["see ``Loop``"]),
        (["text", "", "    K = *x*", "", "more"], ["text", "", "::", "", "    K = *x*", "", "more"]),
        ([">>> a * b", "1"], [">>> a * b", "1"]),
    ],
)
def test_docstrings_are_text(lines, wanted):
    assert as_rst(lines) == wanted


def test_a_caption_is_text_and_its_formulas_are_formulas():
    shown = gallery.words_shown("<b> after $t = 0$ & $K_p$")
    assert shown.startswith("&lt;b&gt; after <math") and shown.count("<math") == 2 and "$" not in shown


def calls():
    for line in (ROOT / "docs/coming-from.md").read_text(encoding="utf-8").splitlines():
        cells = [c.strip() for c in line.split("|")][1:-1]
        if len(cells) == 4 and cells[3].startswith("`"):
            yield cells[3].strip("`")


@pytest.mark.long
def test_every_call_of_the_table_for_newcomers_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    found = list(calls())
    assert len(found) >= 40
    names = {"lb": lb, "np": np}
    for call in found:
        exec(call, names)  # the table is ours, in order: each row may use what earlier ones made
        plt.close("all")


def test_the_readme_links_to_what_is_there():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    links = re.findall(r'\]\(([^)#:]+)\)|src="([^"]+)"', text)
    assert links and any(image for _, image in links)
    for link, image in links:
        assert (ROOT / (link or image)).exists(), link or image
