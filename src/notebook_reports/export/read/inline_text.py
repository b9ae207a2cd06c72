"""Inline text of tables and captions: plain characters, ``$mathematics$``, `` `code` ``; a backslash escapes a sign."""

import re

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Code, Inline, Math, Text

_PIECE = re.compile(r"\\(?P<sign>[$`])|\$(?P<math>(?:\\\$|[^$])+)\$|`(?P<code>[^`]+)`|(?P<stray>\$)")


def read_inline(text: str) -> list[Inline]:
    """Split inline text into nodes. Raises CannotShow for a ``$`` without its partner.

    >>> read_inline("gain $K$ in `W/K`")
    [Text(text='gain '), Math(latex='K', small=False), Text(text=' in '), Code(text='W/K')]
    """
    nodes: list[Inline] = []

    def add(plain: str) -> None:
        if plain and nodes and isinstance(nodes[-1], Text):
            nodes[-1].text += plain
        elif plain:
            nodes.append(Text(plain))

    at = 0
    for found in _PIECE.finditer(text):
        add(text[at : found.start()])
        at = found.end()
        if found["sign"]:
            add(found["sign"])
        elif found["math"]:
            nodes.append(Math(found["math"].strip()))
        elif found["code"]:
            nodes.append(Code(found["code"]))
        else:
            raise CannotShow(f"a $ without its partner in {text!r}; write \\$ for a dollar sign")
    add(text[at:])
    return nodes
