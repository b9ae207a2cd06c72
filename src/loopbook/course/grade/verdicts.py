"""One answer judged: what it is, in words that its student understands.

As the ledger judges a printed number: right; right from the student's own earlier numbers; the value of a wrong
method that has a name; another unit; the right method, rounded too early; or none of these. Verdicts are computed, each
can come out otherwise, and nothing is compared with itself.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from loopbook.course.errors import Unreadable
from loopbook.course.kinds.choice import Choice
from loopbook.course.kinds.kind import shown_number, with_unit
from loopbook.course.kinds.number import OneNumber
from loopbook.course.question import Asked
from notebook_reports.display import literal
from notebook_reports.project.printable import printable

RIGHT, OWN, ROUNDED, HALF, METHOD, UNIT, SIGN, WRONG, UNREADABLE, MISSING = VERDICTS = (
    "right",
    "right from own values",
    "rounded too early",
    "half right",
    "wrong method",
    "wrong unit",
    "wrong sign",
    "wrong",
    "unreadable",
    "missing",
)
SHARE = {RIGHT: 1.0, OWN: 1.0, ROUNDED: 0.5, HALF: 0.5}
"""Of the points; of the others none."""
MARKS = {RIGHT: "good", OWN: "good", ROUNDED: "note", HALF: "note"}
LONGEST_SHOWN = 80
"""Characters of an answer that are shown."""
FEWEST = 2
"""Significant digits of the right value that show its method."""
NEARLY = 3.0
"""Tolerances within which a value is the right one rounded on the way."""
FACTORS = {
    1e3: "1000",
    1e6: "1 000 000",
    60.0: "60, minutes for seconds",
    3600.0: "3600, hours for seconds",
    100.0: "100, percent for a share",
    180 / math.pi: "180/π, degrees for radians",
    2 * math.pi: "2π, Hz for rad/s",
}


@dataclass(frozen=True)
class Judged:
    """The judgement of one answer. words: for the student. method: the name of a wrong method. own: the names of the
    student's own values that it follows from. given: what they wrote, and key: what is right, as inline text;
    plain_given and plain_key: as plain text."""

    name: str
    verdict: str
    words: str
    points: float
    of: float
    given: str = ""
    key: str = ""
    method: str = ""
    own: tuple[str, ...] = ()
    plain_given: str = ""
    plain_key: str = ""


@dataclass(frozen=True)
class Given:
    """What a student wrote for one answer. raw: plain; refused: why nothing plain came out of the notebook."""

    raw: Any = None
    refused: str = ""


def judge_answer(asked: Asked, given: Given, from_own: Asked | None = None, own: Sequence[str] = ()) -> Judged:
    """The verdict on one answer.

    asked: with the key from the right values; from_own: with the one that follows from the student's own, where that
    is another; own: the names of those values.
    """
    return replace(_judgement(asked, given, from_own, own), plain_given=shown_raw(given.raw))


def _judgement(asked: Asked, given: Given, from_own: Asked | None, own: Sequence[str]) -> Judged:
    if given.refused:
        return _judged(asked, UNREADABLE, f"this cannot be compared: {given.refused}")
    try:
        value = asked.kind.read(given.raw)
    except Unreadable as error:
        missing = "nothing was written" in str(error)
        words = "missing" if missing else str(error)
        return _judged(asked, MISSING if missing else UNREADABLE, words, literal(shown_raw(given.raw)))
    text = _as_given(asked, given.raw, value)
    if asked.holds is not None:
        found = _by_conditions(asked, value, text, ())
        other = _by_conditions(from_own, value, text, own) if from_own and found.verdict == WRONG else found
        return other if other.verdict == OWN else found
    for key, names in ((asked, ()), *([(from_own, tuple(own))] if from_own else [])):
        if key.right(value):
            words = "right" if not names else f"right from your own {listed(names)}"
            return _judged(asked, OWN if names else RIGHT, words, text, own=names)
    for key, names in ((asked, ()), *([(from_own, tuple(own))] if from_own else [])):
        if misled := _misled(key, value):
            verdict, words, method = misled
            words += f", from your own {listed(names)}" if names else ""
            return _judged(asked, verdict, words, text, method, names)
    for key, names in ((asked, ()), *([(from_own, tuple(own))] if from_own else [])):
        if _rounded(key, value):
            words = "right method, rounded too early" + (f", from your own {listed(names)}" if names else "")
            return _judged(asked, ROUNDED, words, text, own=names)
    return _judged(asked, WRONG, f"this is not the {'choice' if isinstance(asked.kind, Choice) else 'value'}", text)


def _judged(
    asked: Asked, verdict: str, words: str, given: str = "", method: str = "", own: Sequence[str] = ()
) -> Judged:
    points = SHARE.get(verdict, 0.0) * asked.points
    key, plain = asked.kind.text(asked.key), shown_raw(asked.kind.plain(asked.key))
    return Judged(asked.name, verdict, words, points, asked.points, given, key, method, tuple(own), plain_key=plain)


def _as_given(asked: Asked, raw: Any, value: Any) -> str:
    """What a student wrote, as people read it: a number with the digits that it has."""
    if isinstance(asked.kind, OneNumber):
        return with_unit(f"{value:.7g}", asked.kind.unit)
    if callable(value) or (isinstance(raw, str) and len(raw) > LONGEST_SHOWN):
        return literal(shown_raw(raw))
    return asked.kind.text(value)


def _by_conditions(asked: Asked, value: Any, text: str, own: Sequence[str]) -> Judged:
    try:
        met = asked.conditions(value)
    except Exception as error:
        return _judged(asked, WRONG, f"with this it cannot be computed: {error}", text)
    if all(met.values()):
        words = "right: " + "; ".join(met)
        return _judged(
            asked, OWN if own else RIGHT, words + (f"; from your own {listed(own)}" if own else ""), text, own=own
        )
    unmet = [condition for condition, holds in met.items() if not holds]
    return _judged(asked, WRONG, f"this does not hold: {'; '.join(unmet)}", text)


def _misled(asked: Asked, value: Any) -> tuple[str, str, str] | None:
    """(verdict, words, method) where a value is one of a known mistake."""
    kind = asked.kind
    if isinstance(kind, Choice) and kind.reasons and kind.right_without_reason(value, asked.key):
        return HALF, "the right choice, but not for this reason", ""
    for method, key in asked.wrong.items():
        if kind.same(value, key):
            return METHOD, f"that is the value with this mistake: {method}", method
    if isinstance(kind, OneNumber) and not kind.whole and asked.key:
        if kind.same(-value, asked.key):
            return SIGN, "the size is right, the sign is not", "sign"
        for factor, told in FACTORS.items():
            for shift in (factor, 1 / factor):
                if kind.same(value * shift, asked.key):
                    return UNIT, f"wrong unit (factor {told})", "unit"
    return None


def _rounded(asked: Asked, value: Any) -> bool:
    """Is it nearly the key: within a few tolerances, or the key rounded to fewer digits, two at least?"""
    if isinstance(asked.kind, Choice) or not hasattr(asked.kind, "tolerance"):
        return False
    if asked.right(value, NEARLY):
        return True
    if not isinstance(asked.kind, OneNumber) or asked.kind.whole or not value:
        return False
    return any(math.isclose(value, float(f"{asked.key:.{digits}g}"), rel_tol=1e-9) for digits in range(FEWEST, 7))


def listed(names: Sequence[str]) -> str:
    """
    >>> listed(["K"]), listed(["K", "T", "L"])
    ('K', 'K, T and L')
    """
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def shown_raw(raw: Any) -> str:
    """What a student wrote, for people, in short."""
    if raw is None:
        return ""
    if isinstance(raw, float):
        return shown_number(raw, 6)
    text = raw if isinstance(raw, str) else "a function" if callable(raw) else str(raw)
    line = printable(" ".join(text[: 4 * LONGEST_SHOWN].split()))
    return line if len(line) <= LONGEST_SHOWN else f"{line[:LONGEST_SHOWN]}…"
