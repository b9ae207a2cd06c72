"""A table in parts: every cell once, the naming column in each part; a column too wide becomes text."""

from notebook_reports.export.model import Cell, Grid, Mend, Text, Verbatim, plain
from notebook_reports.export.write.wide_tables import split


def table(columns, rows=3):
    places = [(x, y) for y in range(rows) for x in range(columns)]
    cells = [Cell([Text(f"r{y}c{x}" + "·" * 20)], x=x, y=y, head=y == 0 or x == 0) for x, y in places]
    return Grid(cells, columns, rows, 1)


def words(grid):
    return [plain(cell.children, "text") for cell in grid.cells]


def test_every_cell_is_in_one_part_and_the_first_column_in_each():
    whole = table(9)
    told, *parts = split(whole, 0.3)
    assert isinstance(told, Mend) and f"{len(parts)} parts" in told.reason and len(parts) > 2
    names = {w for w in words(whole) if "c0" in w}
    assert all(names <= set(words(part)) for part in parts)
    others = [w for part in parts for w in words(part) if "c0" not in w]
    assert sorted(others) == sorted(w for w in words(whole) if "c0" not in w)
    assert all({c.x for c in part.cells} == set(range(part.columns)) for part in parts)


def test_what_cannot_be_cut_stands_as_text():
    told, text = split(table(1), 0.2)
    assert isinstance(told, Mend) and isinstance(text, Verbatim)
    assert text.text.count("\n") == 2 and text.text.startswith("r0c0")
