"""The ledger's files: ledger.csv, claims.csv and misprints.csv, sorted, stable, reviewed, and so kept in git.

A build compares what it found with what the files say. New rows are added. A row that went, a verdict or a printed
digit that changed is *moved*: a person must accept it. Everything else that changed is written and shows in review.
A computed number that differs by less than one part in 10^9 is the same number on another machine: it is left.
"""

import csv
import io
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from notebook_reports.ledger.harvest import Found

FILES = {"value": "ledger.csv", "claim": "claims.csv", "misprint": "misprints.csv"}
COLUMNS = {
    "value": [
        "document",
        "place",
        "id",
        "quantity",
        "printed",
        "unit",
        "kind",
        "exact",
        "from_inputs",
        "verdict",
        "reason",
        "notebook",
    ],
    "claim": ["document", "place", "id", "says", "verdict", "evidence", "notebook"],
    "misprint": ["document", "place", "id", "kind", "printed", "corrected", "misleads", "verdict", "note", "notebook"],
}
GUARDED = ("printed", "verdict")
NUMBERS = ("exact", "from_inputs")
SAME = 1e-9
Row = dict[str, str]


@dataclass(frozen=True)
class Change:
    """One row that is not as the file has it. moved: it needs acceptance."""

    table: str
    row: Row
    what: str
    moved: bool

    @property
    def line(self) -> str:
        return f"{self.row['document']}, {self.row['place']}, {self.row['id']}: {self.what}"


def rows(found: Iterable[Found], table: str) -> list[Row]:
    """The rows of one file, sorted."""
    made = []
    for record in found:
        if record.table == table:
            own = {k: getattr(record, k) for k in ("document", "place", "id", "verdict", "notebook")}
            made.append({k: _one_line(str({**record.fields, **own}.get(k, ""))) for k in COLUMNS[table]})
    return sorted(made, key=_order)


def read(path: Path) -> list[Row]:
    """The rows of a file; none where there is no file."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return [{k: v or "" for k, v in row.items()} for row in csv.DictReader(file)]


def render(table: str, content: Iterable[Row]) -> bytes:
    """The bytes of a file."""
    out = io.StringIO()
    writer = csv.DictWriter(out, COLUMNS[table], lineterminator="\n", extrasaction="ignore")
    writer.writeheader()
    writer.writerows(content)
    return out.getvalue().encode()


def compare(table: str, old: list[Row], new: list[Row]) -> tuple[list[Row], list[Change]]:
    """(the rows to write, what changed). A row keeps its old numbers where they are the same up to rounding."""
    before = {_key(r): r for r in old}
    changes, kept = [], []
    for row in new:
        was = before.pop(_key(row), None)
        if was is None:
            changes.append(Change(table, row, f"new, {row['verdict']}", moved=False))
            kept.append(row)
            continue
        row = {k: was[k] if k in NUMBERS and _same(was.get(k, ""), v) else v for k, v in row.items()}
        kept.append(row)
        different = [k for k in COLUMNS[table] if row[k] != was.get(k, "")]
        guarded = [k for k in different if k in GUARDED]
        if different:
            shown = guarded or different
            what = ", ".join(f"{k} {_cut(was.get(k, ''))} -> {_cut(row[k])}" for k in shown)
            changes.append(Change(table, row, what, moved=bool(guarded)))
    changes += [Change(table, row, f"gone, was {row['verdict']}", moved=True) for row in before.values()]
    return kept, changes


def merge(old: list[Row], new: list[Row], notebooks: Iterable[str]) -> list[Row]:
    """The old rows with those of some notebooks replaced: for a build of a part."""
    built = set(notebooks)
    fresh = {_key(r) for r in new}
    return sorted([*(r for r in old if r["notebook"] not in built and _key(r) not in fresh), *new], key=_order)


def keep(old: list[Row], new: list[Row], failing: Iterable[Found]) -> list[Row]:
    """The new rows, and for each record that fails the row that the file has, if any."""
    keys = {(r.document, r.id) for r in failing} - {_key(r) for r in new}
    return sorted([*new, *(r for r in old if _key(r) in keys)], key=_order)


def _key(row: Mapping[str, str]) -> tuple[str, str]:
    return (row["document"], row["id"])


def _order(row: Row) -> tuple:
    return (row["document"], natural(row["place"]), natural(row["id"]))


def natural(text: str) -> list[tuple[int, int, str]]:
    """A sort key that puts Table 2 before Table 10."""
    return [(0, int(p), "") if p.isdigit() else (1, 0, p) for p in re.split(r"(\d+)", text) if p]


def _same(a: str, b: str) -> bool:
    if a == b:
        return True
    try:
        x, y = float(a), float(b)
    except ValueError:
        return False
    return abs(x - y) <= SAME * max(abs(x), abs(y))


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _cut(text: str, width: int = 60) -> str:
    return (text if len(text) <= width else text[: width - 1] + "…") or "(nothing)"
