"""Blocks inside a line or a table cell: their words, with line breaks between them."""

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import (
    Alert,
    Aside,
    Block,
    Break,
    Bullets,
    Code,
    Definitions,
    Display,
    FigureBlock,
    Grid,
    Heading,
    Inline,
    Math,
    Mend,
    Paragraph,
    Quote,
    Styled,
    Text,
    ThematicBreak,
    Verbatim,
)


def flat(blocks: list[Block]) -> list[Inline]:
    """The blocks in one line. Raises CannotShow for a table."""
    joined: list[Inline] = []
    for part in _parts(blocks):
        joined += [*([Break()] if joined else []), *part]
    return joined


def item_mark(number: int, style: str) -> str:
    """The number of an item in its style, with its point.

    >>> item_mark(5, "a"), item_mark(27, "A"), item_mark(4, "i"), item_mark(3, "1")
    ('e.', 'AA.', 'iv.', '3.')
    """
    if style in "aA" and number > 0:
        shown = ""
        while number:
            number, rest = divmod(number - 1, 26)
            shown = chr(ord("a") + rest) + shown
    elif style in "iI" and 0 < number < 4000:
        ones = ("", "i", "ii", "iii", "iv", "v", "vi", "vii", "viii", "ix")
        tens = ("", "x", "xx", "xxx", "xl", "l", "lx", "lxx", "lxxx", "xc")
        hundreds = ("", "c", "cc", "ccc", "cd", "d", "dc", "dcc", "dccc", "cm")
        shown = "m" * (number // 1000) + hundreds[number // 100 % 10] + tens[number // 10 % 10] + ones[number % 10]
    else:
        return f"{number}."
    return (shown.upper() if style in "AI" else shown) + "."


def _parts(blocks: list[Block]) -> list[list[Inline]]:
    parts: list[list[Inline]] = []
    for block in blocks:
        match block:
            case Paragraph(children):
                parts.append(children)
            case Heading(_, children):
                parts.append([Styled("strong", children)])
            case Display(latex):
                parts.append([Math(latex)])
            case Verbatim(text):
                parts += [[Code(line)] for line in text.split("\n")]
            case Bullets(items):
                marks = [item_mark(n, block.style) if block.ordered else "•" for n in block.numbers]
                parts += [[Text(f"{mark} "), *flat(item.blocks)] for mark, item in zip(marks, items, strict=True)]
            case Definitions(items):
                parts += [[Styled("strong", term), Text(" "), *flat(body)] for term, body in items]
            case Quote(inside) | Alert(_, inside) | Aside(inside):
                parts += _parts(inside)
            case FigureBlock(picture, caption):
                parts += [[picture], *([caption] if caption else [])]
            case Mend():
                parts.append([block])
            case ThematicBreak():
                continue
            case Grid():
                raise CannotShow("an HTML table inside a table cell; show the tables one after the other")
    return parts
