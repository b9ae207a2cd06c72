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
    corrected = "3.6653"                       # the right digits, where the print is wrong (verdict: misprint)
    reading = "0.05"                           # half-width of a reading off a graph (for kind = "read")
    reason = "why the document differs"        # for misprint, differs and from a reading

    [[claim]]                                  # a testable statement
    id = "no-overshoot"
    says = "The step response has no overshoot for any of the three $q$."     # our words

    [[misprint]]                               # a wrong formula, code line, unit, label or cross-reference
    id = "eq-4.17"
    kind = "formula"                           # formula | code | unit | label | cross-reference | text
    printed = "p4 = K*Td*h/(h + Tf)*(Tf + h)"  # as printed, plain text
    corrected = "p4 = K*Td*h/(h + Tf)**2"
    note = "what is wrong and what follows from it"
    misleads = true                            # would a computation that uses it go wrong?
    # optional, both or none: the same two as SymPy text, so that a derivation proves them wrong and right
    printed_expr = "K*Td*h/(h + Tf)*(Tf + h)"
    corrected_expr = "K*Td*h/(h + Tf)**2"

``place`` may be set on an entry too, where it differs from the file's.
"""

import tomllib
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from pathlib import Path

VALUE_KINDS = ("given", "read", "computed", "quoted")
MISPRINT_KINDS = ("formula", "code", "unit", "label", "cross-reference", "text")


class PrintedDataError(ValueError):
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

    @property
    def fraction(self) -> Fraction:
        """The printed digits as an exact number."""
        return Fraction(self.printed)


@dataclass(frozen=True)
class Claim:
    """One statement of a document that can be tested."""

    document: str
    place: str
    id: str
    says: str


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
    printed_expr: str = ""
    corrected_expr: str = ""


@dataclass(frozen=True)
class PrintedDocument:
    """Everything transcribed from one document, each mapping by id, in the order of the files."""

    id: str
    values: dict[str, Value]
    claims: dict[str, Claim]
    misprints: dict[str, Misprint]


def _digits(where: str, key: str, text: object) -> None:
    if not isinstance(text, str):
        raise PrintedDataError(f"{where}: {key} = {text!r} must be a string with the digits as printed")
    try:
        finite = Decimal(text).is_finite()
    except InvalidOperation:
        finite = False
    if not finite:
        raise PrintedDataError(f"{where}: {key} = {text!r} is not a number; write digits with a decimal point")


def _entries(path: Path, folder: str) -> list[tuple[str, dict]]:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise PrintedDataError(f"{path.name}: {error}") from None
    unknown = set(content) - {"document", "place", "title", "value", "claim", "misprint"}
    if unknown:
        raise PrintedDataError(f"{path.name}: unknown key {sorted(unknown)}")
    if content.get("document") != folder.replace("_", "-"):
        raise PrintedDataError(f"{path.name}: document = {content.get('document')!r} in folder {folder}")
    found = []
    for table in ("value", "claim", "misprint"):
        for entry in content.get(table, []):
            found.append((table, {"document": content["document"], "place": content.get("place"), **entry}))
    if not found:
        raise PrintedDataError(f"{path.name}: holds no value, claim or misprint")
    return found


def _build(path: Path, table: str, entry: dict):
    where = f"{path.name}, {table} {entry.get('id', '(without id)')}"
    cls = {"value": Value, "claim": Claim, "misprint": Misprint}[table]
    unknown = set(entry) - set(cls.__dataclass_fields__)
    if unknown:
        raise PrintedDataError(f"{where}: unknown key {sorted(unknown)}; known: {sorted(cls.__dataclass_fields__)}")
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
    if table == "misprint" and ("printed_expr" in entry) != ("corrected_expr" in entry):
        raise PrintedDataError(f"{where}: printed_expr and corrected_expr come together")
    if table == "misprint" and entry.get("kind") not in MISPRINT_KINDS:
        raise PrintedDataError(f"{where}: kind = {entry.get('kind')!r}; one of {MISPRINT_KINDS}")
    try:
        return cls(**entry)
    except TypeError as error:
        raise PrintedDataError(f"{where}: {str(error).partition('__init__() ')[2]}") from None


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
    tables: dict[str, dict] = {"value": {}, "claim": {}, "misprint": {}}
    for path in sorted((folder / name / "printed").glob("*.toml")):
        for table, entry in _entries(path, name):
            item = _build(path, table, entry)
            if item.id in tables[table]:
                raise PrintedDataError(f"{path.name}: {table} {item.id} stands twice in {document}")
            tables[table][item.id] = item
    return PrintedDocument(document, tables["value"], tables["claim"], tables["misprint"])
