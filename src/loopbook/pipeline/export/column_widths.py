"""What decides how wide the columns of a table become: the few cells that the engine has to measure.

To measure every cell of a table takes as long as to set it. Most cells are plainly not the widest of their column: an
estimate from the letters, good to some ten percent, tells which may be. Formulas are not estimated but measured.
"""

import re
from dataclasses import dataclass
from math import ceil

from loopbook.pipeline.export.model import Anchor, Cell, Code, Grid, Inline, Styled, Text, plain

NEAR = 0.75
"""From this share of the longest estimate of its column on a cell may be the widest."""
SHORT = 12
"""Characters up to which a cell is not broken into lines."""
TEXT_WIDTH = 453
"""Points between the margins of a page."""
SIZE = 9.5
"""Points: the size of the letters in a table, and what a cell has beside its text, left and right together."""
LINE, GAP = 12.0, 8.0
"""Points from one line of a cell to the next, and what a row has above and below."""
_KINDS = ((" ,.;:'|ilI\u200b", 0.28), ("ftjrJs()[]-/", 0.38), ("mwMW%−×≈≤≥", 0.85), ("ABCDEFGHKLNOPQRSTUVXYZ", 0.66))
_EM = {letter: width for letters, width in _KINDS for letter in letters}
_USUAL, _FIXED, _BOLD = 0.5, 0.62, 1.1
_WORDS = re.compile(r"[\s\u200b]+|(?<=[-/–])")


@dataclass(frozen=True)
class Deciding:
    """By column the cells, as places in the grid's list, of which one is the widest, and of which one holds the
    widest piece that no line end divides. Cells over several columns are in neither."""

    widest: tuple[tuple[int, ...], ...]
    solid: tuple[tuple[int, ...], ...]


def deciding(grid: Grid) -> Deciding:
    """The cells to be measured."""
    widest: list[list[tuple[int, float | None, str]]] = [[] for _ in range(grid.columns)]
    solid: list[list[tuple[int, float | None, str]]] = [[] for _ in range(grid.columns)]
    for place, cell in enumerate(grid.cells):
        if cell.colspan == 1:
            whole, shape = extent(cell), _shape(cell)
            widest[cell.x].append((place, whole, shape))
            longest = whole if unbroken(cell) or whole is None else _longest(cell)
            solid[cell.x].append((place, longest, shape))
    return Deciding(tuple(map(_near, widest)), tuple(map(_near, solid)))


def extent(cell: Cell) -> float | None:
    """The width of a cell on one line in points, by estimate; None where it holds what only the engine can measure."""
    ems = _ems(cell.children)
    return None if ems is None else SIZE * (ems * (_BOLD if cell.head else 1) + bool(cell.mark))


def unbroken(cell: Cell) -> bool:
    """Does the cell stay on one line: numbers, verdicts and a few letters?"""
    return cell.align == "right" or bool(cell.mark) or len(plain(cell.children)) <= SHORT


def words(text: str) -> list[str]:
    """The pieces of a text between which a line may end."""
    return _WORDS.split(text)


def height(grid: Grid) -> float:
    """The height of a table on a page in points, by estimate: its columns share the room by what they hold."""
    needs = [_ems([Text(plain(cell.children, "text"))]) * SIZE for cell in grid.cells]
    widths = [0.0] * grid.columns
    for cell, need in zip(grid.cells, needs, strict=True):
        if cell.colspan == 1:
            widths[cell.x] = max(widths[cell.x], need + SIZE)
    share = min(1.0, TEXT_WIDTH / max(sum(widths), 1.0))
    lines = [1] * grid.rows
    for cell, need in zip(grid.cells, needs, strict=True):
        room = sum(widths[cell.x : cell.x + cell.colspan]) * share - SIZE
        lines[cell.y] = max(lines[cell.y], ceil(need / max(room, 4 * SIZE)))
    return sum(count * LINE + GAP for count in lines)


def _near(estimates: list[tuple[int, float | None, str]]) -> tuple[int, ...]:
    """The places whose estimate is near the largest or unknown, one of each shape."""
    least = NEAR * max((width for _, width, _ in estimates if width is not None), default=0.0)
    found: dict[str, int] = {}
    for place, width, shape in estimates:
        if width is None or width >= least:
            found.setdefault(shape, place)
    return tuple(found.values())


def _longest(cell: Cell) -> float:
    return SIZE * max((_ems([Text(word)]) for word in words(plain(cell.children, "text"))), default=0.0)


def _ems(nodes: list[Inline]) -> float | None:
    """The width in the size of the letters, or None for what is neither text nor code."""
    total = 0.0
    for node in nodes:
        match node:
            case Text(text):
                total += sum(_EM.get(letter, _USUAL) for letter in text)
            case Code(text):
                total += _FIXED * len(text)
            case Anchor():
                pass
            case Styled(_, inside) if (width := _ems(inside)) is not None:
                total += width * _BOLD
            case _:
                return None
    return total


def _shape(cell: Cell) -> str:
    """Equal for cells that are equally wide, whatever their digits: these are all equally wide."""
    kinds = "".join(type(node).__name__ for node in cell.children)
    return f"{cell.head} {cell.mark} {kinds} {re.sub('[0-9]', '0', plain(cell.children))}"
