"""A notebook read into a report: its title, its cells as blocks, its numbers, its links settled."""

import difflib
import posixpath
import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from notebook_reports.export.errors import CannotShow, ExportError, Problem
from notebook_reports.export.model import (
    Alert,
    Anchor,
    Aside,
    Block,
    Display,
    FigureBlock,
    Folded,
    Grid,
    Heading,
    Inline,
    Link,
    Mend,
    Note,
    Paragraph,
    Picture,
    Report,
    ReportCell,
    Text,
    Verbatim,
    plain,
    rewrite,
    walk,
    words_only,
)
from notebook_reports.export.read.equations import number_equations, settle_references
from notebook_reports.export.read.footnotes import footnotes, references
from notebook_reports.export.read.html import read_html
from notebook_reports.export.read.markdown import read_markdown
from notebook_reports.export.read.outputs import read_outputs
from notebook_reports.export.read.reading import Reading, anchor_of, flow, trim
from notebook_reports.export.read.solutions import GIVEN, LAST, arranged
from notebook_reports.export.read.terminal import visible

NO_INPUT = {"remove-input", "remove_input", GIVEN}
NO_OUTPUT = {"remove-output", "remove_output"}
NO_CELL = {"remove-cell", "remove_cell"}
FOLDED_INPUT = {"hide-input", "hide_input", "hide-cell", "hide_cell"}
FOLDED_OUTPUT = {"hide-output", "hide_output", "hide-cell", "hide_cell"}
PARTS = ("markdown", "raw", "code", "input", "output")
"""What may be left out of a report as a whole."""
NEW_PAGE = "new-page"
LONGEST_LEAD = 360
"""Characters of a paragraph, four lines, up to which it stays with what it introduces."""
FOLDED = "folded"
"""Of a Markdown cell that opens with a heading: its section is folded on a screen."""
FRAMES: dict[str, Callable[[list[Block]], Block]] = {
    "margin": Aside,
    "try-it": lambda blocks: Alert("info", blocks),
}
"""Tags of a Markdown cell that stands in the margin or in a box."""
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
    mode: str = "strict",
    root: Path | None = None,
    leave_out: frozenset[str] = frozenset(),
    solutions: str = LAST,
) -> Report:
    """Read a notebook (nbformat 4). Raises ExportError that names every cell which holds what no page can show.

    The title is the one given, else the first top heading, else the last part of `name`. name: "folder/notebook", as
    links from other notebooks call it. mode: one of `mends.MODES`; mended, a report always comes. folder:
    where relative images are looked up; root: below which they have to lie, default the folder. leave_out: of `PARTS`.
    solutions: see `arranged`.
    """
    reading = Reading(folder, document, strict_alt, mode == "mend", root)
    sources = _markdown_sources(notebook)
    reading.footnotes, reading.note_references = footnotes(sources), references(sources)
    cells = []
    for number, cell in arranged(notebook, solutions):
        reading.cell = number
        reading.attachments = cell.get("attachments") or {}
        blocks = _cell(cell, reading, _language(notebook), leave_out)
        anchor = f"cell-{number}" if cell["cell_type"] == "code" and blocks else ""
        tags = cell.get("metadata", {}).get("tags", ())
        folded = FOLDED in tags and bool(blocks) and isinstance(blocks[0], Heading)
        cells.append(ReportCell(number, blocks, anchor, NEW_PAGE in tags, folded))
    first = _take_title(cells)
    words: list[Inline] = first.children if first else [Text(name.rpartition("/")[2].replace("_", " "))]
    words = words_only(words)
    report = Report(name, words, first.anchor if first else "", cells, document, chapter, language, author)
    report.contents = bool(notebook.get("metadata", {}).get("loopbook", {}).get("contents", True))
    if title and title not in (report.plain_title, plain(words)):
        report.title = [Text(title)]
    report.mended = reading.mending
    report.aliases = plain_headings(cells)
    level_headings(cells)
    number_blocks(cells)
    mark_leads(cells)
    equations = number_equations(report)
    collect_anchors(report, reading)
    settle_references(report, equations, reading)
    settle_links(report, reading)
    if reading.problems:
        raise ExportError(name, reading.problems)
    return report


def _markdown_sources(notebook: Any) -> list[str]:
    return [_source(cell) for cell in notebook["cells"] if cell["cell_type"] == "markdown"]


def _source(cell: Any) -> str:
    return "".join(cell.get("source") or "")


def _language(notebook: Any) -> str:
    metadata = notebook.get("metadata", {})
    told = metadata.get("language_info", {}).get("name") or metadata.get("kernelspec", {}).get("language")
    return (told or "python").lower()


def _cell(cell: Any, reading: Reading, language: str, leave_out: frozenset[str] = frozenset()) -> list[Block]:
    tags = set(cell.get("metadata", {}).get("tags", ()))
    source = _source(cell)
    if tags & NO_CELL or cell["cell_type"] in leave_out:
        return []
    match cell["cell_type"]:
        case "markdown" | "heading":
            found = reading.attempt(lambda: read_markdown(source, reading), source)
            frame = next((FRAMES[tag] for tag in FRAMES if tag in tags), None)
            return [frame(found)] if frame and found else found
        case "raw":
            return reading.attempt(lambda: _raw(source, cell.get("metadata", {}), reading), source)
        case "code":
            blocks: list[Block] = []
            removed = (
                tags & NO_INPUT
                or "input" in leave_out
                or cell.get("metadata", {}).get("transient", {}).get("remove_source")
            )
            if source.strip() and not removed:
                text = visible(source.expandtabs(4)).strip("\n")
                blocks.append(Verbatim(text, "input", language, bool(tags & FOLDED_INPUT)))
            if not tags & NO_OUTPUT and "output" not in leave_out:
                shown = read_outputs(cell.get("outputs") or (), reading)
                blocks += [Folded("Output", shown)] if shown and tags & FOLDED_OUTPUT else shown
            return blocks
    told = CannotShow(f"a cell of the kind {cell['cell_type']}; make it Markdown or code", "cell", text=source)

    def refused() -> list[Block]:
        raise told

    return reading.attempt(refused)


def _raw(source: str, metadata: Any, reading: Reading) -> list[Block]:
    mime = metadata.get("raw_mimetype") or metadata.get("format") or "text/plain"
    if mime == "text/markdown":
        return read_markdown(source, reading)
    if mime == "text/html":
        return read_html(source, reading)
    if mime == "text/latex" and not reading.mending:
        return [*reading.display(source)]
    if mime == "text/plain" or reading.mending:
        return [Verbatim(visible(source.expandtabs(4)).strip("\n"))] if source.strip() else []
    raise CannotShow(f"a raw cell of the kind {mime}; make it Markdown, or plain text")


def _take_title(cells: list[ReportCell]) -> Heading | None:
    """The first top heading, taken out of its cell, if nothing but empty cells and code stands before it."""
    for cell in cells:
        for i, block in enumerate(cell.blocks):
            if isinstance(block, Heading):
                if block.level != 1:
                    return None
                del cell.blocks[i]
                return block
    return None


def plain_headings(cells: list[ReportCell]) -> dict[str, str]:
    """Take out of headings what contents cannot repeat: pictures, notes and mends stand below, anchors become names
    for the heading itself, returned with its own. A heading without words is a paragraph."""
    aliases: dict[str, str] = {}

    def changed(node: object) -> list[Block] | None:
        if not isinstance(node, Heading):
            return None
        words = words_only(node.children, pictures=False)
        trim(words)
        rest = [part for part in [*walk(node)] if isinstance(part, Picture | Note | Mend)]
        if not plain(words, "text").strip():
            return flow(rest)
        aliases.update((part.name, node.anchor) for part in walk(node) if isinstance(part, Anchor))
        if node.children == words:
            return None
        return [Heading(node.level, words, node.anchor), *flow(rest)]

    rewrite(cells, changed)
    return aliases


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
        if isinstance(block, Grid | FigureBlock) and block.caption:
            word = "Table" if isinstance(block, Grid) else "Figure"
            counts[word] += 1
            block.number = f"{word} {chapter}{counts[word]}"


def mark_leads(cells: list[ReportCell]) -> None:
    """Mark the paragraphs that introduce what follows: those that end in a colon, and a short one before code."""
    blocks = [(block, bool(cell.anchor)) for cell in cells for block in cell.blocks]
    for (block, _), (after, by_code) in pairwise(blocks):
        if isinstance(block, Paragraph) and not isinstance(after, Paragraph | Heading):
            words = plain(block.children).rstrip()
            block.leads = (words.endswith(":") or by_code) and len(words) <= LONGEST_LEAD


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
                    if anchor in seen and reading.mending:
                        node.anchor = ""
                        continue
                    if anchor in seen:
                        other = f"here and in cell {seen[anchor]}"
                        text = f"equation ({label}) is numbered twice, {other}; show it without its label here"
                        reading.problems.append(Problem(cell.number, text))
                    seen[anchor] = cell.number
                case Anchor(name):
                    if name in seen and reading.mending:
                        node.name = ""
                        continue
                    if name in seen:
                        reading.problems.append(Problem(cell.number, f"the anchor {name!r} is defined twice"))
                    seen[name] = cell.number
    rewrite(report.cells, lambda node: [] if isinstance(node, Anchor) and not node.name else None)
    report.anchors = set(seen)


def settle_links(report: Report, reading: Reading) -> None:
    """Say of each link where it leads; the words of one that leads nowhere stay, and a `Mend` stands after them."""
    for number, part in [(0, report.title), *((cell.number, cell) for cell in report.cells)]:
        reading.cell = number
        for link in [node for node in walk(part) if isinstance(node, Link)]:

            def settle(link: Link = link) -> list[Mend]:
                settle_link(link, report.name, report.anchors | set(report.aliases), reading.folder, reading.mending)
                link.target = report.aliases.get(link.target, link.target) if link.kind == "internal" else link.target
                return []

            found = reading.attempt(settle)
            if found:
                link.kind = "nowhere"
                link.children.append(Mend("link", found[0].reason, address=found[0].address, remark=True))


def settle_link(link: Link, name: str, anchors: set[str], folder: Path | None, tolerant: bool = False) -> None:
    """Say where a link leads. Raises CannotShow where it leads nowhere.

    tolerant: an anchor is also found by its letters and digits alone, as other programs name headings.
    """
    url = link.url.strip()
    path, _, fragment = url.partition("#")
    scheme = _SCHEME.match(url)
    if url.startswith("#"):
        wanted = anchor_of(unquote(fragment))
        found = next((a for a in (fragment, unquote(fragment), wanted) if a in anchors), None)
        if found is None and tolerant and _letters(wanted):
            found = next((a for a in sorted(anchors) if _letters(a) == _letters(wanted)), None)
        if found is None:
            near = difflib.get_close_matches(wanted, sorted(anchors), 1, 0.5)
            hint = f"; did you mean #{near[0]}?" if near else ""
            told = "it leads to a place that is nowhere in this notebook"
            raise CannotShow(
                f"a link to #{fragment}, which is nowhere in this notebook{hint}", "link", told, address=url
            )
        link.kind, link.target = "internal", found
    elif scheme and scheme["scheme"].lower() == "notebook":
        link.kind, link.target = "notebook", unquote(url[len("notebook:") :])
    elif path.endswith(".ipynb") and not scheme:
        other = posixpath.normpath(posixpath.join(posixpath.dirname(name), unquote(path).removesuffix(".ipynb")))
        link.kind, link.target = "notebook", other + (f"#{unquote(fragment)}" if fragment else "")
    elif scheme and scheme["scheme"].lower() in ("http", "https", "mailto", "doi", "tel", "ftp"):
        link.kind, link.target = "external", url
    elif url.startswith("//"):
        link.kind, link.target = "external", "https:" + url
    elif scheme:
        raise CannotShow(
            f"a link to {url[:80]}, which a report cannot follow; use https, mailto or an anchor",
            "link",
            f"a page cannot follow {scheme['scheme']}:",
            address=url[:200],
        )
    elif not url:
        raise CannotShow("a link without an address", "link", "it has no address")
    elif not path or folder is None or not _beside(folder, path):
        raise CannotShow(
            f"a link to the file {url!r}, which is not beside the notebook",
            "link",
            "it leads to a file that is not beside the notebook",
            address=url[:200],
        )
    else:
        link.kind, link.target = "external", url


def _letters(anchor: str) -> str:
    return re.sub(r"[\W_]+", "", anchor).casefold()


def _beside(folder: Path, path: str) -> bool:
    try:
        return (Path(folder) / unquote(path)).exists()
    except (OSError, ValueError):
        return False


def relative_address(target: str, name: str, suffix: str) -> str:
    """The relative address of another notebook's report.

    >>> relative_address("double_tank/03_pole_placement#Results", "pid_report/01_terms", ".html")
    '../double_tank/03_pole_placement.html#Results'
    """
    other, _, anchor = target.partition("#")
    path = posixpath.relpath(other + suffix, posixpath.dirname(name) or ".")
    return path + (f"#{anchor}" if anchor else "")
