"""One row of the ledger: what a check decides, a notebook carries, a file keeps and a page shows."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from notebook_reports.ledger.verdicts import FAILING

_PLACE = ("document", "place", "id")
COLUMNS = {
    "value": (*_PLACE, "quantity", "printed", "unit", "kind", "exact", "from_inputs", "quoted", "first")
    + ("verdict", "reason", "notebook"),
    "claim": (*_PLACE, "says", "verdict", "evidence", "notebook"),
    "misprint": (*_PLACE, "kind", "printed", "corrected", "misleads", "verdict", "proof", "note", "notebook"),
}
"""The columns of each table's file."""

TABLES = tuple(COLUMNS)
_OWN = ("document", "place", "id", "verdict", "notebook")
_CARRIED = ("table", "document", "place", "id", "verdict", "fields")


@dataclass(frozen=True)
class LedgerRow:
    """One printed value, claim or misprint with its verdict.

    table: of `TABLES`. fields: the other columns by name. notebook, cell (position from 1), cell_id, section (the
    nearest heading above): where it was checked, known once the notebook has run.
    """

    table: str
    document: str
    place: str
    id: str
    verdict: str
    fields: Mapping[str, str]
    notebook: str = ""
    cell: int = 0
    cell_id: str = ""
    section: str = ""

    @property
    def key(self) -> tuple[str, str, str]:
        return (self.table, self.document, self.id)

    @property
    def fails(self) -> bool:
        return self.verdict in FAILING

    def data(self) -> dict[str, Any]:
        """All of it, for JSON."""
        return asdict(self)

    def carried(self) -> dict[str, Any]:
        """What a check puts into its output; where it stands is found there."""
        return {name: getattr(self, name) for name in _CARRIED}

    def columns(self) -> dict[str, str]:
        """The texts of its file's columns, each on one line."""
        own = {name: getattr(self, name) for name in _OWN}
        return {k: " ".join(str({**self.fields, **own}.get(k, "")).split()) for k in COLUMNS[self.table]}


def from_columns(table: str, columns: Mapping[str, str]) -> LedgerRow:
    """The row that a file holds.

    >>> kept = {"document": "a", "place": "Table 1", "id": "x", "verdict": "holds", "says": "it is", "notebook": "a/1"}
    >>> row = from_columns("claim", kept)
    >>> row.verdict, row.fields
    ('holds', {'says': 'it is'})
    """
    document, place, id, verdict, notebook = (columns.get(name, "") for name in _OWN)
    fields = {k: v for k, v in columns.items() if k not in _OWN}
    return LedgerRow(table, document, place, id, verdict, fields, notebook)


def of_table(rows: Iterable[LedgerRow], table: str) -> list[LedgerRow]:
    """The rows of one table."""
    return [row for row in rows if row.table == table]
