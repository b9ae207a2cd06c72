"""What documents print, as data: one TOML file per table, figure or section.

``load("double-tank", folder)`` reads every file of ``folder/double_tank/printed/``. A file holds what one place of the
document prints:

    document = "double-tank"
    place = "Table 5"                          # as the document names it
    title = "Performance of the pole-placement regulator"

    [[value]]                                  # a printed number
    id = "rise-q0.3"                           # unique within the document
    quantity = "rise time, $q = 0.3$"          # inline text
    printed = "3.6635"                         # digits exactly as printed, decimal point, a string
    unit = "s"
    kind = "computed"                          # given | read | computed | quoted
    # optional
    same_as = "rise-q0.5"                      # printed before: checked against that print
    source = "Ziegler and Nichols 1942"         # of a constant that is not derived (kind = "quoted")
    between = ["3.66", "3.67"]                 # where the exact value lies, if the reason bounds the difference
    corrected = "3.6653"                       # the right digits, where the print is wrong (verdict: misprint)
    reading = "0.05"                           # half-width of a reading off a graph (for kind = "read")
    reason = "why the document differs"        # for misprint, differs and from a reading

    [[claim]]                                  # a testable statement
    id = "no-overshoot"
    says = "The overshoot {q:grows|shrinks} with $q$ and stays below {most} %."     # our words; see `words`
    q = "down"                                 # each further key is a field that sentence and test read
    most = "20"

    [[misprint]]                               # a wrong formula, code line, unit, label or cross-reference
    id = "eq-4.17"
    kind = "formula"                           # formula | code | unit | label | cross-reference | text
    printed = "p4 = K*Td*h/(h + Tf)*(Tf + h)"  # as printed, plain text
    corrected = "p4 = K*Td*h/(h + Tf)**2"
    note = "what is wrong and what follows from it"
    misleads = true                            # would a computation that uses it go wrong?
    proof = "derivation"                       # derivation | dimension | run | reference; none: only noted
    # optional, both or none: the same two as formulas, so that a derivation proves them wrong and right
    printed_expr = "K*Td*h/(h + Tf)*(Tf + h)"
    corrected_expr = "K*Td*h/(h + Tf)**2"

``place`` may be set on an entry too, where it differs from the file's.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

from notebook_reports.errors import PressError
from notebook_reports.ledger.words import UP, WordsError, told
from notebook_reports.project.toml import TomlError, read_toml, tables

_T = TypeVar("_T")
VALUE_KINDS = ("given", "read", "computed", "quoted")
LARGEST_POWER, MOST_CHARACTERS = 300, 500  # of a printed number: more cannot be computed with
PROOFS = ("derivation", "dimension", "run", "reference")
MISPRINT_KINDS = ("formula", "code", "unit", "label", "cross-reference", "text")


class PrintedDataError(PressError, ValueError):
    """A file of ``printed/`` cannot be used; the message names file, entry and key."""


@dataclass(frozen=True)
class Value:
    """One printed number; see the module's docstring for the fields."""

    document: str
    place: str
    id: str
    quantity: str
    printed: str
    unit: str = ""
    kind: str = "computed"
    corrected: str = ""
    reading: str = ""
    reason: str = ""
    same_as: str = ""
    source: str = ""
    between: tuple[str, ...] = ()
    file: str = ""

    @property
    def fraction(self) -> Fraction:
        """The printed digits as an exact number."""
        return Fraction(self.printed)


@dataclass(frozen=True)
class Claim:
    """One statement of a document that can be tested. says: our words, with the fields in them; see `words`.
    file: where it was transcribed.

    >>> claim = Claim("a", "b", "c", "The gain 2 makes it smaller.", {"gain": "2", "effect": "down"})
    >>> claim.number("gain"), claim.agrees("effect", -0.3), claim.agrees("effect", 0.3)
    (Fraction(2, 1), True, False)
    """

    document: str
    place: str
    id: str
    says: str
    fields: Mapping[str, str] = field(default_factory=dict)
    file: str = ""

    def text(self, name: str) -> str:
        """A field as written. Raises PrintedDataError where the claim has none of this name."""
        if name not in self.fields:
            raise PrintedDataError(f"{self.where}: no field {name!r}; there is {', '.join(self.fields) or 'none'}")
        return self.fields[name]

    def number(self, name: str) -> Fraction:
        """A field as an exact number. Raises PrintedDataError."""
        _digits(self.where, name, self.text(name))
        return Fraction(self.text(name))

    def agrees(self, name: str, change: Any) -> bool:
        """Does a change have the direction that the field names? Nothing that stays agrees with either."""
        return bool(change > 0 if self.text(name) == UP else change < 0)

    def pick(self, name: str, choices: Mapping[str, _T]) -> _T:
        """What a field names among choices. Raises PrintedDataError where it names none of them.

        >>> Claim("a", "b", "c", "", {"q": "0.5"}).pick("q", {"0.5": 1, "0.7": 2})
        1
        """
        if self.text(name) not in choices:
            raise PrintedDataError(f"{self.where}: {name} = {self.text(name)!r}; one of {', '.join(choices)}")
        return choices[self.text(name)]

    @property
    def formula(self) -> str:
        """The text between the first backticks. Raises PrintedDataError where there is none."""
        parts = self.says.split("`")
        if len(parts) < 3:
            raise PrintedDataError(f"{self.where}: no formula between backticks in {self.says!r}")
        return parts[1]

    @property
    def where(self) -> str:
        return f"{self.file or self.document}, claim {self.id}"


@dataclass(frozen=True)
class Misprint:
    """One thing a document prints wrongly that is not a number of the ledger."""

    document: str
    place: str
    id: str
    kind: str
    printed: str
    corrected: str
    note: str
    misleads: bool
    proof: str = ""
    printed_expr: str = ""
    corrected_expr: str = ""
    file: str = ""

    @property
    def where(self) -> str:
        return f"{self.file or self.document}, misprint {self.id}"


@dataclass(frozen=True)
class PrintedDocument:
    """Everything transcribed from one document, each mapping by id, in the order of the files."""

    id: str
    values: dict[str, Value]
    claims: dict[str, Claim]
    misprints: dict[str, Misprint]

    def tables(self) -> dict[str, Mapping[str, Value | Claim | Misprint]]:
        """The entries by table of the ledger."""
        return {"value": self.values, "claim": self.claims, "misprint": self.misprints}


def _digits(where: str, key: str, text: object) -> None:
    if not isinstance(text, str):
        raise PrintedDataError(f"{where}: {key} = {text!r} must be a string with the digits as printed")
    try:
        number = Decimal(text)
        finite = number.is_finite() and abs(number.adjusted()) <= LARGEST_POWER and len(text) <= MOST_CHARACTERS
    except InvalidOperation:
        finite = False
    if not finite:
        raise PrintedDataError(
            f"{where}: {key} = {text!r} is not a number, or too large a one; write digits with a point"
        )


def _entries(path: Path, folder: str) -> list[tuple[str, dict[str, Any]]]:
    try:
        content = read_toml(path)
        entries = {table: tables(content, table, path.name) for table in ("value", "claim", "misprint")}
    except TomlError as error:
        raise PrintedDataError(str(error)) from None
    unknown = set(content) - {"document", "place", "title", "value", "claim", "misprint"}
    if unknown:
        raise PrintedDataError(f"{path.name}: unknown key {sorted(unknown)}")
    if content.get("document") != folder.replace("_", "-"):
        raise PrintedDataError(f"{path.name}: document = {content.get('document')!r} in folder {folder}")
    found = []
    for table, listed in entries.items():
        for entry in listed:
            found.append((table, {"document": content["document"], "place": content.get("place"), **entry}))
    if not found:
        raise PrintedDataError(f"{path.name}: holds no value, claim or misprint")
    return found


def _repeats(values: Mapping[str, Any]) -> None:
    """Each value that repeats another must name one that does not itself repeat."""
    for id, value in values.items():
        first = values.get(value.same_as)
        if value.same_as and (first is None or first.same_as):
            raise PrintedDataError(f"{value.file}, value {id}: same_as = {value.same_as!r} is no first print")


def _build(path: Path, table: str, entry: dict[str, Any]) -> Value | Claim | Misprint:
    where = f"{path.name}, {table} {entry.get('id', '(without id)')}"
    cls: Any = {"value": Value, "claim": Claim, "misprint": Misprint}[table]
    known = set(cls.__dataclass_fields__) - {"file", "fields"}
    unknown = set(entry) - known
    if table == "claim":
        entry = _with_fields(where, entry, unknown)
    elif unknown:
        raise PrintedDataError(f"{where}: unknown key {sorted(unknown)}; known: {sorted(known)}")
    if not entry.get("place"):
        raise PrintedDataError(f"{where}: place is missing")
    if table == "value":
        for key in ("printed", "corrected", "reading"):
            if key in entry or key == "printed":
                _digits(where, key, entry.get(key))
        if entry.get("kind", "computed") not in VALUE_KINDS:
            raise PrintedDataError(f"{where}: kind = {entry['kind']!r}; one of {VALUE_KINDS}")
        if "corrected" in entry and not entry.get("reason"):
            raise PrintedDataError(f"{where}: a corrected value needs a reason")
    if table == "value" and "between" in entry:
        for end in entry["between"]:
            _digits(where, "between", end)
        if len(entry["between"]) != 2 or not entry.get("reason"):
            raise PrintedDataError(f"{where}: between = [low, high] needs both ends, and a reason that bears it out")
        entry = {**entry, "between": tuple(entry["between"])}
    if table == "misprint" and "printed_expr" in entry:
        entry = {"proof": "derivation", **entry}
    if table == "misprint" and entry.get("proof", "run") not in PROOFS:
        raise PrintedDataError(f"{where}: proof = {entry['proof']!r}; one of {PROOFS}, or none where it is only noted")
    if table == "misprint" and ("printed_expr" in entry) != ("corrected_expr" in entry):
        raise PrintedDataError(f"{where}: printed_expr and corrected_expr come together")
    if table == "misprint" and entry.get("kind") not in MISPRINT_KINDS:
        raise PrintedDataError(f"{where}: kind = {entry.get('kind')!r}; one of {MISPRINT_KINDS}")
    for key, value in entry.items():
        if not isinstance(value, str | bool | list | tuple | (Mapping if key == "fields" else str)):
            raise PrintedDataError(f"{where}: {key} = {value!r}: a text in quotes is expected")
    try:
        return cls(**entry, file=path.name)
    except TypeError as error:
        raise PrintedDataError(f"{where}: {str(error).partition('__init__() ')[2]}") from None


def _with_fields(where: str, entry: dict[str, Any], names: set[str]) -> dict[str, Any]:
    """A claim's entry with the keys that are fields put aside and its sentence completed."""
    fields = {name: entry[name] for name in entry if name in names}
    if wrong := [name for name, value in fields.items() if not isinstance(value, str)]:
        raise PrintedDataError(f"{where}: {wrong[0]} = {fields[wrong[0]]!r} must be a string")
    try:
        says = told(entry.get("says", ""), fields)
    except WordsError as error:
        raise PrintedDataError(f"{where}: {error}") from None
    kept = {name: value for name, value in entry.items() if name not in fields}
    return kept | ({"says": says} if "says" in entry else {}) | {"fields": fields}


def documents(folder: Path) -> list[str]:
    """The ids of the documents in a folder: ``double-tank`` for ``double_tank/printed/``, in alphabetical order."""
    return sorted(path.parent.name.replace("_", "-") for path in folder.glob("*/printed") if path.is_dir())


def load(document: str, folder: Path) -> PrintedDocument:
    """Read every file of one document.

    document: its id, "double-tank" for the files of ``folder/double_tank/printed/``. Raises PrintedDataError where
    there is none, a file is malformed or an id stands twice.
    """
    known = documents(folder)
    if document not in known:
        raise PrintedDataError(f"unknown document {document!r} in {folder}; one of {', '.join(known) or 'none'}")
    name = document.replace("-", "_")
    tables: dict[str, dict[str, Any]] = {"value": {}, "claim": {}, "misprint": {}}
    for path in sorted((folder / name / "printed").glob("*.toml")):
        for table, entry in _entries(path, name):
            item = _build(path, table, entry)
            if item.id in tables[table]:
                raise PrintedDataError(f"{path.name}: {table} {item.id} stands twice in {document}")
            tables[table][item.id] = item
    _repeats(tables["value"])
    return PrintedDocument(document, tables["value"], tables["claim"], tables["misprint"])
