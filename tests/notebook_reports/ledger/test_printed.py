"""Every printed value, claim and misprint: one test each, named after document, place and quantity.

The records come from the notebooks themselves, built once where something changed since the last build.
"""

from functools import cache
from pathlib import Path

import pytest

from loopbook.documents.open import names, printed
from notebook_reports.ledger.verdicts import FAILING
from notebook_reports.memory.manifest import manifest
from notebook_reports.project.project import project_at

pytestmark = pytest.mark.builds

PROJECT = project_at(Path(__file__).parents[3])


def entries():
    for document in map(printed, names()):
        for table, items in (("value", document.values), ("claim", document.claims), ("misprint", document.misprints)):
            for item in items.values():
                quantity = getattr(item, "quantity", "")
                name = "-".join(filter(None, [document.id, item.place, table if table != "value" else "", quantity]))
                yield pytest.param(table, document.id, item.id, id=f"{name} ({item.id})")


@cache
def found() -> dict:
    records: dict = {}
    for entry in manifest(PROJECT):
        for record in entry["records"]:
            records.setdefault((record["table"], record["document"], record["id"]), []).append(record)
    return records


@pytest.mark.parametrize(("table", "document", "id"), list(entries()))
def test_is_checked_once_and_holds_what_the_ledger_says(outcome, table, document, id):
    records = found().get((table, document, id), [])
    broken = [f.line for f in outcome.failures if f.kind == "notebook"]
    assert records, "no notebook checks it" + "".join(f"\n{line}" for line in broken[:5])
    where = [f"{r['notebook']}, cell {r['cell']}" for r in records]
    assert len(records) == 1, f"checked in {' and in '.join(where)}"
    (record,) = records
    assert record["verdict"] not in FAILING, f"{where[0]}: {record['fields']}"


def test_every_notebook_runs(outcome):
    broken = [f.line for f in outcome.failures if f.kind == "notebook"]
    assert not broken, "\n".join(broken)
