"""The cells of a logger's file: encoding, delimiter, decimal sign, head and rows, found from the text itself."""

import csv
import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from loopbook.records import clock
from loopbook.records.record import RecordError
from loopbook.records.states import state

UTF16 = (b"\xff\xfe", b"\xfe\xff")
DECIMAL = re.compile(r"[+-]?(?:\d+|\d{1,3}(?:[.,]\d{3})+)?([.,])\d+(?:[eE][+-]?\d+)?")
COMMENT = ("#", "%", "//")
WITH_UNIT = re.compile(r"([+-]?[\d.,]+(?:[eE][+-]?\d+)?)\s*([%‰]|[°µ]?[A-Za-z][A-Za-z/%²³]{0,7})")
THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:,\d{3})+(?:\.\d+)?")


@dataclass(frozen=True)
class Cells:
    """A file's table. heads: the text above each column. rows: of one width. decimal: its sign, "" where none is.

    notes: what was done to the rows, one sentence each.
    """

    heads: list[str]
    rows: list[list[str]]
    delimiter: str
    decimal: str
    notes: list[str] = field(default_factory=list)

    def column(self, i: int) -> list[str]:
        return [row[i] for row in self.rows]

    def numbers(self, i: int) -> np.ndarray:
        """A column's numbers, NaN where there is none. A column of on and off (open and closed) is 1 and 0."""
        texts = self.column(i)
        values = np.array([number(text, self.decimal == ",") for text in texts])
        if np.isnan(values).all():
            return np.array([state(text) for text in texts])
        return values

    def is_state(self, i: int) -> bool:
        """Is the column one of words such as on and off?"""
        texts = [text for text in self.column(i) if text]
        return bool(texts) and not any(np.isnan(state(text)) for text in texts)


def text_of(path: Path) -> str:
    """The file's text. Raises RecordError where there is no such file, or where it is no text."""
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise RecordError(f"there is no file {path}") from None
    except IsADirectoryError:
        raise RecordError(f"{path} is a folder; name a CSV file") from None
    if raw.startswith(UTF16):
        return raw.decode("utf-16", errors="replace")
    if b"\0" in raw[:4096]:
        raise RecordError(f"{path.name} is no text file; give CSV, .xlsx or Parquet")
    for encoding in ("utf-8-sig", "cp1252"):
        try:
            return raw.decode(encoding)
        except UnicodeDecodeError:
            continue
    return raw.decode("latin-1")


def cells_of(text: str, time_units: set[str]) -> Cells:
    """Head and rows of the text. A line of units below the head, known by its unit of time, is joined to it.

    A head may stand in a comment ("# t u y") and may be narrower or wider than the rows. Raises RecordError where
    there are no columns.
    """
    every = [line for line in text.splitlines() if line.strip()]
    is_comment = [line.lstrip().startswith(COMMENT) for line in every]
    lines = [line for line, aside in zip(every, is_comment, strict=True) if not aside]
    starts = next((i for i, line in enumerate(every) if line.lstrip(' "+-.')[:1].isdigit()), len(every))
    comments = [every[i].lstrip().lstrip("#%/ ") for i in range(starts) if is_comment[i]]
    if not lines:
        raise RecordError("the file is empty")
    delimiter = _delimiter(lines[:200])
    heads = split(comments, delimiter)
    widest = max(map(len, heads), default=0)
    return table(split(lines, delimiter), delimiter, time_units, [h for h in heads if len(h) == widest][-1:])


def split(lines: list[str], delimiter: str) -> list[list[str]]:
    if delimiter == " ":
        return [line.split() for line in lines]
    rows = csv.reader(lines, delimiter=delimiter, skipinitialspace=True)
    return [[cell.strip() for cell in row] for row in rows if any(row)]


def table(rows: list[list[str]], delimiter: str, time_units: set[str], comment: Sequence[list[str]] = ()) -> Cells:
    """Cells from rows of any width: where the data begins, the head above it, blank columns at the end left out."""
    scores = [sum(map(_is_value, row)) for row in rows]
    later = scores[len(scores) // 2 :]
    usual = max(set(later), key=later.count) if later else 0
    first = next((i for i, n in enumerate(scores) if n >= max(1, usual - 1)), 0)
    head = rows[first - 1] if first else comment[0] if comment else []
    body = rows[first:]
    widths = [_width(row) for row in body]
    width = max((w for w in set(widths) if widths.count(w) > len(widths) / 20), default=0)
    kept = [(row + [""] * width)[:width] for row, w in zip(body, widths, strict=True) if 2 <= w <= width]
    notes = [f"{len(body) - len(kept)} lines have another number of cells than the others and were left out."]
    notes = notes if len(kept) < len(body) else []
    if first and not head_is_words(head) and comment and len(comment[0]) >= width:
        head = comment[0]
    head = _fitted(head, kept, width)
    bare = [h.strip("[]() ") for h in head]
    if first > 1 and any(unit.lower() in time_units for unit in bare):
        above = _fitted(rows[first - 2], kept, width)
        head = [f"{name} [{unit}]" if unit else name for name, unit in zip(above, bare, strict=True)]
    head, kept = _units_in_cells(head, kept)
    return Cells(head, kept, delimiter, _decimal(kept[:200]), notes)


def _units_in_cells(head: list[str], rows: list[list[str]]) -> tuple[list[str], list[list[str]]]:
    """Where every cell of a column carries the same unit ("21.5 °C"), the unit goes into the head."""
    for i in range(len(head)):
        found = [WITH_UNIT.fullmatch(row[i]) for row in rows if row[i]]
        units = {match[2] for match in found if match}
        if len(units) == 1 and all(found):
            rows = [[*row[:i], WITH_UNIT.sub(r"\1", row[i]), *row[i + 1 :]] for row in rows]
            unit = units.pop()
            head = [*head[:i], head[i] if re.search(r"[\[(]", head[i]) else f"{head[i]} [{unit}]", *head[i + 1 :]]
    return head, rows


def head_is_words(head: list[str]) -> bool:
    return any(any(c.isalpha() for c in cell) for cell in head)


def _width(row: list[str]) -> int:
    """How many cells, the blank ones at the end not counted."""
    return max((i + 1 for i, cell in enumerate(row) if cell), default=0)


def _is_value(cell: str) -> bool:
    """A number, a time stamp or a state: something that stands in data and not in a head."""
    if not cell:
        return False
    if not np.isnan(number(cell, True)) or not np.isnan(state(cell)) or WITH_UNIT.fullmatch(cell):
        return True
    return bool(cell[0].isdigit() and (clock.TIME_OF_DAY.fullmatch(cell) or clock.STAMP.fullmatch(cell)))


def _fitted(head: list[str], rows: list[list[str]], width: int) -> list[str]:
    """A head as wide as the rows: blanks at its end go first; a missing name is that of a row counter in front."""
    if not head:
        return [f"column {i + 1}" for i in range(width)]
    head = head[: max(_width(head), min(len(head), width))]
    if len(head) > width and not head[0]:
        head = head[1:]
    missing = width - len(head)
    if missing == 1 and _counts([row[0] for row in rows]):
        return ["", *head]
    return (head + [f"column {i + 1}" for i in range(len(head), width)])[:width]


def _counts(texts: list[str]) -> bool:
    """Do the cells count 0, 1, 2... or 1, 2, 3...?"""
    values = [text.strip('"') for text in texts[:50]]
    if not all(v.isdigit() for v in values):
        return False
    return all(int(b) - int(a) == 1 for a, b in itertools.pairwise(values))


def _delimiter(lines: list[str]) -> str:
    """The sign that splits the most lines into the same number, at least two, of fields."""
    best = (0, 0, "")
    for sign in (";", "\t", ",", "|"):
        widths = [len(row) for row in csv.reader(lines, delimiter=sign) if row]
        if widths:
            usual = max(set(widths), key=widths.count)
            if usual > 1:
                best = max(best, (widths.count(usual), 1 if sign in ";\t" else 0, sign))
    if not best[2]:
        blanks = [len(line.split()) for line in lines]
        if blanks and max(blanks) > 1:
            return " "
        raise RecordError("no columns found; write one sample per line with columns separated by , ; or tab")
    return best[2]


def _decimal(rows: list[list[str]]) -> str:
    """The decimal sign: the last sign of a number. A comma, unless numbers with a point show it to group thousands."""
    found = [(c, match[1]) for row in rows for c in row if (match := DECIMAL.fullmatch(c))]
    signs = {sign for _, sign in found}
    grouped = any(sign == "," and "." in c for c, sign in found)
    return "," if "," in signs and (grouped or "." not in signs) else "." if signs else ""


def number(text: str, comma: bool) -> float:
    """A number, NaN where it is none. comma: the comma is the decimal sign and a point groups thousands.

    >>> number("1.234,5", True), number("-2.5", True), number("1,234.5", False), number("ten", False)
    (1234.5, -2.5, 1234.5, nan)
    """
    text = text.strip().replace("−", "-")
    if comma and "," in text:
        text = text.replace(".", "").replace(",", ".")
    elif THOUSANDS.fullmatch(text):
        text = text.replace(",", "")
    try:
        return float(text) if text and "_" not in text else float("nan")
    except ValueError:
        return float("nan")
