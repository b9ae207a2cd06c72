"""Tables in HTML: their head, their spans, the looks of their cells."""

import re
from collections.abc import Sequence
from typing import Any, Protocol

from bs4 import BeautifulSoup, NavigableString, Tag

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Block, Cell, Display, Inline, Mend, Styled
from notebook_reports.export.read.css import Looks
from notebook_reports.export.read.reading import Reading, flow
from notebook_reports.export.read.tables import MAX_ROWS, align_numbers, grid_of


class CellReader(Protocol):
    """What reads the cells; see `html.HtmlReader`."""

    reading: Reading
    looks: Looks

    def blocks(self, parent: Tag, math: bool = True) -> list[Block]: ...
    def line(self, tag: Tag, math: bool) -> list[Inline]: ...
    def inline(self, node: Any, math: bool) -> Sequence[Inline | Display]: ...
    def block(self, node: Any, math: bool) -> list[Block] | None: ...
    def is_inline(self, node: Any) -> bool: ...


_MOST_SPAN = 1000
_PARTS = {"thead", "tbody", "tfoot", "tr", "td", "th", "caption", "colgroup", "col", "style", "template"}


def read(reader: CellReader, tag: Tag, math: bool) -> list[Block]:
    """The table; of one that only arranges other blocks, these one after the other. Raises CannotShow."""
    strays = _strays(reader, tag, math)
    if tag.find("table") or (reader.reading.mending and _arranges(tag)):
        if not reader.reading.mending:
            raise CannotShow("an HTML table inside a table cell; show the tables one after the other")
        inside = [c for c in tag.find_all(["th", "td", "caption"]) if c.find_parent("table") is tag]
        seen = [cell for cell in inside if not reader.looks.of(cell).hidden]
        return [*strays, *(block for cell in seen for block in reader.blocks(cell, math))]
    caption = tag.find("caption")
    sections: dict[str, list[Tag]] = {"thead": [], "tbody": [], "tfoot": []}
    for row in [row for row in tag.find_all("tr") if row.find_parent("table") is tag]:
        if not reader.looks.of(row).hidden:
            section = row.parent.name if row.parent else ""
            sections[section if section in sections else "tbody"].append(row)
    head = sections["thead"]
    rows = head + sections["tbody"] + sections["tfoot"]
    if not head:
        leading = [row.find("td") is None and row.find("th") is not None for row in rows]
        head = rows[: leading.index(False) if False in leading else 0]
    after: list[Block] = []
    if reader.reading.mending and len(rows) > MAX_ROWS:
        after.append(
            Mend("text", f"{len(rows) - MAX_ROWS:,} rows of {len(rows):,} are left out after row {MAX_ROWS:,}")
        )
        rows = rows[:MAX_ROWS]
    cells = [
        [_cell(reader, c, math) for c in row.find_all(["th", "td"], recursive=False) if not reader.looks.of(c).hidden]
        for row in rows
    ]
    if not any(cells):
        return strays
    grid = grid_of(cells, min(len(head), len(rows)))
    align_numbers(grid)
    grid.caption = reader.line(caption, math) if caption and not reader.looks.of(caption).hidden else []
    return [*strays, grid, *after]


def _strays(reader: CellReader, tag: Tag, math: bool) -> list[Block]:
    """What stands in the table outside of its cells; cells outside of a row get a row of their own."""
    strays: list[Block] = []
    own = [part for part in tag.find_all(["thead", "tbody", "tfoot", "tr"]) if part.find_parent("table") is tag]
    for part in [tag, *own]:
        if part is not tag and tag not in part.parents:
            continue  # it was inside of something stray
        row: Tag | None = None
        for child in list(part.children):
            name = child.name if isinstance(child, Tag) else ""
            if name in ("td", "th") and part.name != "tr":
                if row is None:
                    row = BeautifulSoup("", "html.parser").new_tag("tr")
                    child.insert_before(row)
                row.append(child.extract())
                continue
            row = row if not name and not str(child).strip() else None
            if name not in _PARTS and (name or (type(child) is NavigableString and child.strip())):
                blocks = reader.block(child, math) if name and not reader.is_inline(child) else None
                strays += flow(reader.inline(child, math)) if blocks is None else blocks
                child.extract()
    return strays


def _arranges(tag: Tag) -> bool:
    """Does the table only put blocks beside each other? Then a cell holds code of several lines or a heading."""
    cells = tag.find_all(["td", "th"])
    if len(cells) > 24:
        return False
    blocks = [pre for pre in tag.find_all(["pre", "h1", "h2", "h3", "figure"]) if "\n" in pre.get_text().strip()]
    return bool(blocks) or (len(cells) == 1 and len(tag.get_text().split()) > 40)


def _cell(reader: CellReader, tag: Tag, math: bool) -> Cell:
    look = reader.looks.of(tag)
    children = reader.line(tag, math)
    for style, asked in (("strong", look.bold and tag.name != "th"), ("emph", look.italic), ("strike", look.strike)):
        children = [Styled(style, children)] if asked and children else children
    columns, rows = _span(tag, "colspan"), _span(tag, "rowspan")
    return Cell(children, 0, 0, columns, rows, look.align, tag.name == "th", ink=look.ink, ground=look.ground)


def _span(tag: Tag, key: str) -> int:
    found = re.match(r"\d+", str(tag.get(key, "")))
    return min(max(1, int(found[0])), _MOST_SPAN) if found else 1
