"""Tables: from a notebook's own table data, and from rows of cells that may span."""

import re
from typing import Any

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Anchor, Cell, Grid, plain
from notebook_reports.export.read.inline_text import read_inline

MAX_ROWS = 5000
_NUMBER = re.compile(
    r"[+−-]?(\d[\d\s.,]*)?[\d.](e[+−-]?\d+|\s?[×·]\s?10\S*)?([+−-][\d.]+(e[+−-]?\d+)?)?[ij]?\s?%?"
    r"|[+−-]?(nan|inf|∞)|<na>|none|nat|[–—−-]",
    re.IGNORECASE,
)

_DECIMAL = re.compile(r"(?P<before>[+−-]?\d+)(?P<behind>\.\d+)?(?: \S+)?")


def from_data(data: dict[str, Any]) -> Grid:
    """The table a `notebook_reports.display.Table` leaves in an output."""
    columns, align = data["columns"], data["align"]
    marks = data.get("marks") or [""] * len(data["rows"])
    cells = [Cell(read_inline(text), x, 0, align=align[x], head=True) for x, text in enumerate(columns)]
    above: list[str] = []
    for y, (row, mark) in enumerate(zip(data["rows"], marks, strict=True), start=1):
        for x, text in enumerate(row):
            last = x == len(row) - 1
            again = x < data.get("groups", 0) and row[: x + 1] == above[: x + 1]
            cells.append(Cell(read_inline(text), x, y, align=align[x], mark=mark if last else "", again=again))
        above = row
    for y, name in enumerate(data.get("anchors", ()), start=1):
        if name:
            first = next(cell for cell in cells if cell.y == y and not cell.again)  # one that is seen
            first.children.insert(0, Anchor(name))
    notes = [read_inline(note) for note in data.get("notes", ())]
    caption = read_inline(data.get("caption", ""))
    grid = Grid(cells, len(columns), len(data["rows"]) + 1, 1, caption, notes)
    align_points(grid)
    return limited(grid)


def grid_of(rows: list[list[Cell]], head_rows: int) -> Grid:
    """A grid from rows of cells, as HTML gives them: each goes to the next place that no span covers."""
    taken: set[tuple[int, int]] = set()
    cells = []
    for y, row in enumerate(rows):
        x = 0
        for cell in row:
            while (x, y) in taken:
                x += 1
            cell.x, cell.y = x, y
            cell.rowspan = min(cell.rowspan, (head_rows if y < head_rows else len(rows)) - y)
            taken |= {(x + i, y + j) for i in range(cell.colspan) for j in range(cell.rowspan)}
            cells.append(cell)
    columns = max((x for x, _ in taken), default=-1) + 1
    return limited(Grid(cells, columns, len(rows), head_rows))


def align_numbers(grid: Grid) -> None:
    """Columns whose body is all numbers go to the right, with their heads; heads over several columns to the middle."""
    for x in range(grid.columns):
        column = [c for c in grid.cells if c.x == x and c.colspan == 1 and not c.align]
        body = [c for c in column if not c.head]
        texts = [plain(c.children).strip() for c in body]
        numeric = any(texts) and all(_NUMBER.fullmatch(t) for t in texts if t)
        for cell in column:
            in_head = cell.y < grid.head_rows
            cell.align = "right" if numeric and (in_head or not cell.head) else "left"
    for cell in grid.cells:
        cell.align = cell.align or ("center" if cell.head and cell.y < grid.head_rows else "left")
    align_points(grid)


def align_points(grid: Grid) -> None:
    """Let the decimal points of a column to the right stand below each other, where that makes it little wider."""
    for x in range(grid.columns):
        body = [c for c in grid.cells if c.x == x and c.colspan == 1 and not c.head and c.align == "right"]
        numbers = [(c, found) for c in body if (found := _DECIMAL.fullmatch(plain(c.children).strip()))]
        places = [len(found["behind"] or "") for _, found in numbers]
        before = [len(found["before"]) for _, found in numbers]
        wide = [b + p for b, p in zip(before, places, strict=True)]
        if not numbers or len(set(places)) == 1 or max(before) + max(places) > 1.5 * max(wide) + 1:
            continue
        for (cell, _), given in zip(numbers, places, strict=True):
            lacks = max(places) - given
            cell.pad = "" if not lacks else "0" * lacks if given else "." + "0" * (lacks - 1)


def limited(grid: Grid) -> Grid:
    if grid.rows > MAX_ROWS:
        raise CannotShow(f"a table of {grid.rows} rows; a report shows at most {MAX_ROWS}: show a part of it")
    return grid
