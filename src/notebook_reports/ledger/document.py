"""Printed against computed: the verdicts.

A notebook opens a document once and asks for checks; each check displays itself as a table and carries the same
facts, as records, in its output (`CHECKS_MIME`). The pipeline harvests those records; nothing else writes the ledger.

    tank = Document(load("double-tank", folder))
    tank.check("Table 5", exact={"rise-q0.3": 3.66348...}, from_inputs={...})
    tank.claim("no-overshoot", {"$q = 0.3$": overshoot < 1e-9}, evidence="largest overshoot 0.0 %")
    tank.misprint("eq-4.17", derived_expression)

Verdicts of a value, computed in this order:

given                 the document states it as an input and nothing here computes it
reproduced            `exact` rounds to the printed digits
from rounded inputs   `from_inputs` rounds to the printed digits and `exact` does not
read                  the document read it off a graph; `exact` lies within the stated reading width
misprint              neither rounds to the print, and `exact` or `from_inputs` rounds to the corrected digits
differs               neither, and the data gives a reason; where the reason was computed (`explained`, the number that
                      follows from it), that number rounds to the print
unexplained           neither, without a reason that holds: this fails a build
"""

import difflib
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

from notebook_reports.display import Table, number
from notebook_reports.ledger import printed_data
from notebook_reports.ledger.verdicts import (
    CHECKS_MIME,
    CLAIM_VERDICTS,
    CONFIRMED,
    DIFFERS,
    FAILING,
    MARKS,
    MISPRINT,
    MISPRINT_VERDICTS,
    NOT_CONFIRMED,
    PARTLY,
    READ,
    VALUE_VERDICTS,
    Record,
    _exact,
    claim_verdict,
    value_verdict,
)


class LedgerError(ValueError):
    """A check was asked for something the printed data does not hold, or left something of it out."""


def _full(value: Any) -> str:
    """A computed number at full precision, the same text on every run."""
    value = _exact(value)
    if value is None:
        return ""
    if value.denominator == 1 and abs(value) < 10**15:
        return str(value.numerator)
    return repr(float(value))


@dataclass(frozen=True)
class Checked:
    """The outcome of one call: a table to read and the records behind it. ``ok`` is False where one fails."""

    view: Table
    records: tuple[Record, ...]

    @property
    def ok(self) -> bool:
        return not any(r.verdict in FAILING for r in self.records)

    def verdicts(self) -> dict[str, str]:
        """The verdict by id."""
        return {r.id: r.verdict for r in self.records}

    def _repr_mimebundle_(self, **kwargs: Any) -> dict[str, Any]:
        bundle = self.view._repr_mimebundle_(**kwargs)
        return {**bundle, CHECKS_MIME: [asdict(r) for r in self.records]} if self.records else bundle


def _near(name: str, known) -> str:
    close = difflib.get_close_matches(name, list(known), n=3, cutoff=0.5)
    return f"; did you mean {' or '.join(close)}?" if close else ""


Same = Callable[[Any, Any], bool]


def _identical(one: Any, other: Any) -> bool:
    return bool((one - other).expand() == 0)


class Document:
    """The printed data of one document, ready to be checked.

    printed: what `printed_data.load` read. same: are two SymPy expressions the same mathematics? Proves misprints.
    compare: False where the notebook's parameters are not the document's own. Tables then show what was computed,
    without a verdict, and leave no record.
    """

    def __init__(self, printed: printed_data.PrintedDocument, compare: bool = True, same: Same = _identical):
        self.printed = printed
        self.id = printed.id
        self.compare = compare
        self._same = same
        self._records: list[Record] = []

    def _at(self, place: str) -> dict[str, printed_data.Value]:
        found = {i: v for i, v in self.printed.values.items() if v.place == place}
        if not found:
            places = {v.place for v in self.printed.values.values()}
            raise LedgerError(f"{self.id} has no printed values at {place!r}{_near(place, places)}")
        return found

    def given(self, place: str) -> dict[str, Fraction]:
        """The inputs printed at one place as exact numbers by id; computations start from these."""
        return {i: v.fraction for i, v in self._at(place).items()}

    def value(self, id: str) -> Fraction:
        """One printed number, exact."""
        if id not in self.printed.values:
            raise LedgerError(f"{self.id} has no printed value {id!r}{_near(id, self.printed.values)}")
        return self.printed.values[id].fraction

    def check(
        self,
        place: str,
        exact: Mapping[str, Any] | None = None,
        from_inputs: Mapping[str, Any] | None = None,
        explained: Mapping[str, Any] | None = None,
        caption: str = "",
        only: tuple[str, ...] = (),
    ) -> Checked:
        """Compare every number printed at one place with what was computed.

        exact: by id, from first principles at full precision. from_inputs: by id, the document's own chain of
        arithmetic from its own rounded numbers. explained: by id, the number that follows from the reason the data
        gives for a difference. only: check just these ids (a place may be spread over notebooks).
        Raises LedgerError for an id the place does not have, and for one of kind other than ``given`` without a value.
        """
        exact, from_inputs, explained = dict(exact or {}), dict(from_inputs or {}), dict(explained or {})
        values = self._at(place)
        for id in (*exact, *from_inputs, *explained, *only):
            if id not in values:
                raise LedgerError(f"{self.id}, {place}: no printed value {id!r}{_near(id, values)}")
        if only:
            values = {i: v for i, v in values.items() if i in only}
        missing = [i for i, v in values.items() if v.kind != "given" and i not in exact and i not in from_inputs]
        if missing and self.compare:
            raise LedgerError(f"{self.id}, {place}: nothing computed for {', '.join(missing)}")
        rows, marks, notes, records = [], [], [], []
        for id, value in values.items():
            a, b = exact.get(id), from_inputs.get(id)
            shown = [_beside(x, value.printed) for x in (a, b)]
            if not self.compare:
                if any(shown):
                    rows.append([value.quantity, *shown, value.unit])
                continue
            verdict = value_verdict(value, a, b, explained.get(id))
            explain = value.reason if verdict in (READ, MISPRINT, DIFFERS) else ""
            if explain:
                notes.append(f"{value.quantity}: {explain}")
            rows.append([value.quantity, _grouped(value.printed), *shown, value.unit, verdict])
            marks.append(MARKS[verdict])
            fields = {
                "quantity": value.quantity,
                "printed": value.printed,
                "unit": value.unit,
                "kind": value.kind,
                "exact": _full(a),
                "from_inputs": _full(b),
                "reason": explain,
            }
            records.append(Record("value", self.id, value.place, id, verdict, fields))
        heads = ["quantity", "printed", "exact", "from inputs", "unit", "verdict"]
        long = any(" " in cell for row in rows for cell in row[1:4])  # digits in groups: let them wrap
        align = ["left", *["left" if long else "right"] * 3, "left", "left"]
        if not self.compare:
            del heads[1], heads[-1], align[1], align[-1]
        for empty in ("from inputs", "exact", "unit"):
            column = heads.index(empty)
            if not any(row[column] for row in rows):
                for row in (heads, align, *rows):
                    del row[column]
        caption = caption or f"{self.id}, {place}: printed and computed"
        return self._checked(Table(heads, rows, caption, align, notes, marks), records)

    def claim(self, id: str, parts: Mapping[str, bool] | bool, evidence: str) -> Checked:
        """Test one statement: each part is a computed truth value with its name; evidence states the numbers."""
        return self.claims({id: (parts, evidence)})

    def claims(self, tested: Mapping[str, tuple[Mapping[str, bool] | bool, str]], caption: str = "") -> Checked:
        """Test several statements: by id, (parts, evidence). One table, one row per statement."""
        rows, marks, records = [], [], []
        for id, (parts, evidence) in tested.items():
            if id not in self.printed.claims:
                raise LedgerError(f"{self.id} has no claim {id!r}{_near(id, self.printed.claims)}")
            if not evidence.strip():
                raise LedgerError(f"{self.id}, claim {id}: give the numbers that show it as evidence")
            claim = self.printed.claims[id]
            parts = dict(parts) if isinstance(parts, Mapping) else {"": bool(parts)}
            verdict = claim_verdict(parts)
            failed = [name for name, outcome in parts.items() if name and not outcome]
            if verdict == PARTLY and failed:
                evidence = f"{evidence.rstrip('.')}. Not for: {', '.join(failed)}."
            rows.append([claim.place, claim.says, evidence, *([verdict] if self.compare else [])])
            marks.append(MARKS[verdict] if self.compare else "")
            fields = {"says": claim.says, "evidence": evidence}
            records.append(Record("claim", self.id, claim.place, id, verdict, fields))
        heads = ["place", "the document says", "computed", "verdict"]
        caption = caption or f"{self.id}: statements tested"
        if not self.compare:
            heads, records, marks = heads[:3], [], []
        return self._checked(Table(heads, rows, caption, ["left"] * len(heads), (), marks), records)

    def misprint(self, id: str, proof: Any) -> Checked:
        """Record one misprint with its proof; see `misprints`."""
        return self.misprints({id: proof})

    def misprints(self, found: Mapping[str, Any], caption: str = "") -> Checked:
        """Record misprints, each with its proof, by id. What is not confirmed fails a build.

        Where the data holds the formulas as SymPy text, the proof is the derived expression: confirmed where it
        equals the corrected formula and not the printed one (symbols are matched by name). Otherwise the proof is a
        computed truth value that says the print is wrong.
        """
        rows, marks, records = [], [], []
        for id, proof in found.items():
            if id not in self.printed.misprints:
                raise LedgerError(f"{self.id} has no misprint {id!r}{_near(id, self.printed.misprints)}")
            item = self.printed.misprints[id]
            wrong = _proves(item, proof, self._same) if item.printed_expr else bool(proof)
            verdict = CONFIRMED if wrong else NOT_CONFIRMED
            misleads = "yes" if item.misleads else "no"
            rows.append([item.place, f"`{item.printed}`", f"`{item.corrected}`", item.note, misleads])
            marks.append(MARKS[verdict])
            fields = {
                "kind": item.kind,
                "printed": item.printed,
                "corrected": item.corrected,
                "misleads": misleads,
                "note": item.note,
            }
            records.append(Record("misprint", self.id, item.place, id, verdict, fields))
        heads = ["place", "printed", "correct", "what is wrong", "misleads"]
        caption = caption or f"{self.id}: misprints"
        if not self.compare:
            records, marks = [], []
        return self._checked(Table(heads, rows, caption, ["left"] * 5, (), marks), records)

    def _checked(self, view: Table, records: list[Record]) -> Checked:
        self._records.extend(records)
        return Checked(view, tuple(records))

    def summary(self) -> Table:
        """The verdicts of all checks made so far in this notebook, counted; its last cell shows it."""
        if not self.compare:
            return Table(["checks"], [["none: the parameters are not the document's"]], f"{self.id}: no verdicts")
        counts = Counter((r.table, r.verdict) for r in self._records)
        order = [*VALUE_VERDICTS, *CLAIM_VERDICTS, *MISPRINT_VERDICTS]
        rows = [
            [table, verdict, str(counts[table, verdict])]
            for table in ("value", "claim", "misprint")
            for verdict in order
            if counts[table, verdict]
        ]
        marks = [MARKS[row[1]] for row in rows]
        return Table(["entry", "verdict", "number"], rows, f"{self.id}: the checks of this notebook", (), (), marks)


def _beside(value: Any, digits: str) -> str:
    """A computed number as it stands beside a print; an integer that no float can hold in full."""
    value = _exact(value)
    if value is None:
        return ""
    if value.denominator == 1 and abs(value) >= 10**17:
        return _grouped(str(value.numerator))
    return number(value, _digits_shown(digits))


def _grouped(digits: str) -> str:
    """More than 17 digits in a row in groups of ten, so that they can be compared and may wrap.

    >>> _grouped("-2361183241434822606848"), _grouped("8360")
    ('−2361183241 4348226068 48', '8360')
    """
    sign, row = ("−", digits[1:]) if digits.startswith("-") else ("", digits)
    if len(row) <= 17 or not row.isdigit():
        return digits
    return sign + " ".join(row[i : i + 10] for i in range(0, len(row), 10))


def _digits_shown(digits: str) -> int:
    """Significant digits for the computed value beside a print: two more than printed, at least four."""
    return max(4, len(Decimal(digits).as_tuple().digits) + 2)


def _proves(item: printed_data.Misprint, derived: Any, same: Same) -> bool:
    import sympy

    names = {symbol.name: symbol for symbol in derived.free_symbols}

    def equal(text: str) -> bool:
        read = sympy.sympify(text, locals=names, rational=True)
        return same(read.subs({s: names.get(s.name, s) for s in read.free_symbols}), derived)

    return not equal(item.printed_expr) and equal(item.corrected_expr)
