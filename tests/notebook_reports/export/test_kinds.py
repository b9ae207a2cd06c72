"""Notebooks of other people, kind by kind: ``kinds/*.txt`` say what is in one and what its pages show.

``=== title``, then pieces: ``--- markdown``, ``--- code``, ``--- raw TYPE`` begin a cell; ``--- output TYPE``,
``--- also TYPE`` (another form of the same output), ``--- stream``, ``--- stderr``, ``--- error`` belong to the code
cell before.
``--- shows`` says what stands on both pages in this order, apart by ``|``; ``--- hides`` what on neither; ``--- mends``
the kinds of the mends in their order.
"""

import base64
import html
import re
import struct
import zlib
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output, new_raw_cell
from tools.pages.notebook_words import compare
from tools.pages.page_words import outside, text_of

from notebook_reports.export.exporters.html import HtmlExporter
from notebook_reports.export.exporters.pdf import PdfExporter
from notebook_reports.export.read import outputs
from notebook_reports.export.read.pdf_text import PdfText

pytestmark = pytest.mark.builds

FOLDER = Path(__file__).parent / "kinds"


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


PNG = base64.b64encode(
    b"\x89PNG\r\n\x1a\n"
    + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 0, 0, 0, 0))
    + chunk(b"IDAT", zlib.compress(b"\0\x80\x80" * 2))
    + chunk(b"IEND", b"")
).decode()
PLACEHOLDERS = {
    "PIXEL": f"data:image/png;base64,{PNG}",
    "PNG": PNG,
    "LINES": "\n".join(f"line of an output {i}" for i in range(17_500)),
    "MARKS": "\n\n".join(
        " ".join(f"{mark}word{20 * i + j}" for j in range(20)) + "."
        for i, mark in enumerate([":", ";", ".", "!", ")", "/"])
    ),
    "BRACKETS": " ".join(f"a{i}(" for i in range(60)) + "\n\n" + " ".join(f"b{i}[" for i in range(100)),
    "WIDE": "$$\\frac{" + " + ".join(f"a_{{{i}}} b_{{{i}}}" for i in range(40)) + "}{c}$$",
}


def cases():
    """(file and title, pieces) of each case; a piece is its kind, its argument and its text."""
    found = []
    for path in sorted(FOLDER.glob("*.txt")):
        for part in re.split(r"^=== ", path.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            title, *pieces = re.split(r"^--- (.*)\n", part, flags=re.MULTILINE)
            heads = [head.strip() for head in pieces[::2]]
            texts = [text.rstrip("\n") for text in pieces[1::2]]
            found.append(pytest.param(list(zip(heads, texts, strict=True)), id=f"{path.stem}: {title.strip()}"))
    return found


def test_there_are_cases():
    assert len(cases()) > 50 and len(list(FOLDER.glob("*.txt"))) == 3


def notebook(pieces):
    cells = []
    for head, text in pieces:
        kind, _, argument = head.partition(" ")
        text = PLACEHOLDERS.get(text, text)
        text = text.replace("PIXEL", PLACEHOLDERS["PIXEL"]).replace("ESC[", "\x1b[")
        if kind == "markdown":
            cells.append(new_markdown_cell(text))
        elif kind == "raw":
            cells.append(new_raw_cell(text, metadata={"raw_mimetype": argument}))
        elif kind == "code":
            cells.append(new_code_cell(text))
        elif kind in ("output", "stream", "stderr", "error"):
            if not cells or cells[-1]["cell_type"] != "code":
                cells.append(new_code_cell("show()"))
            cells[-1]["outputs"].append(_output(kind, argument, text))
        elif kind == "also":
            cells[-1]["outputs"][-1]["data"][argument] = text
    return new_notebook(cells=cells, metadata={"language_info": {"name": "python"}})


def _output(kind, mime, text):
    if kind == "output":
        return new_output("display_data", data={mime: text} if mime else {})
    if kind == "error":
        return new_output("error", ename="E", evalue="", traceback=text.split("\n"))
    return new_output("stream", name="stdout" if kind == "stream" else "stderr", text=text)


def expected(pieces, head, page):
    """The text of a piece for both pages, or for one of them."""
    told = {
        name: text for name, text in pieces if name.split(" in ")[0] == head and name in (head, f"{head} in {page}")
    }
    return told.get(f"{head} in {page}", told.get(head))


def listed(text):
    return [piece.strip() for piece in (text or "").split("|") if piece.strip()] if "||" not in (text or "") else [text]


def plain(text):
    return "".join(text.split())


@pytest.mark.parametrize("pieces", cases())
def test_kind(pieces, share, monkeypatch):
    monkeypatch.setattr(outputs, "MAX_TEXT", share(40_000, outputs.MAX_TEXT))
    nb = notebook(pieces)
    nbformat.validate(nb)
    exporter = PdfExporter()
    told = {"metadata": {"name": "sample", "path": str(FOLDER)}}
    pdf, about_pdf = exporter.from_notebook_node(nb, dict(told))
    page, about_html = HtmlExporter().from_notebook_node(nb, dict(told))
    pages = PdfText(pdf)
    shown = {
        "pdf": text_of(list(pages.runs())),
        "html": html.unescape(re.sub(r"<style>.*?</style>|<[^>]*>", " ", page, flags=re.DOTALL)),
    }
    for name, about in (("pdf", about_pdf), ("html", about_html)):
        text = plain(shown[name])
        at = 0
        for piece in listed(expected(pieces, "shows", name)):
            found = text.find(plain(piece), at)
            assert found >= 0, f"{name} does not show {piece!r} after {text[max(0, at - 80) : at]!r}: {text[at:][:600]}"
            at = found + len(plain(piece))
        for head, is_there in (("shows anywhere", True), ("hides", False)):
            for piece in listed(dict(pieces).get(head)):
                assert (plain(piece) in text) == is_there, f"{name}: {piece!r} in {text[:800]}"
        kinds = [mend.kind for _, mend in about["loopbook_mends"]]
        assert kinds == (expected(pieces, "mends", name) or "").split(), f"{name}: {about['loopbook_mends']}"
        numbers = [mend.number for _, mend in about["loopbook_mends"]]
        assert numbers == list(range(1, len(numbers) + 1)) and (not numbers or "shows otherwise" in shown[name])
        if "text" not in kinds:  # nothing was cut
            hidden = dict(pieces).get("hides", "")
            assert not [word for _, word in compare(nb, shown[name]).lost if word not in hidden]
    assert outside(pages) == [] and "\u200b" not in shown["pdf"] + page
    source = exporter.source(about_pdf["loopbook_report"])[0]
    for piece in listed(dict(pieces).get("typst")):
        assert piece in source, f"{piece} in {source}"
    for piece in listed(dict(pieces).get("html")):
        assert piece in page, piece
