"""A table too wide for a page in parts, one below the other; the columns that name the rows stand in each part."""

from copy import deepcopy

from notebook_reports.export.model import Block, Cell, Grid, Mend, Verbatim, plain
from notebook_reports.export.write.column_widths import extent

COMFORTABLE = 0.75
"""The share of its size at which a part is set."""


def split(grid: Grid, share: float) -> list[Block]:
    """The parts and a line that says so, or the table's rows as text where a single column is too wide.

    share: of its size at which the whole fits. Cells over several columns are cut where a part ends.
    """
    names = _naming(grid)
    widths = _widths(grid)
    room = sum(widths) * share / COMFORTABLE
    fixed = sum(widths[:names])
    parts: list[list[int]] = [[]]
    filled = fixed
    for column in range(names, grid.columns):
        if parts[-1] and filled + widths[column] > room:
            parts.append([])
            filled = fixed
        parts[-1].append(column)
        filled += widths[column]
    if len(parts) < 2:
        half = (grid.columns - names + 1) // 2
        if half < 1 or grid.columns - names < 2:
            return _rows(grid)
        body = list(range(names, grid.columns))
        parts = [body[:half], body[half:]]
    grids = [_part(grid, [*range(names), *part]) for part in parts]
    told = f"its {grid.columns} columns are too many for the width of a page; they stand in {len(grids)} parts below"
    return [Mend("table", told, remark=True), *grids]


def _naming(grid: Grid) -> int:
    """How many columns at the left name the rows; at most a third of all."""
    count = 0
    for x in range(grid.columns // 3):
        body = [cell for cell in grid.cells if cell.x == x and cell.y >= grid.head_rows]
        if not body or not all(cell.head for cell in body):
            break
        count = x + 1
    return count


def _widths(grid: Grid) -> list[float]:
    widths = [10.0] * grid.columns
    for cell in grid.cells:
        if cell.colspan == 1:
            low, high = extent(cell)
            widths[cell.x] = max(widths[cell.x], min(low if high == float("inf") else high, 240.0) + 10)
    return widths


def _part(grid: Grid, columns: list[int]) -> Grid:
    place = {column: x for x, column in enumerate(columns)}
    cells: list[Cell] = []
    for cell in grid.cells:
        covered = [x for x in range(cell.x, cell.x + cell.colspan) if x in place]
        if covered:
            kept = deepcopy(cell)
            kept.x, kept.colspan = place[covered[0]], len(covered)
            cells.append(kept)
    return Grid(cells, len(columns), grid.rows, grid.head_rows, grid.caption, grid.notes, grid.number)


def _rows(grid: Grid) -> list[Block]:
    """Each row as a line of text."""
    rows: list[list[str]] = [[] for _ in range(grid.rows)]
    for cell in grid.cells:
        rows[cell.y].append(plain(cell.children, "text"))
    text = "\n".join(" | ".join(row) for row in rows)
    return [
        Mend("table", "its cells are too wide for a page; it stands as text below", remark=True),
        Verbatim(text, "output"),
    ]
