"""Printed against computed: the verdicts.

A notebook opens a document once and asks for checks; each check displays itself as a table and carries the same
facts, as records, in its output (`CHECKS_MIME`). The pipeline harvests those records; nothing else writes the ledger.

    tank = Document(load("double-tank", folder))
    tank.check("Table 5", exact={"rise-q0.3": 3.66348...}, from_inputs={...})
    limit = tank.said("no-overshoot").number("most")
    tank.claim("no-overshoot", {"$q = 0.3$": overshoot < limit}, evidence=f"largest overshoot {overshoot} %")
    tank.misprint("eq-4.17", derived_expression)

Verdicts of a value, computed in this order:

given                 the document states it as an input, and nothing else in it or here determines it
reproduced            `exact` rounds to the printed digits
from rounded inputs   `from_inputs` rounds to the printed digits and `exact` does not
quoted                a constant that is not derived here: it agrees with the source that the data names
repeated              printed before (`same_as`): both prints agree
read                  the document read it off a graph; `exact` lies within the stated reading width
misprint              none rounds to the print, and one of them rounds to the corrected digits
differs               none does, and the data gives a reason that is borne out: the number that follows from it
                      (`explained`) rounds to the print, or `exact` lies in the interval (`between`) of its source
unexplained           none of these: this fails a build

A misprint is *proved* (by a derivation, a dimension, a run of the printed program, a resolved reference) or *noted*.
"""

import difflib
import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from notebook_reports.display import Table
from notebook_reports.errors import PressError
from notebook_reports.formula.read import Symbols, read_formula
from notebook_reports.ledger import captions, printed_data
from notebook_reports.ledger.captions import where
from notebook_reports.ledger.compared import Compared, computed_table, verdict_table
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import (
    CHECKS_MIME,
    CLAIM_VERDICTS,
    MARKS,
    MISPRINT_VERDICTS,
    NOTED,
    PARTLY,
    VALUE_VERDICTS,
    Computed,
    Truth,
    claim_verdict,
    misprint_verdict,
)


class LedgerError(PressError, ValueError):
    """A check was asked for something the printed data does not hold, or left something of it out."""


@dataclass(frozen=True)
class Checked:
    """The outcome of one call: a table to read and the records behind it. ``ok`` is False where one fails."""

    view: Table
    records: tuple[LedgerRow, ...]

    @property
    def ok(self) -> bool:
        return not any(r.fails for r in self.records)

    def verdicts(self) -> dict[str, str]:
        """The verdict by id."""
        return {r.id: r.verdict for r in self.records}

    def _repr_mimebundle_(self, **kwargs: Any) -> dict[str, Any]:
        bundle = self.view._repr_mimebundle_(**kwargs)
        return {**bundle, CHECKS_MIME: [r.carried() for r in self.records]} if self.records else bundle


def _near(name: str, known: Iterable[str]) -> str:
    close = difflib.get_close_matches(name, list(known), n=3, cutoff=0.5)
    return f"; did you mean {' or '.join(close)}?" if close else ""


Same = Callable[[Any, Any], bool]


def _identical(one: Any, other: Any) -> bool:
    return bool((one - other).expand() == 0)


class Document:
    """The printed data of one document, ready to be checked.

    printed: what `printed_data.load` read. same: are two SymPy expressions the same mathematics? Proves misprints.
    compare: False where the notebook's parameters are not the document's own. Tables then show what was computed,
    without a verdict, and leave no record. given: the notebook's parameters by the id of the printed number that each
    one is; one that differs makes ``compare`` False. Raises LedgerError for an id that is not printed.
    """

    def __init__(
        self,
        printed: printed_data.PrintedDocument,
        compare: bool = True,
        same: Same = _identical,
        given: Mapping[str, float] | None = None,
    ):
        self.printed = printed
        self.id = printed.id
        agree = (math.isclose(float(self.value(id)), x, rel_tol=1e-9) for id, x in (given or {}).items())
        self.compare = compare and all(agree)
        self._same = same
        self._records: list[LedgerRow] = []

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

    def said(self, id: str) -> printed_data.Claim:
        """One statement with its fields, for its test to read."""
        if id not in self.printed.claims:
            raise LedgerError(f"{self.id} has no claim {id!r}{_near(id, self.printed.claims)}")
        return self.printed.claims[id]

    def check(
        self,
        place: str,
        exact: Mapping[str, Any] | None = None,
        from_inputs: Mapping[str, Any] | None = None,
        explained: Mapping[str, Any] | None = None,
        quoted: Mapping[str, Any] | None = None,
        caption: str = "",
        only: Sequence[str] = (),
    ) -> Checked:
        """Compare every number printed at one place with what was computed.

        exact: by id, from first principles at full precision. from_inputs: by id, the document's own chain of
        arithmetic from its own rounded numbers. explained: by id, the number that follows from the reason the data
        gives for a difference. quoted: by id, a constant as the source has it that the data names; it is not derived.
        only: check just these ids (a place may be spread over notebooks).
        What repeats an earlier print (`same_as`) is checked against it and needs nothing.
        Raises LedgerError for an id the place does not have, for one of kind other than ``given`` without a value, and
        for a quoted one without a source.
        """
        by = {"exact": exact, "from_inputs": from_inputs, "explained": explained, "quoted": quoted}
        numbers = {name: given or {} for name, given in by.items()}
        values = self._asked(place, [i for given in numbers.values() for i in given], only)
        sourceless = [i for i in numbers["quoted"] if not values[i].source]
        if sourceless:
            raise LedgerError(f"{self.id}, {place}: no source in the data for {', '.join(sourceless)}")
        compared = [
            self._compared(v, {name: given.get(i) for name, given in numbers.items()}) for i, v in values.items()
        ]
        missing = [c.value.id for c in compared if c.value.kind != "given" and all(x is None for x in c.found.numbers)]
        if missing and self.compare:
            raise LedgerError(f"{self.id}, {place}: nothing computed for {', '.join(missing)}")
        if not self.compare:
            caption = caption or f"{where([place])}: computed with other parameters than the document's"
            return self._checked(computed_table(compared, caption), [])
        verdicts = [c.verdict for c in compared]
        caption = caption or captions.caption("value", [place], verdicts, VALUE_VERDICTS)
        return self._checked(verdict_table(compared, caption), [c.row() for c in compared])

    def _compared(self, value: printed_data.Value, numbers: Mapping[str, Any]) -> Compared:
        first = self.printed.values[value.same_as] if value.same_as else None
        return Compared(value, Computed(first=first.fraction if first else None, **numbers), first)

    def _asked(self, place: str, named: Iterable[str], only: Sequence[str]) -> dict[str, printed_data.Value]:
        """The values of a place that a check is asked for; every id that it names must be printed there."""
        values = self._at(place)
        for id in (*named, *only):
            if id not in values:
                raise LedgerError(f"{self.id}, {place}: no printed value {id!r}{_near(id, values)}")
        return {i: v for i, v in values.items() if not only or i in only}

    def claim(self, id: str, parts: Mapping[str, Truth] | Truth, evidence: str) -> Checked:
        """Test one statement: each part is a computed truth value with its name; evidence states the numbers."""
        return self.claims({id: (parts, evidence)})

    def claims(self, tested: Mapping[str, tuple[Mapping[str, Truth] | Truth, str]], caption: str = "") -> Checked:
        """Test several statements: by id, (parts, evidence). One table, one row per statement."""
        rows, marks, records = [], [], []
        for id, (parts, evidence) in tested.items():
            claim = self.said(id)
            if not evidence.strip():
                raise LedgerError(f"{self.id}, claim {id}: give the numbers that show it as evidence")
            parts = dict(parts) if isinstance(parts, Mapping) else {"": bool(parts)}
            verdict = claim_verdict(parts)
            failed = [name for name, outcome in parts.items() if name and not outcome]
            if verdict == PARTLY and failed:
                evidence = f"{evidence.rstrip('.')}. Not for: {', '.join(failed)}."
            rows.append([claim.place, claim.says, evidence, *([verdict] if self.compare else [])])
            marks.append(MARKS[verdict] if self.compare else "")
            fields = {"says": claim.says, "evidence": evidence}
            records.append(LedgerRow("claim", self.id, claim.place, id, verdict, fields))
        heads = ["place", "the document says", "computed", "verdict"]
        places = [row[0] for row in rows]
        if not self.compare:
            caption = caption or f"{where(places)}: computed with other parameters than the document's"
            heads, records, marks = heads[:3], [], []
        caption = caption or captions.caption("claim", places, [r.verdict for r in records], CLAIM_VERDICTS)
        anchors = [f"claim-{id}" for id in tested]
        return self._checked(_placed(heads, rows, caption, marks, anchors), records)

    def misprint(self, id: str, proof: Any) -> Checked:
        """Record one misprint with its proof; see `misprints`."""
        return self.misprints({id: proof})

    def misprints(self, found: Mapping[str, Any], caption: str = "") -> Checked:
        """Record misprints, each with its proof, by id. What is not confirmed fails a build.

        Where the data holds the formulas as text, the proof is the derived expression: proved where it
        equals the corrected formula and not the printed one (symbols are matched by name). Otherwise the proof is two
        computed truth values: (does what is printed hold, does the correction hold), and proved is (False, True); or
        one, which says that the print is wrong. Raises LedgerError where the data calls the misprint only noted.
        """
        for id in found:
            if id in self.printed.misprints and not self.printed.misprints[id].proof:
                raise LedgerError(f"{self.id}, misprint {id}: the data names no proof; use noted(), or say which it is")
        return self._misprints({id: self._proved(id, proof) for id, proof in found.items()}, caption)

    def noted(self, *ids: str, caption: str = "") -> Checked:
        """Record misprints that nothing computes: slips of spelling, labels. Raises LedgerError where the data names a
        proof."""
        for id in ids:
            if id in self.printed.misprints and self.printed.misprints[id].proof:
                raise LedgerError(
                    f"{self.id}, misprint {id}: the data says it is proved; give the proof to misprints()"
                )
        return self._misprints(dict.fromkeys(ids, NOTED), caption)

    def _proved(self, id: str, proof: Any) -> str:
        item = self.printed.misprints.get(id)
        if item and item.printed_expr:
            return misprint_verdict(False, _proves(item, proof, self._same))
        holds, mended = proof if isinstance(proof, tuple) else (not proof, proof)
        return misprint_verdict(holds, mended)

    def _misprints(self, found: Mapping[str, str], caption: str) -> Checked:
        rows, marks, records = [], [], []
        for id, verdict in found.items():
            if id not in self.printed.misprints:
                raise LedgerError(f"{self.id} has no misprint {id!r}{_near(id, self.printed.misprints)}")
            item = self.printed.misprints[id]
            misleads = "yes" if item.misleads else "no"
            rows.append(
                [item.place, f"`{item.printed}`", f"`{item.corrected}`", item.note, misleads, item.proof or NOTED]
            )
            marks.append(MARKS[verdict])
            fields = {
                "kind": item.kind,
                "printed": item.printed,
                "corrected": item.corrected,
                "misleads": misleads,
                "proof": item.proof,
                "note": item.note,
            }
            records.append(LedgerRow("misprint", self.id, item.place, id, verdict, fields))
        heads = ["place", "printed", "correct", "what is wrong", "misleads", "proof"]
        places, misleading = [row[0] for row in rows], [row[4] == "yes" for row in rows]
        if not caption:
            caption = captions.of_misprints(places, misleading)
            if len(set(misleading)) == 1:  # the caption says it of all
                heads, rows = [*heads[:4], heads[5]], [[*row[:4], row[5]] for row in rows]
        if not self.compare:
            records, marks = [], []
        anchors = [f"misprint-{id}" for id in found]
        return self._checked(_placed(heads, rows, caption, marks, anchors), records)

    def _checked(self, view: Table, records: list[LedgerRow]) -> Checked:
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


def _placed(
    heads: list[str], rows: list[list[str]], caption: str, marks: Sequence[str], anchors: Sequence[str] = ()
) -> Table:
    """A table whose first column is the place: each place once, and no column where the caption names the only one."""
    if len({row[0] for row in rows}) == 1 and where([rows[0][0]]) in caption:
        heads, rows = heads[1:], [row[1:] for row in rows]
        return Table(heads, rows, caption, ["left"] * len(heads), (), marks, anchors=anchors)
    return Table(heads, rows, caption, ["left"] * len(heads), (), marks, groups=1, anchors=anchors)


def _proves(item: printed_data.Misprint, derived: Any, same: Same) -> bool:
    names = Symbols({symbol.name: symbol for symbol in derived.free_symbols})

    def equal(key: str) -> bool:
        return same(read_formula(getattr(item, key), names, where=f"{item.where}, {key}"), derived)

    return not equal("printed_expr") and equal("corrected_expr")
