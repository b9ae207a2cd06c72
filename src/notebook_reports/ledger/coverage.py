"""What of the printed data is checked, and with which verdict: counted by document and by place.

    places = coverage(documents, records)
    whole = total(places)

Pure data: the printed documents and the harvested records in, numbers out.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from notebook_reports.ledger.files import natural
from notebook_reports.ledger.printed_data import PrintedDocument
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import CLAIM_VERDICTS, MISPRINT_VERDICTS, VALUE_VERDICTS

VERDICTS = {"value": VALUE_VERDICTS, "claim": CLAIM_VERDICTS, "misprint": MISPRINT_VERDICTS}


@dataclass(frozen=True)
class Count:
    """The entries of one place, one document ("" as place) or all ("" as document too).

    printed: number of entries by table. verdicts: number of records by table and verdict. unchecked: the ids by table
    of what is printed and no notebook checks.
    """

    document: str
    place: str
    printed: Mapping[str, int] = field(default_factory=Counter)
    verdicts: Mapping[tuple[str, str], int] = field(default_factory=Counter)
    unchecked: tuple[tuple[str, str], ...] = ()

    def of(self, table: str) -> list[tuple[str, int]]:
        """The verdicts of one table that were given, with their numbers, in the order of the ledger."""
        return [(v, self.verdicts[table, v]) for v in VERDICTS[table] if self.verdicts.get((table, v))]


def coverage(documents: Iterable[PrintedDocument], rows: Iterable[LedgerRow]) -> list[Count]:
    """One count for each place of each document, documents as they come, places as a person counts.

    A row of what no document prints is counted at its place.
    """
    printed: dict[tuple[str, str], Counter] = {}
    verdicts: dict[tuple[str, str], Counter] = {}
    open_: dict[tuple[str, str], dict[tuple[str, str, str], None]] = {}
    order = []
    for document in documents:
        order.append(document.id)
        for table, items in document.tables().items():
            for id, item in items.items():
                where = (document.id, item.place)
                printed.setdefault(where, Counter())[table] += 1
                open_.setdefault(where, {})[table, document.id, id] = None
    for row in rows:
        where = (row.document, row.place)
        verdicts.setdefault(where, Counter())[row.table, row.verdict] += 1
        open_.get(where, {}).pop(row.key, None)
    order += sorted({document for document, _ in verdicts} - set(order))
    places = sorted({**printed, **verdicts}, key=lambda w: (order.index(w[0]), natural(w[1])))
    return [
        Count(
            *where,
            printed.get(where, Counter()),
            verdicts.get(where, Counter()),
            tuple((table, id) for table, _, id in open_.get(where, ())),
        )
        for where in places
    ]


def total(counts: Iterable[Count], document: str = "") -> Count:
    """The sum over the places of one document, or of all."""
    chosen = [c for c in counts if document in ("", c.document)]
    printed: Counter = Counter()
    verdicts: Counter = Counter()
    for count in chosen:
        printed.update(count.printed)
        verdicts.update(count.verdicts)
    return Count(document, "", printed, verdicts, tuple(u for c in chosen for u in c.unchecked))


def by_document(counts: Iterable[Count]) -> list[Count]:
    """The sums of each document, in order."""
    counts = list(counts)
    return [total(counts, document) for document in dict.fromkeys(c.document for c in counts)]
