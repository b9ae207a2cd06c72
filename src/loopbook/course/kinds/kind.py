"""What all kinds of answers have in common."""

import math
from typing import Any, Protocol

from loopbook.course.errors import SheetError, Unreadable
from notebook_reports.display import number as shown


class Kind(Protocol):
    """One kind of answer."""

    @property
    def unit(self) -> str:
        """Of its numbers, or ""."""

    def key(self, value: Any) -> Any:
        """The author's value in the form that is compared. Raises SheetError."""

    def read(self, raw: Any) -> Any:
        """A student's plain value (of JSON) in that form. Raises Unreadable in words for the student."""

    def same(self, given: Any, key: Any, widths: float = 1.0) -> bool:
        """Does an answer agree with a key, within so many tolerances?"""

    def handed(self, given: Any, value: Any) -> Any:
        """A student's answer in the form of the author's value, for the cells that follow."""

    def plain(self, key: Any) -> Any:
        """As JSON holds it."""

    def text(self, key: Any) -> str:
        """As people read it: inline text with its unit."""

    def wants(self) -> str:
        """What a student is asked to write."""

    def blank(self) -> str:
        """What stands in the student's notebook until it is answered, as Python writes it."""

    def numbers(self, key: Any) -> list[float]:
        """The numbers that give the answer away where they are printed."""


def finite_number(raw: Any) -> float:
    """A plain finite number. Raises Unreadable with what is wrong with it, for a student.

    >>> finite_number(3)
    3.0
    >>> finite_number("1,23")
    Traceback (most recent call last):
    ...
    loopbook.course.errors.Unreadable: "1,23" is a text, not a number: write 1.23, without quotes
    """
    if raw is None:
        raise Unreadable("nothing was written")
    if isinstance(raw, bool):
        raise Unreadable(f"{raw} is no number")
    if isinstance(raw, list) and len(raw) == 2 and all(isinstance(v, int | float) for v in raw):
        raise Unreadable(
            f"{raw[0]}, {raw[1]} are two numbers: in Python the decimal sign is a point, {raw[0]}.{raw[1]}"
        )
    if isinstance(raw, str):
        raise Unreadable(_text_for_number(raw))
    if not isinstance(raw, int | float):
        raise Unreadable(f"a number is asked for, not {_named(raw)}")
    try:
        found = float(raw)
    except OverflowError:
        raise Unreadable("the number is too large") from None
    if not math.isfinite(found):
        raise Unreadable(f"{found} is no number that can be compared")
    return found


def _text_for_number(text: str) -> str:
    """What to tell one who wrote a text in place of a number."""
    short = text if len(text) <= 40 else f"{text[:40]}…"
    word, _, rest = text.strip().replace("−", "-").partition(" ")
    try:
        value = float(word.replace(",", ".", 1))
    except ValueError:
        return f'"{short}" is a text, not a number'
    if not math.isfinite(value):
        return f'"{short}" is a text, not a number'
    without = " and without its unit" if rest.strip() else ""
    return f'"{short}" is a text, not a number: write {word.replace(",", ".", 1)}, without quotes{without}'


def _named(raw: Any) -> str:
    if callable(raw):
        return "a function"
    names = {list: "a list", dict: "a table of names", bool: "True or False"}
    return names.get(type(raw), f"a {type(raw).__name__}")


def real_number(value: Any, what: str) -> float:
    """A number of the author's as a float, also of NumPy and SymPy. Raises SheetError."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        raise SheetError(f"{what}: {value!r} is no real number") from None
    if not math.isfinite(found):
        raise SheetError(f"{what}: {value!r} is not finite")
    return found


def with_unit(text: str, unit: str) -> str:
    """A number and its unit.

    >>> with_unit("1.25", "s"), with_unit("1.25", "")
    ('1.25 s', '1.25')
    """
    return f"{text} {unit}" if unit else text


def shown_number(value: float, digits: int) -> str:
    """A number with so many significant digits, zeros at the end kept.

    >>> shown_number(0.65, 3), shown_number(12345.6, 3), shown_number(2, 3)
    ('0.650', '12300', '2.00')
    """
    rounded = float(f"{value:.{digits}g}")
    if rounded == 0 or not 1e-4 <= abs(rounded) < 1e7:
        return shown(rounded, digits)
    places = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:.{places}f}".replace("-", "−")
