"""Numbers in texts: is an answer printed where a student reads?"""

import re
from collections.abc import Iterable, Iterator

from loopbook.course.question import Asked

ROUND = {float(n) for n in range(1, 7)}
_NUMBER = re.compile(r"(?<![\w.])\d+(?:[.,]\d+)?(?:[eE][-+−]?\d+)?(?!\w)|(?<![\w.])\.\d+(?!\w)")


def numbers_in(text: str) -> Iterator[float]:
    """Every number that a text shows, without signs; a decimal comma is read as one.

    >>> list(numbers_in("T = 12.5 s, x1 at 63 %, −0,25 and 1.2e-3; v1.2.3"))
    [12.5, 63.0, 0.25, 0.0012]
    """
    for found in _NUMBER.finditer(text):
        if text[found.end() : found.end() + 1] == "." and text[found.end() + 1 : found.end() + 2].isdigit():
            continue
        yield float(found[0].replace(",", ".").replace("−", "-"))


def printed_answer(asked: Iterable[Asked], texts: Iterable[str]) -> str:
    """The name of an answer that can be read off the texts, or "": all of its numbers stand in them, within tolerance.

    The numbers of pages and questions count as printed everywhere. An answer that is a whole number is not looked for.
    """
    shown = sorted({number for text in texts for number in numbers_in(text)} | ROUND)
    for one in asked:
        numbers = one.kind.numbers(one.key) if one.holds is None else []
        if numbers and all(any(_agrees(one, key, number) for number in shown) for key in numbers):
            return one.name
    return ""


def _agrees(asked: Asked, key: float, number: float) -> bool:
    tolerance = getattr(asked.kind, "tolerance")  # noqa: B009 (a kind with numbers has one)
    return bool(tolerance.within(number, abs(key)))
