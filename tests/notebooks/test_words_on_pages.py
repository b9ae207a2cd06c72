"""The words of our own notebooks stand on their pages, in order, inside the margins, and can be searched."""

import json
from pathlib import Path

import nbformat
import pytest
from tools.pages.notebook_words import compare
from tools.pages.page_words import in_the_text, outside, text_of

from notebook_reports.export.exporters.choose import export
from notebook_reports.export.read.pdf_text import PdfText
from notebook_reports.project.project import project_at

pytestmark = pytest.mark.builds

PROJECT = project_at(Path(__file__).parents[2])
FIRST = {notebook.id.partition("/")[0]: notebook.id for notebook in reversed(PROJECT.notebooks())}.values()
NAMES = [
    pytest.param(notebook.id, marks=[] if notebook.id in FIRST else pytest.mark.whole)
    for notebook in PROJECT.notebooks()
    if not notebook.id.startswith("exercises/")  # their solutions stand last
]


@pytest.mark.parametrize("name", NAMES)
def test_every_word_is_on_a_page_and_none_leaves_it(outcome, name):
    executed = json.loads((PROJECT.cache / "executed" / f"{name}.ipynb").read_text(encoding="utf-8"))
    notebook = nbformat.from_dict(executed)
    pages = PdfText(export(notebook, "pdf", name=name, assets=PROJECT.notebooks_folder / name.partition("/")[0]))
    text = text_of(in_the_text(pages))
    found = compare(notebook, text)
    assert found.count > 100 and found.lost == [] and len(found.displaced) < 3
    assert outside(pages) == [] and "\u200b" not in text_of(list(pages.runs()))
