"""What decides how wide the columns of a table become: the few cells that the engine has to measure.

To measure every cell of a table takes as long as to set it. Most cells are plainly not the widest of their column: an
estimate from the letters, good to some ten percent for text and a rough one for formulas, tells which may be.
"""

import re
from dataclasses import dataclass
from math import ceil, fsum, inf, sqrt

from notebook_reports.export.model import Anchor, Cell, Code, Grid, Inline, Math, Styled, Text, plain

NEAR = 0.75
"""From this share of the longest estimate of its column on a cell may be the widest."""
SHORT = 12
"""Characters up to which a cell is not broken into lines."""
VERDICT = 24
"""The same for a cell with a mark: a verdict, not a sentence with a verdict's colour."""
TEXT_WIDTH, TEXT_HEIGHT = (21 - 2 * 2.5) * 72 / 2.54, (29.7 - 2.7 - 2.5) * 72 / 2.54
"""Points between the margins of a page: A4 in centimetres, less the margins of ``report.typ``."""
SIZE = 9.5
"""Points: the size of the letters in a table, and what a cell has beside its text, left and right together."""
LINE, GAP = 12.0, 8.0
"""Points from one line of a cell to the next, and what a row has above and below."""
_KINDS = ((" ,.;:'|ilI\u200b", 0.28), ("ftjrJs()[]-/", 0.38), ("mwMW%−×≈≤≥", 0.85), ("ABCDEFGHKLNOPQRSTUVXYZ", 0.66))
_EM = {letter: width for letters, width in _KINDS for letter in letters}
_USUAL, _FIXED, _BOLD = 0.5, 0.62, 1.1
_WORDS = re.compile(r"[\s\u200b]+|(?<=[-/])(?=\D)|(?<=–)")


Range = tuple[float, float]


@dataclass(frozen=True)
class Deciding:
    """By column the cells, as places in the grid's list, of which one is the widest, and of which one holds the
    widest piece that no line end divides. Cells over several columns are in neither.

    tight: only the heads of the column can be broken into lines; where room is short, they are. weight: the root mean
    square of its cells' widths in points: how much of the room it needs for its rows to get about as high as others'.
    """

    widest: tuple[tuple[int, ...], ...]
    solid: tuple[tuple[int, ...], ...]
    tight: tuple[bool, ...]
    weight: tuple[float, ...]


def deciding(grid: Grid) -> Deciding:
    """The cells to be measured."""
    widest: list[list[tuple[int, Range, str]]] = [[] for _ in range(grid.columns)]
    solid: list[list[tuple[int, Range, str]]] = [[] for _ in range(grid.columns)]
    tight = [True] * grid.columns
    squares: list[list[float]] = [[] for _ in range(grid.columns)]
    for place, cell in enumerate(grid.cells):
        if cell.colspan == 1:
            whole, shape = extent(cell), _shape(cell)
            widest[cell.x].append((place, whole, shape))
            solid[cell.x].append((place, whole if unbroken(cell) else _longest(cell), shape))
            tight[cell.x] &= cell.head or unbroken(cell)
            if not cell.head:
                squares[cell.x].append(_written(cell) ** 2)
    weight = tuple(sqrt(fsum(column) / max(len(column), 1)) for column in squares)
    return Deciding(tuple(map(_near, widest)), tuple(map(_near, solid)), tuple(tight), weight)


def extent(cell: Cell) -> Range:
    """The width of a cell on one line in points: the least and the most by estimate, equal for text."""
    low, high = (ems + _letters(cell.pad) for ems in _ems(cell.children))
    size, mark = SIZE * (_BOLD if cell.head else 1), SIZE * bool(cell.mark)
    return size * low + mark, size * high + mark


def is_sentence(cell: Cell) -> bool:
    """Is a marked cell more than a verdict?"""
    return len(plain(cell.children)) > VERDICT


def unbroken(cell: Cell) -> bool:
    """Does the cell stay on one line: numbers, verdicts and a few letters? Sentences and heads do not."""
    if cell.head:
        return False
    return cell.align == "right" or len(plain(cell.children)) <= (VERDICT if cell.mark else SHORT)


def breakable_words(text: str) -> list[str]:
    """The pieces of a text between which a line may end."""
    return _WORDS.split(text)


def row_heights(grid: Grid) -> list[float]:
    """The heights of the rows on a page in points, by estimate: the columns share the room by what they hold."""
    needs = [_written(cell) for cell in grid.cells]
    widths = [0.0] * grid.columns
    for cell, need in zip(grid.cells, needs, strict=True):
        if cell.colspan == 1:
            widths[cell.x] = max(widths[cell.x], need + SIZE)
    share = min(1.0, TEXT_WIDTH / max(fsum(widths), 1.0))
    lines = [1] * grid.rows
    for cell, need in zip(grid.cells, needs, strict=True):
        room = fsum(widths[cell.x : cell.x + cell.colspan]) * share - SIZE
        lines[cell.y] = max(lines[cell.y], ceil(need / max(room, 4 * SIZE)))
    return [count * LINE + GAP for count in lines]


def _written(cell: Cell) -> float:
    """The width of a cell on one line, formulas as they are read."""
    return SIZE * _letters(plain(cell.children, "text"))


def _near(estimates: list[tuple[int, Range, str]]) -> tuple[int, ...]:
    """The places whose estimate may come near the largest, one of each shape."""
    least = NEAR * max((low for _, (low, _), _ in estimates), default=0.0)
    found: dict[str, int] = {}
    for place, (_, high), shape in estimates:
        if high >= least:
            found.setdefault(shape, place)
    return tuple(found.values())


def _longest(cell: Cell) -> Range:
    """The widest piece of a cell that may be broken into lines: a word or a formula."""
    texts = plain([node for node in cell.children if not isinstance(node, Math)])
    pieces = [(width, width) for width in map(_letters, breakable_words(texts))]
    pieces += [_ems([node]) for node in cell.children if isinstance(node, Math)]
    return SIZE * max(low for low, _ in pieces), SIZE * max(high for _, high in pieces)


def _ems(nodes: list[Inline]) -> Range:
    """The width in the size of the letters. A formula is known by the characters it is read as, roughly."""
    low = high = 0.0
    for node in nodes:
        match node:
            case Text(text):
                least = most = _letters(text)
            case Code(text):
                least = most = _FIXED * len(text)
            case Math():
                length = len(plain([node], "text"))
                least, most = 0.2 * length, 0.7 * length
            case Anchor():
                continue
            case Styled(_, inside):
                least, most = _ems(inside)
                most *= _BOLD
            case _:
                least, most = 0.0, inf
        low, high = low + least, high + most
    return low, high


def _letters(text: str) -> float:
    """The estimate for a text; `fsum` gives the same on every Python, which `sum` does not."""
    return fsum(_EM.get(letter, _USUAL) for letter in text)


def _shape(cell: Cell) -> str:
    """Equal for cells that are equally wide, whatever their digits: these are all equally wide."""
    kinds = "".join(type(node).__name__ for node in cell.children)
    return f"{cell.head} {cell.mark} {kinds} {re.sub('[0-9]', '0', plain(cell.children))}{cell.pad}"
