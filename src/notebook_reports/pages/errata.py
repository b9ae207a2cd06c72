"""What the documents got wrong, what would mislead first: misprints, misprinted numbers, statements that fail."""

from collections.abc import Iterable
from dataclasses import dataclass

from notebook_reports.ledger.files import NUMBERS, natural
from notebook_reports.ledger.printed_data import MISPRINT_KINDS
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import FAILS, MISPRINT

NUMBER, STATEMENT = "number", "statement"
KINDS = (NUMBER, *MISPRINT_KINDS, STATEMENT)
MISLEADS, FALSE, HARMLESS = GROUPS = ("misleads", "false", "harmless")


@dataclass(frozen=True)
class Erratum:
    """One thing that is wrong. kind: of `KINDS`. group: of `GROUPS`. found: the record that shows it."""

    kind: str
    group: str
    printed: str
    corrected: str
    note: str
    found: LedgerRow

    @property
    def rank(self) -> tuple:
        """Whoever uses a formula needs the first ones first; then by kind and place."""
        return KINDS.index(self.kind), natural(self.found.place), natural(self.found.id)


def errata(records: Iterable[LedgerRow]) -> list[Erratum]:
    """The errata among the records: those that mislead first, then by document as the records come, kind and place.

    A wrong formula, code line or number misleads whoever computes with it; a statement that fails is false; the rest
    (a label, a unit, a word) is harmless.
    """
    records = list(records)
    documents = list(dict.fromkeys(r.document for r in records))
    errata = (e for e in map(_erratum, records) if e)
    return sorted(errata, key=lambda e: (GROUPS.index(e.group), documents.index(e.found.document), e.rank))


def _erratum(found: LedgerRow) -> Erratum | None:
    fields = found.fields
    if found.table == "misprint" and not found.fails:
        group = MISLEADS if fields["misleads"] == "yes" else HARMLESS
        return Erratum(fields["kind"], group, fields["printed"], fields["corrected"], fields["note"], found)
    if found.table == "value" and found.verdict == MISPRINT:
        right = next(fields[name] for name in NUMBERS if fields.get(name))
        return Erratum(NUMBER, MISLEADS, fields["printed"], right, fields["reason"], found)
    if found.table == "claim" and found.verdict == FAILS:
        return Erratum(STATEMENT, FALSE, fields["says"], "", fields["evidence"], found)
    return None
