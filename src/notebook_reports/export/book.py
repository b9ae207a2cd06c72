"""Many notebooks as one PDF: cover, parts, chapters, appendix, one numbering, one table of contents, links that work.

pdf = export_book(
    [Chapter("double_tank/03_pole_placement", notebook, part="Double tank")],
    title="Control design, recomputed",
    subtitle="Three documents and every number in them",
    lines=["412 printed values checked"],
    appendix=[Page("Ledger", [table, "All of [chapter 1](notebook:double_tank/03_pole_placement)."])],
)
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from notebook_reports.export.code_cells import INLINE, for_paper, place_code
from notebook_reports.export.errors import ExportError, Problem
from notebook_reports.export.exporters.base import as_export_error, problems, support_files
from notebook_reports.export.model import Link, PageNumber, Report, walk
from notebook_reports.export.page import LinkedTable, Page, page_name, read_page
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.export.read.notebook import level_headings, number_blocks, read
from notebook_reports.export.read.solutions import LAST
from notebook_reports.export.write.arrangement import Arrangement
from notebook_reports.export.write.typst import IMPORT, TypstWriter
from notebook_reports.export.write.typst_engine import CHAPTER, TypstFailed, compile_settled, too_wide_table
from notebook_reports.export.write.typst_text import typst_string

__all__ = ["Chapter", "LinkedTable", "Page", "export_book"]


@dataclass(frozen=True)
class Chapter:
    """One notebook of a book.

    name: "folder/notebook", as links call it. title: default its first top heading. part: chapters of the same part
    stand together. about: inline text below the title of the part that begins here. document: what its equation
    anchors begin with. assets: where its relative images are; root: below which they have to lie. solutions: where
    those of its exercises stand, see `export.read.solutions`.
    """

    name: str
    notebook: Any
    title: str = ""
    part: str = ""
    about: str = ""
    document: str = ""
    assets: Path | None = None
    root: Path | None = None
    solutions: str = LAST


@dataclass(frozen=True)
class _Bound:
    """A chapter ready to be written. number: "3" or "B", "" before the first chapter. part: the
    heading of a part that begins here, or ""; about: what stands below it."""

    report: Report
    number: str
    part: str
    about: str = ""


@dataclass(frozen=True)
class _Cover:
    title: str
    subtitle: str
    lines: tuple[str, ...]
    author: str
    language: str
    depth: int


def export_book(
    chapters: Sequence[Chapter],
    *,
    title: str,
    subtitle: str = "",
    lines: Sequence[str] = (),
    front: Sequence[Page] = (),
    appendix: Sequence[Page] = (),
    appendix_title: str = "Appendix",
    code: str = INLINE,
    author: str = "loopbook",
    language: str = "en",
    contents_depth: int = 3,
    strict_alt: bool = True,
) -> bytes:
    """One PDF/A-2a and PDF/UA-1 of all chapters. lines: inline text at the foot of the cover.

    front: pages before the first chapter. code: of each chapter in its place ("inline"), at its end ("end") or nowhere
    ("none"). contents_depth: levels in the table of contents; parts, where there are any, are the first.
    In the book ``notebook:NAME#ANCHOR`` leads to that place; a name or an anchor the book does not have is an error.
    Raises ExportError; ValueError for an empty book or a name twice.
    """
    bound, anchors, top = _bind(chapters, front, appendix, appendix_title, language, strict_alt, code)
    cover = _Cover(title, subtitle, tuple(lines), author, language, contents_depth)
    try:
        return compile_settled(lambda layout: _source(bound, anchors, top, cover, layout))
    except TypstFailed as error:
        raise _of_chapter(error) from None


def _bind(
    chapters: Sequence[Chapter],
    front: Sequence[Page],
    appendix: Sequence[Page],
    appendix_title: str,
    language: str,
    strict_alt: bool,
    code: str,
) -> tuple[list[_Bound], dict[str, set[str]], int]:
    """Everything read and numbered, the anchors of each chapter, and the heading level of chapters."""
    if not chapters:
        raise ValueError("a book needs at least one chapter")
    names = [chapter.name for chapter in chapters] + [page_name(page) for page in (*front, *appendix)]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"a book has each name once; twice here: {', '.join(twice)}")
    parts = any(chapter.part for chapter in chapters)
    top = 2 if parts else 1
    bound, part = [_Bound(read_page(page, strict_alt), "", "") for page in front], ""
    for number, chapter in enumerate(chapters, start=1):
        report = read(
            chapter.notebook,
            chapter.name,
            title=chapter.title,
            document=chapter.document,
            language=language,
            folder=chapter.assets,
            root=chapter.root,
            strict_alt=strict_alt,
            solutions=chapter.solutions,
        )
        bound.append(_Bound(report, str(number), chapter.part if chapter.part != part else "", chapter.about))
        part = chapter.part
    for number, page in enumerate(appendix):
        report = read_page(page, strict_alt)
        bound.append(_Bound(report, chr(ord("A") + number), appendix_title if parts and not number else ""))
    anchors = {entry.report.name: entry.report.anchors for entry in bound}
    found = []
    for entry in bound:
        before = f"{entry.number}." if entry.number else ""
        level_headings(entry.report.cells, top + 1, before)
        number_blocks(entry.report.cells, before)
        if entry.number.isdigit():
            for_paper(entry.report)
            place_code(entry.report, code, top + 1)
        found += [(entry.report.name, p) for p in problems(entry.report, "typst") + _dead_links(entry.report, anchors)]
    if found:
        name = found[0][0]
        raise ExportError(name, [problem for where, problem in found if where == name])
    return bound, anchors, top


def _dead_links(report: Report, anchors: dict[str, set[str]]) -> list[Problem]:
    found = []
    for cell in report.cells:
        for node in walk(cell):
            target = node.target if isinstance(node, PageNumber) else ""
            if isinstance(node, Link) and node.kind == "notebook":
                target = node.target
            name, _, anchor = target.partition("#")
            if target and (name not in anchors or (anchor and anchor not in anchors[name])):
                what = f"no place #{anchor} in {name}" if name in anchors else f"no chapter {name}"
                found.append(Problem(cell.number, f"a link to {what} of this book"))
    return found


def _source(
    bound: list[_Bound], anchors: dict[str, set[str]], top: int, cover: _Cover, layout: Arrangement
) -> tuple[str, dict[str, bytes]]:
    """The Typst source of the book and the files beside it; a comment names each chapter for `_of_chapter`."""
    lines = "".join(f"[{TypstWriter().inline(read_inline(line))}], " for line in cover.lines)
    told = ", ".join(typst_string(text) for text in (cover.title, cover.subtitle))
    rest = f"{typst_string(cover.author)}, {typst_string(cover.language)}, {cover.depth}, {top}"
    pieces = [IMPORT, f"#show: book.with({told}, ({lines}), {rest})"]
    files = dict(support_files())
    roman = 0
    for entry in bound:
        report = entry.report
        writer = TypstWriter(report.name, f"{report.name}#", anchors, layout)
        pieces.append(f"{CHAPTER}{report.name}\n// cell 0")
        if entry.part:
            roman += 1
            number = _roman(roman) if entry.number.isdigit() else ""
            about = f", about: [{writer.inline(read_inline(entry.about))}]" if entry.about else ""
            pieces.append(f"#part({typst_string(number)}{about})[#{typst_string(entry.part)};]")
        also = [writer.label(report.title_anchor)] if report.title_anchor else []
        labels = ", ".join([f"label({typst_string(report.name)})", *also])
        level = top if entry.number else 1
        pieces.append(f"#chapter({level}, {typst_string(entry.number)}, ({labels},))[{writer.inline(report.title)}]")
        pieces += [f"// cell {cell.number}\n{writer.report_cell(cell)}\n" for cell in report.cells if cell.blocks]
        files |= writer.files
    return "\n".join(pieces) + "\n", files


def _of_chapter(error: TypstFailed) -> ExportError:
    """The error with the name of the chapter it lies in."""
    name = "the book"
    for diagnostic in error.diagnostics:
        table = too_wide_table(diagnostic)
        if table:
            name = table.rsplit(" ", 2)[0]
        elif diagnostic.line is not None:
            above = error.source.split("\n")[: diagnostic.line]
            name = next((line[len(CHAPTER) :] for line in reversed(above) if line.startswith(CHAPTER)), name)
        break
    return as_export_error(error, name)


def _roman(number: int) -> str:
    """
    >>> [_roman(n) for n in (1, 4, 9, 14)]
    ['I', 'IV', 'IX', 'XIV']
    """
    digits = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))
    shown = ""
    for value, letters in digits:
        shown += letters * (number // value)
        number %= value
    return shown
