"""Pages that look otherwise are named, and drawn before beside after."""

import pytest
import typst
from PIL import Image

from notebook_reports.pages.changed_pages import changed, changes_told

pytest.importorskip("pypdfium2", reason="pages are drawn by pypdfium2, of the extra docs")
pytestmark = pytest.mark.builds


def pdf(path, *pages):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(typst.compile("\n#pagebreak()\n".join(pages).encode()))


def test_a_changed_digit_a_new_page_and_a_report_that_went(tmp_path):
    old, new = tmp_path / "old", tmp_path / "new"
    pdf(old / "a/one.pdf", "K = 1.25", "same")
    pdf(new / "a/one.pdf", "K = 1.26", "same", "more")
    pdf(old / "a/same.pdf", "nothing")
    pdf(new / "a/same.pdf", "nothing")
    pdf(old / "a/gone.pdf", "x")
    found = changed(old, new, tmp_path / "pictures")
    assert [(c.report, c.pages, c.before, c.after) for c in found] == [
        ("a/gone.pdf", (1,), 1, 0),
        ("a/one.pdf", (1, 3), 2, 3),
    ]
    assert changes_told(found, "text") == "a/gone.pdf: gone\na/one.pdf: pages 1, 3 of 3 changed"
    drawn = sorted(p.name for p in (tmp_path / "pictures").iterdir())
    assert drawn == ["a-gone-1.png", "a-one-1.png", "a-one-3.png"]
    with Image.open(tmp_path / "pictures" / "a-one-1.png") as picture:
        width, height = picture.size
        halves = [picture.crop((x, 0, x + width // 2 - 4, height)).tobytes() for x in (0, width // 2 + 4)]
    assert halves[0] != halves[1] and all(min(half) < 128 for half in halves)


def test_nothing_changed(tmp_path):
    pdf(tmp_path / "a/one.pdf", "x")
    assert changes_told(changed(tmp_path, tmp_path), "text") == "no page of any report looks otherwise"
