"""Verdicts: what they are, and how one is decided."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any, Protocol

from notebook_reports.ledger import printed_data

CHECKS_MIME = "application/vnd.loopbook.checks+json"

GIVEN, REPEATED, REPRODUCED, ROUNDED, QUOTED, READ, MISPRINT, DIFFERS, UNEXPLAINED = VALUE_VERDICTS = (
    "given",
    "repeated",
    "reproduced",
    "from rounded inputs",
    "quoted",
    "read",
    "misprint",
    "differs",
    "unexplained",
)

HOLDS, PARTLY, FAILS = CLAIM_VERDICTS = ("holds", "holds partly", "fails")

PROVED, NOTED, NOT_CONFIRMED = MISPRINT_VERDICTS = ("proved", "noted", "not confirmed")

FAILING = {UNEXPLAINED, NOT_CONFIRMED}

MARKS = {
    GIVEN: "",
    REPEATED: "",
    REPRODUCED: "good",
    ROUNDED: "good",
    QUOTED: "",
    READ: "good",
    MISPRINT: "note",
    DIFFERS: "note",
    UNEXPLAINED: "bad",
    HOLDS: "good",
    PARTLY: "note",
    FAILS: "note",
    PROVED: "note",
    NOTED: "",
    NOT_CONFIRMED: "bad",
}


MEANINGS = {
    GIVEN: "an input that the document states; nothing else determines it",
    REPEATED: "printed before, and both prints agree",
    REPRODUCED: "derived here, and the exact number rounds to the printed digits",
    ROUNDED: "the document's own rounded numbers give the printed digits, the exact ones do not",
    QUOTED: "a constant of the literature, not derived here, that agrees with the named source",
    READ: "read off a graph; the exact number lies within the width of the reading",
    MISPRINT: "the print is wrong; the corrected digits are shown",
    DIFFERS: "neither reproduced nor a misprint, for a reason that is given and borne out",
    UNEXPLAINED: "none of these; the book is then not made",
    HOLDS: "every part of the statement was found to be true",
    PARTLY: "a part of it was found to be true; the rest is named",
    FAILS: "the computation shows that it is not true",
    PROVED: "a computation shows that the print is wrong and the correction right",
    NOTED: "a slip of the pen that nothing computes",
    NOT_CONFIRMED: "the proof failed; the book is then not made",
}
"""What each verdict says of a printed value, a statement or a misprint."""


class Truth(Protocol):
    """True or false, NumPy's too."""

    def __bool__(self) -> bool: ...


def exactly(value: Any) -> Fraction | None:
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
    value = exactly(value)
    return value is not None and abs(value - Fraction(digits)) <= last_place(digits) / 2


@dataclass(frozen=True)
class Computed:
    """What stands against one print; None where there is nothing.

    exact: from first principles. from_inputs: by the document's own arithmetic from its own rounded numbers. quoted: as
    the named source has it. first: the number that this one repeats, as printed there. explained: what follows from the
    reason that the data gives for a difference.
    """

    exact: Any = None
    from_inputs: Any = None
    quoted: Any = None
    first: Any = None
    explained: Any = None

    @property
    def numbers(self) -> tuple[Any, ...]:
        """Those that the print is compared with."""
        return (self.exact, self.from_inputs, self.quoted, self.first)


def value_verdict(value: printed_data.Value, found: Computed) -> str:
    """The verdict on one printed number; the order is the table of `document`.

    A constant of a source is not computed, so it is not rounded either: a quoted value is the source's number.
    """
    if value.kind == "given" and all(x is None for x in found.numbers):
        return GIVEN
    for verdict, number in ((REPRODUCED, found.exact), (ROUNDED, found.from_inputs), (REPEATED, found.first)):
        if rounds_to(number, value.printed):
            return verdict
    if exactly(found.quoted) == value.fraction:
        return QUOTED
    if value.reading:
        return READ if _within(found.exact, _around(value)) else UNEXPLAINED
    if value.corrected:
        return MISPRINT if any(rounds_to(x, value.corrected) for x in found.numbers) else UNEXPLAINED
    known = found.exact if found.exact is not None else found.quoted
    explained = rounds_to(found.explained, value.printed) or _within(known, value.between)
    return DIFFERS if value.reason and explained else UNEXPLAINED


def _around(value: printed_data.Value) -> tuple[Fraction, Fraction]:
    width = Fraction(value.reading)
    return value.fraction - width, value.fraction + width


def _within(number: Any, interval: Sequence[str | Fraction]) -> bool:
    exact = exactly(number)
    if exact is None or not interval:
        return False
    low, high = (Fraction(end) for end in interval)
    return low <= exact <= high


def claim_verdict(parts: Mapping[str, Truth]) -> str:
    """All parts true: holds; some: holds partly; none: fails."""
    outcomes = [bool(v) for v in parts.values()]
    return HOLDS if all(outcomes) else PARTLY if any(outcomes) else FAILS


def misprint_verdict(holds: Truth, mended: Truth) -> str:
    """A misprint is proved where what is printed does not hold and the correction does."""
    return PROVED if mended and not holds else NOT_CONFIRMED
