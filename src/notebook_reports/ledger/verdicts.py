"""Verdicts: what they are, and how one is decided."""

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

from notebook_reports.ledger import printed_data

CHECKS_MIME = "application/vnd.loopbook.checks+json"

GIVEN, REPRODUCED, ROUNDED, READ, MISPRINT, DIFFERS, UNEXPLAINED = VALUE_VERDICTS = (
    "given",
    "reproduced",
    "from rounded inputs",
    "read",
    "misprint",
    "differs",
    "unexplained",
)

HOLDS, PARTLY, FAILS = CLAIM_VERDICTS = ("holds", "holds partly", "fails")

CONFIRMED, NOT_CONFIRMED = MISPRINT_VERDICTS = ("confirmed", "not confirmed")

FAILING = {UNEXPLAINED, NOT_CONFIRMED}

MARKS = {
    GIVEN: "",
    REPRODUCED: "good",
    ROUNDED: "good",
    READ: "good",
    MISPRINT: "note",
    DIFFERS: "note",
    UNEXPLAINED: "bad",
    HOLDS: "good",
    PARTLY: "note",
    FAILS: "note",
    CONFIRMED: "note",
    NOT_CONFIRMED: "bad",
}


def _exact(value: Any) -> Fraction | None:
    """Any finite real number, also NumPy's and SymPy's, as a Fraction; None for none, NaN and infinity."""
    if value is None:
        return None
    if isinstance(value, int | Fraction):
        return Fraction(value)
    if getattr(value, "is_Rational", False):
        return Fraction(int(value.p), int(value.q))
    value = float(value)
    return Fraction(value) if value == value and abs(value) != float("inf") else None


def last_place(digits: str) -> Fraction:
    """The unit of the last printed digit.

    >>> last_place("6.44"), last_place("1.1881e+05"), last_place("70")
    (Fraction(1, 100), Fraction(10, 1), Fraction(1, 1))
    """
    return Fraction(10) ** int(Decimal(digits).as_tuple().exponent)


def rounds_to(value: Any, digits: str) -> bool:
    """Does the value, rounded to as many digits as are printed, give the print? A tie may go either way.

    >>> rounds_to(0.65 / 0.15, "4.33"), rounds_to(0.65 / 0.15, "4.34"), rounds_to(Fraction(1, 8), "0.12")
    (True, False, True)
    """
    value = _exact(value)
    return value is not None and abs(value - Fraction(digits)) <= last_place(digits) / 2


def value_verdict(value: printed_data.Value, exact: Any, from_inputs: Any = None, explained: Any = None) -> str:
    """The verdict on one printed number; the order is the module's table."""
    if value.kind == "given" and exact is None and from_inputs is None:
        return GIVEN
    if rounds_to(exact, value.printed):
        return REPRODUCED
    if rounds_to(from_inputs, value.printed):
        return ROUNDED
    a = _exact(exact)
    if value.reading and a is not None and abs(a - value.fraction) <= Fraction(value.reading):
        return READ
    if value.corrected and (rounds_to(exact, value.corrected) or rounds_to(from_inputs, value.corrected)):
        return MISPRINT
    if explained is not None and not rounds_to(explained, value.printed):
        return UNEXPLAINED
    return DIFFERS if value.reason and not value.corrected else UNEXPLAINED


def claim_verdict(parts: Mapping[str, bool]) -> str:
    """All parts true: holds; some: holds partly; none: fails."""
    outcomes = [bool(v) for v in parts.values()]
    return HOLDS if all(outcomes) else PARTLY if any(outcomes) else FAILS


@dataclass(frozen=True)
class Record:
    """One row of the ledger, as the harvest reads it."""

    table: str  # value | claim | misprint
    document: str
    place: str
    id: str
    verdict: str
    fields: dict[str, str]
