"""Text for a terminal: what came from data cannot move the cursor, colour, rename a window or turn the line around."""

import re
import sys

_HIDDEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff\U000e0000-\U000e007f]"
)


def printable(text: str) -> str:
    r"""The text with every character that a terminal would obey, or not show, as Python writes it.

    >>> print(printable("a\x1b[31mred\x07\u202e"))
    a\x1b[31mred\x07\u202e
    """
    return _HIDDEN.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def take_any_text() -> None:
    """Let this process's output take characters that its encoding does not have, in their escaped form."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
