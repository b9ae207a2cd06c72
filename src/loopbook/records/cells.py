"""The cells of a logger's file: encoding, delimiter, decimal sign, head and rows, found from the text itself."""

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from loopbook.records.record import RecordError

UTF16 = (b"\xff\xfe", b"\xfe\xff")
DECIMAL = re.compile(r"[+-]?(?:\d+|\d{1,3}(?:[.,]\d{3})+)?([.,])\d+(?:[eE][+-]?\d+)?")
THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:,\d{3})+(?:\.\d+)?")


@dataclass(frozen=True)
class Cells:
    """A file's table. heads: the text above each column. rows: of one width. decimal: its sign, "" where none is."""

    heads: list[str]
    rows: list[list[str]]
    delimiter: str
    decimal: str

    def column(self, i: int) -> list[str]:
        return [row[i] for row in self.rows]

    def numbers(self, i: int) -> np.ndarray:
        """A column's numbers, NaN where there is none."""
        return np.array([number(text, self.decimal == ",") for text in self.column(i)])


def text_of(path: Path) -> str:
    """The file's text. Raises RecordError where there is no such file."""
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise RecordError(f"there is no file {path}") from None
    except IsADirectoryError:
        raise RecordError(f"{path} is a folder; name a CSV file") from None
    for encoding in ("utf-16",) if raw.startswith(UTF16) else ("utf-8-sig", "cp1252"):
        try:
            return raw.decode(encoding)
        except UnicodeDecodeError:
            continue
    return raw.decode("latin-1")


def cells_of(text: str, time_units: set[str]) -> Cells:
    """Head and rows of the text. A line of units below the head, known by its unit of time, is joined to it.

    Raises RecordError where there are no columns.
    """
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith(("#", "%"))]
    if not lines:
        raise RecordError("the file is empty")
    delimiter = _delimiter(lines[:200])
    if delimiter == " ":
        rows = [line.split() for line in lines]
    else:
        rows = [row for row in csv.reader(lines, delimiter=delimiter, skipinitialspace=True) if any(row)]
    width = max(len(row) for row in rows[len(rows) // 2 :])
    rows = [[cell.strip() for cell in row] for row in rows if len(row) == width]
    numeric = [sum(not np.isnan(number(c, True)) for c in row) for row in rows]
    first = next((i for i, n in enumerate(numeric) if n >= max(1, max(numeric) - 1)), 0)
    head = rows[first - 1] if first else [f"column {i + 1}" for i in range(width)]
    bare = [h.strip("[]() ") for h in head]
    if first > 1 and any(unit.lower() in time_units for unit in bare):
        head = [f"{name} [{unit}]" for name, unit in zip(rows[first - 2], bare, strict=True)]
    return Cells(head, rows[first:], delimiter, _decimal(rows[first : first + 200]))


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
        return float(text)
    except ValueError:
        return float("nan")


def name_and_unit(head: str) -> tuple[str, str]:
    """Split "Time [s]", "temp (°C)" or "u / V" into name and unit."""
    found = re.fullmatch(r"\s*(.*?)\s*(?:\[\s*(.*?)\s*\]|\(\s*(.*?)\s*\)|/\s*(\S+))?\s*", head)
    return found[1], next((g for g in found.groups()[1:] if g), "")
