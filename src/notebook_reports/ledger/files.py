"""The ledger's files: ledger.csv, claims.csv and misprints.csv, sorted, stable, reviewed, and so kept in git.

A build compares what it found with what the files say. New rows are added. A row that went, a verdict or a printed
digit that changed is *moved*: a person must accept it. Everything else that changed is written and shows in review.
A computed number that differs by less than one part in 10^9 is the same number on another machine: it is left.
"""

import csv
import io
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from notebook_reports.ledger.row import COLUMNS, LedgerRow, from_columns

FILES = {"value": "ledger.csv", "claim": "claims.csv", "misprint": "misprints.csv"}
GUARDED = ("printed", "verdict")
NUMBERS = ("exact", "from_inputs", "quoted", "first")
SAME = 1e-9


@dataclass(frozen=True)
class Change:
    """One row that is not as the file has it. moved: it needs acceptance."""

    table: str
    row: LedgerRow
    what: str
    moved: bool

    @property
    def line(self) -> str:
        return f"{self.row.document}, {self.row.place}, {self.row.id}: {self.what}"


def read(path: Path, table: str) -> list[LedgerRow]:
    """The rows of a file; none where there is no file."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return [from_columns(table, {k: v or "" for k, v in row.items()}) for row in csv.DictReader(file)]


def render(table: str, content: Iterable[LedgerRow]) -> bytes:
    """The bytes of a file."""
    out = io.StringIO()
    writer = csv.DictWriter(out, COLUMNS[table], lineterminator="\n")
    writer.writeheader()
    writer.writerows(row.columns() for row in content)
    return out.getvalue().encode()


def compare(table: str, old: list[LedgerRow], new: list[LedgerRow]) -> tuple[list[LedgerRow], list[Change]]:
    """(the rows to write, what changed). A row keeps its old numbers where they are the same up to rounding."""
    before = {row.key: row for row in old}
    changes, kept = [], []
    for row in sorted(new, key=_order):
        was = before.pop(row.key, None)
        if was is None:
            changes.append(Change(table, row, f"new, {row.verdict}", moved=False))
            kept.append(row)
            continue
        there, now = was.columns(), row.columns()
        same = {k: there[k] for k in NUMBERS if now.get(k) and _same(there[k], now[k])}
        kept.append(replace(row, fields={**row.fields, **same}))
        different = [k for k in COLUMNS[table] if {**now, **same}[k] != there[k]]
        guarded = [k for k in different if k in GUARDED]
        if different:
            shown = guarded or different
            what = ", ".join(f"{k} {_cut(there[k])} -> {_cut(now[k])}" for k in shown)
            changes.append(Change(table, row, what, moved=bool(guarded)))
    changes += [Change(table, row, f"gone, was {row.verdict}", moved=True) for row in before.values()]
    return kept, changes


def merge(old: list[LedgerRow], new: list[LedgerRow], notebooks: Iterable[str]) -> list[LedgerRow]:
    """The old rows with those of some notebooks replaced: for a build of a part."""
    built, fresh = set(notebooks), {row.key for row in new}
    return [*(row for row in old if row.notebook not in built and row.key not in fresh), *new]


def keep(old: list[LedgerRow], new: list[LedgerRow], failing: Iterable[LedgerRow]) -> list[LedgerRow]:
    """The new rows, and for each that fails the row that the file has, if any."""
    keys = {row.key for row in failing} - {row.key for row in new}
    return [*new, *(row for row in old if row.key in keys)]


def _order(row: LedgerRow) -> tuple[str, list[tuple[int, int, str]], list[tuple[int, int, str]]]:
    return (row.document, natural(row.place), natural(row.id))


def natural(text: str) -> list[tuple[int, int, str]]:
    """A sort key that puts Table 2 before Table 10."""
    return [(0, int(p), "") if p.isdigit() else (1, 0, p) for p in re.split(r"(\d+)", text) if p]


def _same(a: str, b: str) -> bool:
    if a == b or any(len(x) > 16 and x.lstrip("-").isdigit() for x in (a, b)):  # integers beyond floats are exact
        return a == b
    try:
        x, y = float(a), float(b)
    except ValueError:
        return False
    return abs(x - y) <= SAME * max(abs(x), abs(y))


def _cut(text: str, width: int = 60) -> str:
    return (text if len(text) <= width else text[: width - 1] + "…") or "(nothing)"
