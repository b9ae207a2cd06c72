"""What the documents got wrong, what would mislead first: misprints, misprinted numbers, statements that fail."""

from collections.abc import Iterable
from dataclasses import dataclass

from loopbook.ledger import FAILS, MISPRINT
from loopbook.pipeline.harvest import Found
from loopbook.pipeline.ledger_files import natural
from loopbook.printed import DOCUMENTS, MISPRINT_KINDS

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
    found: Found

    @property
    def rank(self) -> tuple:
        """Whoever uses a formula needs the first ones first; then by document, kind and place."""
        known = {document: n for n, document in enumerate(DOCUMENTS)}
        document = known.get(self.found.document, len(known)), self.found.document
        place = natural(self.found.place), natural(self.found.id)
        return GROUPS.index(self.group), document, KINDS.index(self.kind), place


def errata(records: Iterable[Found]) -> list[Erratum]:
    """The errata among the records, in their order.

    A wrong formula, code line or number misleads whoever computes with it; a statement that fails is false; the rest
    (a label, a unit, a word) is harmless.
    """
    return sorted((e for e in map(_erratum, records) if e), key=lambda e: e.rank)


def _erratum(found: Found) -> Erratum | None:
    fields = found.fields
    if found.table == "misprint" and not found.fails:
        group = MISLEADS if fields["misleads"] == "yes" else HARMLESS
        return Erratum(fields["kind"], group, fields["printed"], fields["corrected"], fields["note"], found)
    if found.table == "value" and found.verdict == MISPRINT:
        right = fields["exact"] or fields["from_inputs"]
        return Erratum(NUMBER, MISLEADS, fields["printed"], right, fields["reason"], found)
    if found.table == "claim" and found.verdict == FAILS:
        return Erratum(STATEMENT, FALSE, fields["says"], "", fields["evidence"], found)
    return None
