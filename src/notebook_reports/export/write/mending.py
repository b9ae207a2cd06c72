"""What shows only when a report is written: formulas that are not understood, what is too wide for a page, characters
that no font has, pictures that the engine cannot read. Each becomes a `Mend`, and the report is written again.
"""

import re
from collections.abc import Callable, Iterator

from notebook_reports.export.formulas import as_mathml, as_text, as_typst
from notebook_reports.export.mends import number_mends
from notebook_reports.export.model import (
    Block,
    Display,
    FigureBlock,
    Grid,
    Inline,
    Math,
    Mend,
    Picture,
    Report,
    ReportCell,
    Verbatim,
    plain,
    rewrite,
    walk,
)
from notebook_reports.export.write.arrangement import Arrangement, to_float
from notebook_reports.export.write.glyphs import absent_in, is_east_asian, name_of, note_absent
from notebook_reports.export.write.typst import file_digest
from notebook_reports.export.write.typst_engine import (
    LANDSCAPE_FROM,
    TooWide,
    TypstFailed,
    cell_finder,
    compile_pdf,
    explain,
)
from notebook_reports.export.write.wide_tables import split
from notebook_reports.mathematics import MathError
from notebook_reports.mathematics.tolerant import readings

Written = tuple[str, dict[str, bytes], dict[str, Grid]]
"""Typst source, the files beside it, and the tables in it by their name."""

MOST_PASSES = 25
SMALLEST = 0.25
"""The share of its size below which a formula is shown as its source instead."""


def mend_formulas(report: Report, form: str) -> None:
    """Replace each formula that the converter to "typst" or "mathml" refuses by one that it reads, or by a `Mend`."""
    convert = as_typst if form == "typst" else as_mathml

    def mended(node: object) -> list[Block] | None:
        if not isinstance(node, Math | Display):
            return None
        refused = None
        for latex in readings(node.latex):
            try:
                convert(latex, isinstance(node, Display))
                as_text(latex)
            except (MathError, RecursionError) as error:
                refused = refused or error
                continue
            node.latex = latex
            return None
        reason = getattr(refused, "reason", "") or "it is nested too deeply"
        return [Mend("formula", reason, node.latex)]

    rewrite(report.title, mended)
    rewrite(report.cells, mended)


def compile_mending(report: Report, write: Callable[[Arrangement], Written]) -> bytes:
    """Compile the report; whatever the engine cannot show is mended in it. Raises TypstFailed where that fails."""
    layout = Arrangement()
    failed: TypstFailed | None = None
    for _ in range(MOST_PASSES):
        source, files, grids = write(layout)
        try:
            compiled = compile_pdf(source, files)
        except TypstFailed as error:
            failed = error
            error.source, error.files = source, files
            more = {w.id for w in error.wide if w.id in grids and w.share >= LANDSCAPE_FROM / 100} - layout.turned
            narrow = [w for w in error.wide if w.id not in more]
            layout = Arrangement(layout.turned | more, layout.floating)
            changed = [_narrowed(report, w, grids) for w in narrow]
            changed.append(bool(more))
            if not error.wide:
                changed.append(_without(report, error))
            if not any(changed):
                raise
            number_mends(report)
            continue
        floating = to_float(compiled.places, layout.floating)
        named = _name_absent(report)
        if not floating and not named:
            return compiled.pdf
        number_mends(report)
        layout = Arrangement(layout.turned, layout.floating | floating)
    raise failed or TypstFailed([])


# -- too wide ----------------------------------------------------------------------------------------------------------


def _narrowed(report: Report, wide: TooWide, grids: dict[str, Grid]) -> bool:
    """Split a table that is too wide, or make a formula as small as it has to be, with a line that says so."""
    if wide.id in grids:
        return _replace(report, grids[wide.id], split(grids[wide.id], wide.share))

    def smaller(node: object) -> list[Block] | None:
        if not isinstance(node, Math | Display) or node.small or file_digest(node.latex) != wide.id:
            return None
        if wide.share < SMALLEST:
            return [Mend("formula", "it is too wide for a page", node.latex)]
        node.small = True
        told = f"set at {wide.share:.0%} of its size, to fit the page"
        return [node, Mend("formula", told, remark=True)] if isinstance(node, Display) else None

    before = sum(1 for node in walk(report.cells) if isinstance(node, Mend) or getattr(node, "small", False))
    rewrite(report.cells, smaller)
    return before != sum(1 for node in walk(report.cells) if isinstance(node, Mend) or getattr(node, "small", False))


def _replace(report: Report, old: object, new: list[Block]) -> bool:
    found = []

    def change(node: object) -> list[Block] | None:
        if node is not old:
            return None
        found.append(node)
        return new

    rewrite(report.cells, change)
    return bool(found) and new != [old]


# -- what the engine refuses -------------------------------------------------------------------------------------------

_GLYPH = re.compile(r'(?:the text|contains the codepoint) `"(?P<text>.*)"`')
_PICTURE = re.compile(r"picture-[0-9a-f]{16}\.\w+")


def _without(report: Report, error: TypstFailed) -> bool:
    """Take out of the report what the engine complains of: characters, pictures, or else the whole cell."""
    find = cell_finder(error.source, error.files)
    lines = error.source.split("\n")
    fresh = False
    for diagnostic in error.diagnostics:
        glyph = _GLYPH.search(diagnostic.message)
        if glyph:
            text = re.sub(r"\\u\{([0-9a-f]+)\}", lambda m: chr(int(m[1], 16)), glyph["text"])
            fresh |= note_absent(text)
            continue
        named = _PICTURE.findall(lines[diagnostic.line - 1]) if diagnostic.line else []
        cell, told = explain(diagnostic, find)
        if (
            "image" in diagnostic.message.lower()
            or "svg" in diagnostic.message.lower()
            or "decode" in diagnostic.message
        ):
            fresh |= _without_pictures(report, cell, set(named), diagnostic.message)
        elif cell:
            fresh |= _as_text(report, cell, told)
    return fresh


def _without_pictures(report: Report, cell: int | None, named: set[str], message: str) -> bool:
    found = []

    def change(node: object) -> list[Block] | None:
        picture = node.picture if isinstance(node, FigureBlock) else node
        if not isinstance(picture, Picture):
            return None
        found.append(picture)
        caption = getattr(node, "caption", [])
        words = plain(caption) or picture.alt
        return [Mend("image", f"it cannot be read ({message})", words)]

    for place in report.cells:
        if cell is None or place.number == cell:
            rewrite(place, change)
    return bool(found)


def _as_text(report: Report, number_: int, told: str) -> bool:
    """The whole cell as the characters in it: the last resort."""
    for cell in report.cells:
        if cell.number == number_ and not any(isinstance(b, Mend) and b.reason == told for b in cell.blocks):
            words = "\n".join(_texts(cell))
            cell.blocks = [Mend("cell", told), Verbatim(words, "output")]
            return True
    return False


def _texts(cell: ReportCell | list[Inline]) -> Iterator[str]:
    for node in walk(cell):
        if isinstance(node, Verbatim):
            yield node.text
        elif isinstance(node, Math | Display):
            yield node.latex
        elif hasattr(node, "text") and isinstance(node.text, str):
            yield node.text


# -- characters --------------------------------------------------------------------------------------------------------


def _name_absent(report: Report) -> bool:
    """Say once which characters stand in the report as their names; are there any, and was it not yet said?"""
    if any(isinstance(node, Mend) and node.kind == "character" for node in walk(report.cells)):
        return False
    found: dict[str, None] = {}
    cells: list[ReportCell] = []
    for cell in report.cells:
        title = report.title if cell is report.cells[0] else []
        texts = [*_texts(cell), *_texts(title), *(n.alt for n in walk(cell) if isinstance(n, Picture))]
        drawings = (n.data.decode(errors="replace") for n in walk(cell) if isinstance(n, Picture) and n.kind == "svg")
        here = dict.fromkeys(c for text in (*texts, *drawings) for c in absent_in(text) if name_of(c))
        cells += [cell] if here else []
        found |= here
    if not found:
        return False
    shown = ", ".join(name_of(c) for c in list(found)[:8])
    more = f" and {len(found) - 8} more" if len(found) > 8 else ""
    where = f", here and in {len(cells) - 1} more cells" if len(cells) > 1 else ""
    cure = "; pip install loopbook[cjk] brings a font" if any(map(is_east_asian, found)) else ""
    told = f"no font has {shown}{more}; by name{where or ' here'}{cure}"
    cells[0].blocks.append(Mend("character", told, remark=True))
    return True
