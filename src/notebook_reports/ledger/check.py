"""`loopbook check`: the ledger as it stands in reports/, in a terminal or as data."""

import csv
import difflib
import io
import json
import shutil
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from notebook_reports.ledger import files as ledger_files
from notebook_reports.ledger.row import TABLES, LedgerRow, of_table
from notebook_reports.ledger.verdicts import (
    CLAIM_VERDICTS,
    GIVEN,
    HOLDS,
    MISPRINT_VERDICTS,
    QUOTED,
    READ,
    REPEATED,
    REPRODUCED,
    ROUNDED,
    VALUE_VERDICTS,
)
from notebook_reports.project.project import Project, UsageError

ORDER = {"value": VALUE_VERDICTS, "claim": CLAIM_VERDICTS, "misprint": MISPRINT_VERDICTS}
GOOD = {GIVEN, REPEATED, REPRODUCED, ROUNDED, QUOTED, READ, HOLDS}


@dataclass(frozen=True)
class Ledger:
    """The rows of the three files, in their order."""

    rows: list[LedgerRow]

    @property
    def failing(self) -> list[LedgerRow]:
        return [r for r in self.rows if r.fails]

    def of(self, document: str = "", place: str = "") -> "Ledger":
        """The rows of one document, or of one place in it. Raises UsageError where there is none."""
        rows = self.rows
        for key, wanted in (("document", document), ("place", place)):
            if not wanted:
                continue
            known = list(dict.fromkeys(getattr(r, key) for r in rows))
            rows = [r for r in rows if getattr(r, key).casefold() == wanted.casefold()]
            if not rows:
                near = difflib.get_close_matches(wanted, known, n=4, cutoff=0.4) or known[:6]
                raise UsageError(f"the ledger has no {key} {wanted!r}; there is {', '.join(near)}")
        return Ledger(rows)


def read_ledger(project: Project) -> Ledger:
    """Read reports/*.csv. Raises UsageError where there is no ledger yet."""
    rows = []
    for table, name in ledger_files.FILES.items():
        rows += ledger_files.read(project.reports / name, table)
    if not rows:
        raise UsageError(f"no ledger in {project.reports}; `loopbook build` writes it")
    return Ledger(rows)


def as_text(ledger: Ledger, whole: bool, width: int | None = None) -> str:
    """A summary in at most twenty lines, then every row that is not reproduced; where asked, the whole as a table.

    width: where lines are cut; default that of the terminal, and not at all where the output goes elsewhere.
    """
    if width is None and sys.stdout.isatty():
        width = shutil.get_terminal_size((120, 24)).columns
    lines = summary_lines(ledger)
    if whole:
        values = of_table(ledger.rows, "value")
        others = [_row_line(r) for r in ledger.rows if r.table != "value"]
        for block in (_table(values) if values else [], others):
            lines += ["", *block] if block else []
    elif shown := [r for r in ledger.rows if r.verdict not in GOOD]:
        lines += ["", "every row that is not reproduced, or does not hold:"]
        lines += [_row_line(r) for r in shown]
    return "\n".join(line[:width].rstrip() for line in lines)


def _table(rows: Sequence[LedgerRow]) -> list[str]:
    """Values in columns; one that no row fills is left out."""
    heads = ["quantity", "printed", "exact", "from rounded inputs", "source", "first print", "verdict", "why"]
    cells = [
        [c["quantity"], f"{c['printed']} {c['unit']}".rstrip()]
        + [_short(c[name]) for name in ledger_files.NUMBERS]
        + [c["verdict"], c["reason"]]
        for c in (row.columns() for row in rows)
    ]
    columns = [c for c in zip(heads, *cells, strict=True) if any(c[1:])]
    widths = [max(map(len, column)) for column in columns]
    return ["  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)) for row in zip(*columns, strict=True)]


def summary_lines(ledger: Ledger) -> list[str]:
    """Numbers by document and verdict."""
    documents = list(dict.fromkeys(r.document for r in ledger.rows))
    counts = Counter((r.table, r.verdict, r.document) for r in ledger.rows)
    heads = [*documents, "all"] if len(documents) > 1 else documents
    lines = [f"{'':32}" + "".join(f"{h:>14}" for h in heads)]
    for table, verdicts in ORDER.items():
        for verdict in verdicts:
            numbers = [counts[table, verdict, d] for d in documents]
            if any(numbers):
                cells = [*numbers, sum(numbers)] if len(documents) > 1 else numbers
                lines.append(f"{table + 's':10}{verdict:22}" + "".join(f"{n:14}" for n in cells))
    return lines


def _row_line(row: LedgerRow) -> str:
    where, c = f"{row.document}, {row.place}", row.columns()
    if row.table == "value":
        what = f"{c['quantity']} = {c['printed']} {c['unit']}".rstrip()
        got = f"; computed {_short(c['exact'])}" if c["exact"] else ""
        got += f"; from rounded inputs {_short(c['from_inputs'])}" if c["from_inputs"] else ""
        why = f": {c['reason']}" if c["reason"] else ""
        return f"{row.verdict:19} {where}: {what}{got}{why}"
    if row.table == "claim":
        return f"{row.verdict:19} {where}: {c['says']}: {c['evidence']}"
    return f"{'misprint, ' + row.verdict:19} {where}: {c['printed']} -> {c['corrected']}: {c['note']}"


def _short(number: str) -> str:
    try:
        return f"{float(number):.6g}"
    except ValueError:
        return number


def as_json(ledger: Ledger) -> str:
    """All rows, each with its table."""
    return json.dumps(_with_table(ledger.rows), ensure_ascii=False, indent=1)


def as_csv(ledger: Ledger) -> str:
    """All rows under the columns of the tables they come from."""
    rows = _with_table(ledger.rows)
    out = io.StringIO()
    writer = csv.DictWriter(out, list(dict.fromkeys(k for row in rows for k in row)), lineterminator="\n", restval="")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue().rstrip("\n")


def as_markdown(ledger: Ledger) -> str:
    """One table for each kind of entry."""
    blocks = []
    for table in TABLES:
        rows = [row.columns() for row in of_table(ledger.rows, table)]
        if rows:
            head = ["| " + " | ".join(rows[0]) + " |", "|" + "---|" * len(rows[0])]
            body = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row.values()) + " |" for row in rows]
            blocks.append("\n".join([*head, *body]))
    return "\n\n".join(blocks)


def _with_table(rows: Sequence[LedgerRow]) -> list[dict[str, str]]:
    return [{"table": row.table, **row.columns()} for row in rows]
