"""Text made short by references to what it has said before, unpacked in the page by ten lines.

    ^abcn   the n characters that begin (a, b, c) characters back; ^^ is the sign itself

Numbers are written in the 90 letters of `LETTERS`. The same text gives the same bytes everywhere, which zlib does not
promise.
"""

from collections import defaultdict

SIGN = "^"
LETTERS = "".join(chr(c) for c in range(35, 127) if chr(c) not in "\\`^")[:88]
BASE = len(LETTERS)
LEAST = 6
MOST = LEAST + BASE - 1
CANDIDATES = 400


def packed(text: str) -> str:
    """The short form.

    >>> packed("a valve, a valve, a valve")
    'a valve, ^##,+'
    """
    seen: dict[str, list[int]] = defaultdict(list)
    parts: list[str] = []
    at = 0
    while at < len(text):
        start, length = _longest(text, at, seen[text[at : at + LEAST]])
        if length:
            back = at - start
            parts.append(SIGN + LETTERS[back // BASE**2] + LETTERS[back // BASE % BASE] + LETTERS[back % BASE])
            parts.append(LETTERS[length - LEAST])
        else:
            length = 1
            parts.append(SIGN * 2 if text[at] == SIGN else text[at])
        for i in range(at, at + length):
            seen[text[i : i + LEAST]].append(i)
        at += length
    return "".join(parts)


def _longest(text: str, at: int, places: list[int]) -> tuple[int, int]:
    """(where it begins, how long it is), 0 long where nothing before is worth a reference."""
    best = (0, 0)
    for start in places[: -CANDIDATES - 1 : -1]:
        length = LEAST
        while length < MOST and at + length < len(text) and text[start + length] == text[at + length]:
            length += 1
        if length > best[1] and at + LEAST <= len(text):
            best = (start, length)
    return best
