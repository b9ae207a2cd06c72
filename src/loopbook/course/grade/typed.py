"""Answers typed from paper: the words of a CSV's cell as the plain value that a notebook would hold."""

import re
from typing import Any

from loopbook.course.kinds.choice import Choice
from loopbook.course.kinds.curve import PlottedData
from loopbook.course.kinds.kind import Kind
from loopbook.course.kinds.number import OneNumber, SeveralNumbers
from loopbook.course.kinds.polynomial import Polynomial

_NUMBER = re.compile(r"[-+−]?\d+(?:[.,]\d+)?(?:[eE][-+−]?\d+)?")


def from_typed(kind: Kind, text: str) -> Any:
    """The value; a text that is none stays a text, which the kind then refuses by its words.

    A decimal comma is read as a point. Several numbers have blanks or semicolons between them.

    >>> from loopbook.course.tolerance import Tolerance
    >>> from_typed(OneNumber(Tolerance(0.01)), "1,23"), from_typed(SeveralNumbers(Tolerance(0.01), 2), "1,5; 2")
    (1.23, [1.5, 2.0])
    """
    text = text.strip()
    if isinstance(kind, OneNumber):
        return _number(text)
    if isinstance(kind, Choice):
        words = [w.strip() for w in re.split(r"[,;]", text)]
        return words if kind.reasons else text
    if isinstance(kind, SeveralNumbers | PlottedData) or (
        isinstance(kind, Polynomial) and not re.search(r"[A-Za-z]", text)
    ):
        return [_number(word) for word in re.split(r"[;\s]+", text.strip("[]() ")) if word]
    return text


def _number(text: str) -> Any:
    if not _NUMBER.fullmatch(text):
        return text
    return float(text.replace(",", ".").replace("−", "-"))
