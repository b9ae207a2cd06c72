"""One printed value beside what was computed: its verdict, its row of the ledger, its line in a table."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

from notebook_reports.display import Table, number
from notebook_reports.ledger.printed_data import Value
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import (
    DIFFERS,
    MARKS,
    MISPRINT,
    QUOTED,
    READ,
    REPEATED,
    Computed,
    exactly,
    value_verdict,
)

_NUMBERS = ("exact", "from inputs", "source", "first print")


@dataclass(frozen=True)
class Compared:
    """A printed value with the numbers that stand against it. first: the value that it repeats, if any."""

    value: Value
    found: Computed
    first: Value | None = None

    @property
    def verdict(self) -> str:
        return value_verdict(self.value, self.found)

    @property
    def reason(self) -> str:
        """Why the print is not simply reproduced, where that is so."""
        if self.verdict == QUOTED:
            return f"as in {self.value.source}"
        if self.verdict == REPEATED and self.first:
            return f"as at {self.first.place}, {self.first.quantity}"
        return self.value.reason if self.verdict in (READ, MISPRINT, DIFFERS) else ""

    @property
    def said_in_note(self) -> str:
        """The reason as a note below the table says it: a quantity of the same name is not named again."""
        if self.verdict == REPEATED and self.first and self.first.quantity == self.value.quantity:
            return f"as at {self.first.place}"
        return self.reason

    @property
    def shown(self) -> list[str]:
        """The computed numbers as they stand beside the print."""
        return [_beside(x, self.value.printed) for x in self.found.numbers]

    def row(self) -> LedgerRow:
        """The row of the ledger, computed numbers at full precision."""
        fields = {
            "quantity": self.value.quantity,
            "printed": self.value.printed,
            "unit": self.value.unit,
            "kind": self.value.kind,
            **{name: _full(getattr(self.found, name)) for name in ("exact", "from_inputs", "quoted", "first")},
            "reason": self.reason,
        }
        return LedgerRow("value", self.value.document, self.value.place, self.value.id, self.verdict, fields)


def verdict_table(compared: Sequence[Compared], caption: str) -> Table:
    """Printed and computed with the verdict, a line a value; a column that no line fills is left out."""
    lines = [[c.value.quantity, _grouped(c.value.printed), *c.shown, c.value.unit, c.verdict] for c in compared]
    heads = ["quantity", "printed", *_NUMBERS, "unit", "verdict"]
    long = any(" " in cell for line in lines for cell in line[1:6])  # digits in groups: let them wrap
    align = ["left", *["left" if long else "right"] * 5, "left", "left"]
    return _filled(heads, align, lines, caption, _notes(compared), [MARKS[c.verdict] for c in compared])


def _notes(compared: Sequence[Compared]) -> list[str]:
    """The reasons, each once, with what they are of: the quantities, or the verdict where it is of all that have it."""
    by_reason: dict[str, list[Compared]] = {}
    for one in compared:
        if one.reason:
            by_reason.setdefault(one.said_in_note, []).append(one)
    notes = []
    for reason, those in by_reason.items():
        verdicts = {c.verdict for c in those}
        all_of_one = len(verdicts) == 1 and sum(c.verdict in verdicts for c in compared) == len(those) > 1
        names = next(iter(verdicts)) if all_of_one else ", ".join(dict.fromkeys(c.value.quantity for c in those))
        notes.append(f"{names}: {reason}")
    return notes


def computed_table(compared: Sequence[Compared], caption: str) -> Table:
    """What was computed, without the print: for parameters that are not the document's own."""
    lines = [[c.value.quantity, *c.shown, c.value.unit] for c in compared if any(c.shown)]
    long = any(" " in cell for line in lines for cell in line[1:5])
    align = ["left", *["left" if long else "right"] * 4, "left"]
    return _filled(["quantity", *_NUMBERS, "unit"], align, lines, caption)


def _filled(
    heads: list[str],
    align: list[str],
    lines: list[list[str]],
    caption: str,
    notes: Sequence[str] = (),
    marks: Sequence[str] = (),
) -> Table:
    kept = [i for i, head in enumerate(heads) if head not in (*_NUMBERS, "unit") or any(line[i] for line in lines)]
    heads, align, *lines = ([row[i] for i in kept] for row in (heads, align, *lines))
    return Table(heads, lines, caption, align, notes, marks)


def _full(value: Any) -> str:
    """A computed number at full precision, the same text on every run; an integer with all its digits."""
    exact = exactly(value)
    if exact is None:
        return ""
    if exact.denominator == 1 and (abs(exact) < 10**15 or not isinstance(value, float)):
        return str(exact.numerator)
    return repr(float(exact))


def _beside(value: Any, digits: str) -> str:
    """A computed number as it stands beside a print; an integer that no float can hold in full."""
    exact: Fraction | None = exactly(value)
    if exact is None:
        return ""
    if exact.denominator == 1 and abs(exact) >= 10**17:
        return _grouped(str(exact.numerator))
    return number(float(exact), max(4, len(Decimal(digits).as_tuple().digits) + 2))


def _grouped(digits: str) -> str:
    """More than 17 digits in a row in groups of ten, so that they can be compared and may wrap.

    >>> _grouped("-2361183241434822606848"), _grouped("8360")
    ('−2361183241 4348226068 48', '8360')
    """
    sign, row = ("−", digits[1:]) if digits.startswith("-") else ("", digits)
    if len(row) <= 17 or not row.isdigit():
        return digits
    return sign + " ".join(row[i : i + 10] for i in range(0, len(row), 10))
