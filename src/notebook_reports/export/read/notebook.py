"""A notebook read into a report: its title, its cells as blocks, its numbers, its links settled."""

import posixpath
import re
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from notebook_reports.export.errors import CannotShow, ExportError, Problem
from notebook_reports.export.model import (
    Anchor,
    Block,
    Display,
    Figure,
    Grid,
    Heading,
    Link,
    Listing,
    Report,
    ReportCell,
    Text,
    plain,
    walk,
)
from notebook_reports.export.read.html import read_html
from notebook_reports.export.read.markdown import read_markdown
from notebook_reports.export.read.outputs import read_outputs
from notebook_reports.export.read.reading import Reading, anchor_of
from notebook_reports.export.read.terminal import visible

NO_INPUT = {"remove-input", "hide-input", "remove_input", "hide_input"}
NO_OUTPUT = {"remove-output", "remove_output"}
NO_CELL = {"remove-cell", "remove_cell"}
_SCHEME = re.compile(r"(?P<scheme>[A-Za-z][A-Za-z0-9+.-]*):")
_NUMBERED = re.compile(r"\s*(\d+(\.\d+)*[.):]?|[IVX]+\.|[A-Z]\.|§.*)\s")


def read(
    notebook: Any,
    name: str,
    title: str = "",
    document: str = "",
    chapter: str = "",
    language: str = "en",
    author: str = "",
    folder: Path | None = None,
    strict_alt: bool = False,
) -> Report:
    """Read a notebook (nbformat 4). Raises ExportError that names every cell which holds what no page can show.

    The title is the one given, else the first top heading, else the last part of `name`. name: "folder/notebook", as
    links from other notebooks call it.
    """
    reading = Reading(folder, document, strict_alt)
    cells = []
    for number, cell in enumerate(notebook["cells"], start=1):
        reading.cell = number
        reading.attachments = cell.get("attachments") or {}
        blocks = _cell(cell, reading, _language(notebook))
        anchor = f"cell-{number}" if cell["cell_type"] == "code" and blocks else ""
        cells.append(ReportCell(number, blocks, anchor))
    first = _take_title(cells)
    words = first.children if first else [Text(name.rpartition("/")[2].replace("_", " "))]
    report = Report(name, words, first.anchor if first else "", cells, document, chapter, language, author)
    if title and title not in (report.plain_title, plain(words)):
        report.title = [Text(title)]
    level_headings(cells)
    number_blocks(cells)
    collect_anchors(report, reading)
    settle_links(report, reading)
    if reading.problems:
        raise ExportError(name, reading.problems)
    return report


def _language(notebook: Any) -> str:
    metadata = notebook.get("metadata", {})
    told = metadata.get("language_info", {}).get("name") or metadata.get("kernelspec", {}).get("language")
    return (told or "python").lower()


def _cell(cell: Any, reading: Reading, language: str) -> list[Block]:
    tags = set(cell.get("metadata", {}).get("tags", ()))
    source = "".join(cell["source"])
    if tags & NO_CELL:
        return []
    with reading.guard():
        if cell["cell_type"] == "markdown":
            return read_markdown(source, reading)
        if cell["cell_type"] == "raw":
            return _raw(source, cell.get("metadata", {}), reading)
        blocks: list[Block] = []
        if source.strip() and not tags & NO_INPUT:
            blocks.append(Listing(visible(source.expandtabs(4)).strip("\n"), "input", language))
        if not tags & NO_OUTPUT:
            blocks += read_outputs(cell.get("outputs", ()), reading)
        return blocks
    return []


def _raw(source: str, metadata: Any, reading: Reading) -> list[Block]:
    mime = metadata.get("raw_mimetype") or metadata.get("format") or "text/plain"
    if mime == "text/markdown":
        return read_markdown(source, reading)
    if mime == "text/html":
        return read_html(source, reading)
    if mime == "text/latex":
        return [reading.display(source)]
    if mime == "text/plain":
        return [Listing(visible(source.expandtabs(4)).strip("\n"))] if source.strip() else []
    raise CannotShow(f"a raw cell of the kind {mime}; make it Markdown, or plain text")


def _take_title(cells: list[ReportCell]) -> Heading | None:
    """The first top heading, taken out of its cell, if nothing but empty cells and code stands before it."""
    for cell in cells:
        for i, block in enumerate(cell.blocks):
            if isinstance(block, Heading):
                return cell.blocks.pop(i) if block.level == 1 else None
    return None


def level_headings(cells: list[ReportCell], top: int = 1, chapter: str = "") -> None:
    """Give headings the levels top, top + 1, … without a gap, and their section numbers.

    Where the notebook numbers its headings itself, none are added. chapter: what stands before the numbers in a book.
    """
    headings = [block for block in walk(cells) if isinstance(block, Heading)]
    own = any(_NUMBERED.match(plain(h.children) + " ") for h in headings)
    path: list[int] = []
    counts: list[int] = []
    for heading in headings:
        while path and path[-1] >= heading.level:
            path.pop()
        path.append(heading.level)
        depth = len(path)
        counts = [*counts, *[0] * depth][:depth]
        counts[-1] += 1
        heading.level = top - 1 + depth
        heading.number = "" if own else chapter + ".".join(str(n) for n in counts)


def number_blocks(cells: list[ReportCell], chapter: str = "") -> None:
    """Number tables and figures that have a caption; in a book with the chapter's number before."""
    counts = {"Table": 0, "Figure": 0}
    for block in walk(cells):
        if isinstance(block, Grid | Figure) and block.caption:
            word = "Table" if isinstance(block, Grid) else "Figure"
            counts[word] += 1
            block.number = f"{word} {chapter}{counts[word]}"


def collect_anchors(report: Report, reading: Reading) -> None:
    """Make anchors unique: headings that repeat are told apart, an equation number that repeats is a problem."""
    seen: dict[str, int] = {report.title_anchor: 0} if report.title_anchor else {}
    for cell in report.cells:
        reading.cell = cell.number
        if cell.anchor:
            seen[cell.anchor] = cell.number
        for node in walk(cell):
            match node:
                case Heading():
                    wanted, count = node.anchor, 1
                    while node.anchor in seen:
                        count += 1
                        node.anchor = f"{wanted}-{count}"
                    seen[node.anchor] = cell.number
                case Display(_, label, anchor) if anchor:
                    if anchor in seen:
                        other = f"here and in cell {seen[anchor]}"
                        text = f"equation ({label}) is numbered twice, {other}; show it without its label here"
                        reading.problems.append(Problem(cell.number, text))
                    seen[anchor] = cell.number
                case Anchor(name):
                    if name in seen:
                        reading.problems.append(Problem(cell.number, f"the anchor {name!r} is defined twice"))
                    seen[name] = cell.number
    report.anchors = set(seen)


def settle_links(report: Report, reading: Reading) -> None:
    for cell in report.cells:
        reading.cell = cell.number
        for node in walk(cell):
            if isinstance(node, Link):
                with reading.guard():
                    settle_link(node, report.name, report.anchors, reading.folder)


def settle_link(link: Link, name: str, anchors: set[str], folder: Path | None) -> None:
    """Say where a link leads. Raises CannotShow where it leads nowhere."""
    url = link.url.strip()
    path, _, fragment = url.partition("#")
    scheme = _SCHEME.match(url)
    if url.startswith("#"):
        wanted = anchor_of(unquote(fragment))
        found = next((a for a in (fragment, wanted) if a in anchors), None)
        if found is None:
            import difflib

            near = difflib.get_close_matches(wanted, sorted(anchors), 1, 0.5)
            hint = f"; did you mean #{near[0]}?" if near else ""
            raise CannotShow(f"a link to #{fragment}, which is nowhere in this notebook{hint}")
        link.kind, link.target = "internal", found
    elif scheme and scheme["scheme"].lower() == "notebook":
        link.kind, link.target = "notebook", unquote(url[len("notebook:") :])
    elif path.endswith(".ipynb") and not scheme:
        other = posixpath.normpath(posixpath.join(posixpath.dirname(name), unquote(path).removesuffix(".ipynb")))
        link.kind, link.target = "notebook", other + (f"#{unquote(fragment)}" if fragment else "")
    elif scheme and scheme["scheme"].lower() in ("http", "https", "mailto", "doi", "tel", "ftp"):
        link.kind, link.target = "external", url
    elif scheme:
        raise CannotShow(f"a link to {url[:80]}, which a report cannot follow; use https, mailto or an anchor")
    elif not path or folder is None or not (Path(folder) / unquote(path)).exists():
        raise CannotShow(f"a link to the file {url!r}, which is not beside the notebook")
    else:
        link.kind, link.target = "external", url


def beside(target: str, name: str, suffix: str) -> str:
    """The relative address of another notebook's report.

    >>> beside("double_tank/03_pole_placement#Results", "pid_report/01_terms", ".html")
    '../double_tank/03_pole_placement.html#Results'
    """
    other, _, anchor = target.partition("#")
    path = posixpath.relpath(other + suffix, posixpath.dirname(name) or ".")
    return path + (f"#{anchor}" if anchor else "")
