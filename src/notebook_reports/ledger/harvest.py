"""Collect the records that checks left in executed notebooks: none may fail, none be missing, none stand twice."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from notebook_reports.ledger.printed_data import PrintedDocument
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import CHECKS_MIME
from notebook_reports.project.failures import Failure
from notebook_reports.project.source import INJECTED


def records(content: Mapping[str, Any], notebook: str) -> list[LedgerRow]:
    """The records of an executed notebook, in the order of its cells."""
    found, number, section = [], 0, ""
    for cell in content["cells"]:
        number += INJECTED not in cell["metadata"].get("tags", ())
        if cell["cell_type"] == "markdown":
            headings = re.findall(r"^#{1,3} +(.+?)\s*#*\s*$", cell["source"], re.MULTILINE)
            section = headings[-1] if headings else section
        for output in cell.get("outputs", ()):
            for record in output.get("data", {}).get(CHECKS_MIME, ()):
                found.append(
                    LedgerRow(**record, notebook=notebook, cell=number, cell_id=cell.get("id", ""), section=section)
                )
    return found


def failing(found: Iterable[LedgerRow]) -> list[Failure]:
    """A failure for each record whose verdict fails a build."""
    return [_failure(r) for r in found if r.fails]


def repeated(found: Iterable[LedgerRow]) -> list[Failure]:
    """A failure for each printed thing that was checked more than once."""
    by_key: dict[tuple, list[LedgerRow]] = {}
    for record in found:
        by_key.setdefault(record.key, []).append(record)
    return [
        Failure(
            first.notebook,
            f"{first.document}, {first.place}: {first.table} {first.id} is checked again in "
            + " and ".join(f"{r.notebook}, cell {r.cell}" for r in rest),
            first.cell,
            ("one check per printed thing: use `only=` where a place is spread over notebooks",),
            f"loopbook build {first.notebook}",
            "check",
        )
        for first, *rest in by_key.values()
        if rest
    ]


def missing(found: Iterable[LedgerRow], documents: Iterable[PrintedDocument], few: int = 4) -> list[Failure]:
    """What is printed and no notebook checks: a failure for each place, or where they are many for each document."""
    seen = {r.key for r in found}
    failures = []
    for document in documents:
        lines, number = [], 0
        for table, items in document.tables().items():
            places: dict[str, list[str]] = {}
            for id, item in items.items():
                if (table, document.id, id) not in seen:
                    places.setdefault(item.place, []).append(id)
                    number += 1
            lines += [f"{place}: no notebook checks {table} {', '.join(ids)}" for place, ids in places.items()]
        if len(lines) <= few:
            failures += [Failure("", f"{document.id}, {line}", kind="check") for line in lines]
        else:
            what = f"{document.id}: no notebook checks {number} printed entries at {len(lines)} places"
            failures.append(Failure("", what, more=tuple(lines), kind="check"))
    return failures


def _failure(record: LedgerRow) -> Failure:
    fields = record.fields
    what = f"{record.document}, {record.place}"
    if record.table == "value":
        found = [fields[name] for name in ("exact", "from_inputs", "quoted", "first") if fields.get(name)]
        computed = found[0] if found else "nothing"
        what += (
            f", {fields['quantity']} ({record.id}): document prints {fields['printed']}, computed {_short(computed)}"
        )
        more = []
        if fields.get("exact") and fields.get("from_inputs"):
            more.append(f"from the document's own rounded inputs: {_short(fields['from_inputs'])}")
        more.append("correct the digits or the computation; a reason needs a number or an interval that bears it out")
    elif record.table == "misprint":
        what += f", misprint {record.id}: {record.verdict}"
        more = [f"printed {fields.get('printed', '')}; correct {fields.get('corrected', '')}"]
    else:
        what += f", claim {record.id}: {record.verdict}"
        more = [fields.get("evidence", "")]
    repeat = f"loopbook build {record.notebook}"
    return Failure(record.notebook, what, record.cell, tuple(more), repeat, "check")


def _short(text: str) -> str:
    try:
        return f"{float(text):.8g}"
    except ValueError:
        return text
