"""What must not reach a student: an answer, the secret, the solution's source. Each release is looked through for them.

A released notebook holds prose, attached drawings and one cell to fill in, and nothing else; so whatever else is in it,
an output, other metadata, another attachment, is a leak by its place, whatever it says.
"""

import base64
import io
import json
import re
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import TreeBuilder, XMLParser

from loopbook.course.notebooks import COURSE, source_of
from loopbook.course.release.printed import printed_answer
from loopbook.course.release.student import ANSWERS, answers_cell
from loopbook.course.running import Solved
from loopbook.course.sheet import Sheet
from notebook_reports.export.read.pdf_text import PdfText

SHORTEST_LINE = 12
"""Characters, without blanks, from which on a line of the solution is told from prose."""
_TOP = {"cells", "metadata", "nbformat", "nbformat_minor"}
_CELL = {"cell_type", "id", "metadata", "source", "attachments", "execution_count", "outputs"}
_TAGS = {"question"}
_WORDS = re.compile(rb"<(?:dc:(?:title|description|subject)|pdf:Keywords)[^>]*>(.*?)</(?:dc|pdf):", re.DOTALL)
_DRAWN = {"d", "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "r", "rx", "ry", "width", "height", "transform", "points",
          "style", "viewBox", "id", "class", "clip-path", "href", "version", "preserveAspectRatio", "type", "fill",
          "stroke", "font-size", "text-anchor", "offset"}  # fmt: skip


@dataclass(frozen=True)
class Leak:
    """Something that must not be there. file: which file; what: in words, without the thing itself."""

    file: str
    what: str

    def __str__(self) -> str:
        return f"{self.file}: {self.what}"


@dataclass(frozen=True)
class LeakScanner:
    """What one student must not get. secret: of the course; student: an id, in whose digits no answer is looked for."""

    sheet: Sheet
    solved: Solved
    secret: bytes
    student: str = ""

    def scan(self, files: Mapping[str, bytes]) -> list[Leak]:
        """All leaks of the files by name: notebooks, PDFs, zips of them."""
        return [Leak(name, what) for name, content in files.items() for what in self._of(name, content)]

    def _of(self, name: str, content: bytes) -> Iterator[str]:
        if name.endswith(".zip"):
            with zipfile.ZipFile(io.BytesIO(content)) as archive:
                if archive.comment:
                    yield "the archive has a comment"
                for member in archive.namelist():
                    yield from (f"{member}: {what}" for what in self._of(member, archive.read(member)))
        elif name.endswith(".ipynb"):
            yield from self._notebook(content)
        elif name.endswith(".pdf"):
            yield from self._pdf(content)
        else:
            yield "a file that belongs to no release"

    def _notebook(self, content: bytes) -> Iterator[str]:
        notebook = json.loads(content)
        yield from self._places(notebook)
        texts = [source_of(cell) for cell in notebook["cells"]]
        for cell in notebook["cells"]:
            for bundle in (cell.get("attachments") or {}).values():
                texts += [text for mime, data in bundle.items() for text in drawing_texts(mime, data)]
        texts += list(
            _strings({**notebook, "cells": [{**c, "source": "", "attachments": {}} for c in notebook["cells"]]})
        )
        yield from self._said(texts, content)

    def _places(self, notebook: dict[str, Any]) -> Iterator[str]:
        """What stands where a release puts nothing."""
        told = notebook["metadata"].get("loopbook", {})
        more = set(notebook) - _TOP | set(notebook["metadata"]) - {"kernelspec", "language_info", "loopbook"}
        if more | set(told) - {COURSE} | set(told.get(COURSE, {})) - {"sheet", "student"}:
            yield "metadata that a release does not have"
        for number, cell in enumerate(notebook["cells"], 1):
            where = f"cell {number}"
            if set(cell) - _CELL or set(cell["metadata"]) - {"tags"} or set(cell["metadata"].get("tags", ())) - _TAGS:
                yield f"{where}: metadata that a release does not have"
            if cell.get("outputs"):
                yield f"{where}: an output"
            expected = answers_cell(self.solved) if cell.get("id") == ANSWERS else ""
            if cell["cell_type"] == "code" and source_of(cell) != expected:
                yield f"{where}: code that a release does not have"
            if any(set(bundle) != {"image/svg+xml"} for bundle in (cell.get("attachments") or {}).values()):
                yield f"{where}: an attachment that is no drawing"

    def _pdf(self, content: bytes) -> Iterator[str]:
        if b"/EmbeddedFile" in content:
            yield "a file inside the PDF"
        streams = [content, *_streams(content)]
        metadata = [w.decode("latin-1") for s in streams for w in _WORDS.findall(s)]
        told = [
            found.decode("latin-1") for found in re.findall(rb"/(?:Keywords|Subject|Author|Title)\s*\((.*?)\)", content)
        ]
        yield from self._said([*_by_line(content), *metadata, *told], b"".join(streams))

    def _said(self, texts: list[str], raw: bytes) -> Iterator[str]:
        named = [text.replace(self.student, "") for text in texts] if self.student else texts
        if answer := printed_answer(self.solved.asked.values(), named):
            yield f"the answer {answer} is printed"
        if any(form in raw for form in secret_forms(self.secret)):
            yield "the course's secret"
        joined = "".join("".join(text.split()) for text in texts)
        if line := next((line for line in self._source() if line in joined), ""):
            yield f"a line of the solution: {line[:20]}…"

    def _source(self) -> Iterator[str]:
        """The lines of code that no student sees, without blanks; imports are no secret."""
        for cell in self.sheet.hidden:
            for line in cell.text.splitlines():
                bare = "".join(line.split())
                if len(bare) >= SHORTEST_LINE and not bare.startswith(("import", "from", "#")):
                    yield bare


def secret_forms(secret: bytes) -> list[bytes]:
    """The secret as bytes, hexadecimal and base64, in each alignment without its ends."""
    shifted = [base64.b64encode(b"\0" * pad + secret)[4:-4] for pad in range(3)]
    return [secret, secret.hex().encode(), secret.hex().upper().encode(), *shifted]


def _strings(value: Any) -> Iterator[str]:
    """Every text and number in plain data, names too."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield str(key)
            yield from _strings(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _strings(inner)
    elif isinstance(value, str):
        yield value
        yield from _decoded(value)
    elif isinstance(value, float):
        yield repr(value)


def _decoded(text: str) -> Iterator[str]:
    """A text that is base64 of a text."""
    if len(text) >= 8 and re.fullmatch(r"[A-Za-z0-9+/\s]+=*\s*", text):
        try:
            yield base64.b64decode(text, validate=False).decode()
        except (ValueError, UnicodeDecodeError):
            return


def drawing_texts(mime: str, data: Any) -> Iterator[str]:
    """What an attachment says: of a drawing its words, the numbers of its axes left out; of a picture its notes."""
    content = base64.b64decode("".join(data) if isinstance(data, list) else data)
    if mime != "image/svg+xml":
        yield from (
            found.decode("latin-1") for found in re.findall(rb"(?:tEXt|iTXt|zTXt)(.{0,400})", content, re.DOTALL)
        )
        return
    parser = XMLParser(target=TreeBuilder(insert_comments=True))
    parser.feed(content)
    yield from _drawn(parser.close())


def _drawn(element: Any) -> Iterator[str]:
    if str(element.get("id", "")).startswith(("xtick_", "ytick_")):
        return
    name = element.tag.rpartition("}")[2] if isinstance(element.tag, str) else "comment"
    if name in ("comment", "text", "tspan", "title", "desc", "metadata") and (element.text or "").strip():
        yield element.text
    if name != "style" and (element.tail or "").strip():
        yield element.tail
    yield from (v for k, v in element.attrib.items() if k.rpartition("}")[2] not in _DRAWN)
    for child in element:
        yield from _drawn(child)


def _streams(pdf: bytes) -> Iterator[bytes]:
    for found in re.finditer(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL):
        try:
            yield zlib.decompress(found[1])
        except zlib.error:
            yield found[1]


def _by_line(pdf: bytes) -> list[str]:
    """The words of the pages line by line, so that two numbers side by side stay two; those of drawings, which are set
    letter by letter, were read in the notebook."""
    lines: dict[tuple[int, float], list[str]] = {}
    for run in PdfText(pdf).runs():
        if not run.drawn and len(run.text) > 1:
            lines.setdefault((run.page, round(run.y)), []).append(run.text)
    return [" ".join(parts) for parts in lines.values()]
