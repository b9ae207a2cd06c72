"""``\\begin{…}``: matrices, arrays, cases and aligned equations, all as one kind of node, the `Grid`."""

import re
from dataclasses import dataclass

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics.errors import nearest
from notebook_reports.mathematics.lengths import length_in_em
from notebook_reports.mathematics.lexer import Token
from notebook_reports.mathematics.parser import Parser

MAX_COLUMNS = 200


@dataclass(frozen=True)
class Layout:
    """How an environment sets its cells. align: repeated to the right as often as needed.

    aligned: columns in pairs around a relation, without space inside a pair. tags: rows may carry ``\\tag``.
    columns: the most columns it may have; 0 for any number.
    """

    align: str = "c"
    left: str = ""
    right: str = ""
    gap: float = 1.0
    row_gap: float = 0.3
    style: str = "text"
    aligned: bool = False
    tags: bool = False
    columns: int = 0


_FENCES = {"": ("", ""), "p": ("(", ")"), "b": ("[", "]"), "B": ("{", "}"), "v": ("|", "|"), "V": ("‖", "‖")}
_ALIGNED = Layout("rl", gap=0.0, row_gap=0.6, style="display", aligned=True, tags=True)
_GATHERED = Layout("c", gap=0.0, row_gap=0.6, style="display", tags=True, columns=1)

LAYOUTS: dict[str, Layout] = {
    **{k + "matrix": Layout("c", left, right) for k, (left, right) in _FENCES.items()},
    **{
        k + "smallmatrix": Layout("c", left, right, gap=0.5, row_gap=0.15, style="script")
        for k, (left, right) in _FENCES.items()
    },
    "cases": Layout("l", "{", "", columns=2),
    "dcases": Layout("l", "{", "", style="display", columns=2),
    "rcases": Layout("l", "", "}", columns=2),
    **dict.fromkeys(("aligned", "align", "align*", "split", "flalign", "flalign*"), _ALIGNED),
    **dict.fromkeys(("alignat", "alignat*", "alignedat"), _ALIGNED),
    **dict.fromkeys(("gathered", "gather", "gather*"), _GATHERED),
    **dict.fromkeys(
        ("multline", "multline*"), Layout("l", gap=0.0, row_gap=0.6, style="display", tags=True, columns=1)
    ),
    **dict.fromkeys(
        ("eqnarray", "eqnarray*"), Layout("rcl", gap=5 / 18, row_gap=0.6, style="display", tags=True, columns=3)
    ),
    "array": Layout("c"),
    "subarray": Layout("c", gap=0.0, row_gap=0.1, style="script", columns=1),
}
_TRANSPARENT = {"equation", "equation*", "displaymath", "math"}
_WITH_NUMBER = {"alignat", "alignat*", "alignedat"}
_STARRED_MATRIX = {k + "matrix*" for k in _FENCES}


def begin(p: Parser, token: Token) -> n.Node:
    """The environment whose ``\\begin`` was just read."""
    raw, start = p.lexer.raw_argument("\\begin")
    name = raw.strip()
    if name in _TRANSPARENT:
        body = p.items(tags=True)
        _end(p, name, token)
        return n.Group(body)
    layout = LAYOUTS.get(name.removesuffix("*") if name in _STARRED_MATRIX else name)
    if layout is None:
        known = [*LAYOUTS, *_TRANSPARENT, *_STARRED_MATRIX]
        raise p.lexer.error(f"unknown environment {name}{nearest(name, known, '')}", start)
    align = layout.align
    vlines: list[int] = []
    if name in _STARRED_MATRIX and (option := p.lexer.raw_option()):
        align, _ = _columns(p, option, "one column", 1)
    if name == "array":
        p.lexer.raw_option()
    if name in ("array", "subarray"):
        align, vlines = _columns(p, p.lexer.raw_argument(f"\\begin{{{name}}}"), "columns", MAX_COLUMNS)
    if name in _WITH_NUMBER:
        p.lexer.raw_argument(f"\\begin{{{name}}}")
    rows, hlines = _rows(p, layout, token)
    _end(p, name, token)
    limit = len(align) if name == "array" else layout.columns
    return _grid(p, token, name, layout, align, rows, vlines, hlines, limit)


def substack(p: Parser, token: Token) -> n.Node:
    """``\\substack{a \\\\ b}``"""
    opened = p.lexer.next()
    if not opened.is_char("{"):
        raise p.error("\\substack needs an argument in braces", opened)
    layout = LAYOUTS["subarray"]
    rows, hlines = _rows(p, layout, token)
    p.close_brace(opened)
    return _grid(p, token, "substack", layout, "c", rows, [], hlines, 1)


def braced(p: Parser, token: Token, name: str) -> n.Node:
    """Plain TeX's form of an environment: ``\\matrix{a & b \\cr c & d}``."""
    opened = p.lexer.next()
    if not opened.is_char("{"):
        raise p.error(f"{token} needs an argument in braces", opened)
    layout = LAYOUTS[name]
    rows, hlines = _rows(p, layout, token)
    p.close_brace(opened)
    return _grid(p, token, name, layout, layout.align, rows, [], hlines, layout.columns)


def _columns(p: Parser, raw: tuple[str, int], what: str, most: int) -> tuple[str, list[int]]:
    """``{l|cr}``: the alignment of each column, and after how many columns lines stand."""
    text, start = raw
    align, vlines = "", []
    for i, char in enumerate(text):
        if char in "lcr":
            align += char
        elif char == "|":
            vlines.append(len(align))
        elif not char.isspace():
            raise p.lexer.error(f"unknown column type {char}: known are l, c, r and |", start + i)
    if not 1 <= len(align) <= most:
        raise p.lexer.error(f"{what} expected here, one of l, c, r for each, found {text or 'nothing'}", start)
    return align, vlines


def _rows(p: Parser, layout: Layout, opened: Token) -> tuple[list[n.Row], list[int]]:
    """Cells up to the end of the environment; a last row without content does not count."""
    rows: list[n.Row] = [n.Row([])]
    hlines: list[int] = []
    while True:
        while not rows[-1].cells and p.lexer.peek().is_command("hline"):
            p.lexer.next()
            hlines.append(len(rows) - 1)
        cell = p.items(tags=layout.tags)
        for node in [node for node in cell if isinstance(node, n.TagNode)]:
            if rows[-1].tag:
                raise p.lexer.error("a second \\tag in one row", node.start)
            rows[-1].tag = node.tag
            cell.remove(node)
        rows[-1].cells.append(cell)
        token = p.lexer.peek()
        if token.is_char("&"):
            p.lexer.next()
        elif token.is_command("\\", "cr", "tabularnewline"):
            p.lexer.next()
            rows[-1].space = _row_space(p)
            rows.append(n.Row([]))
        elif token.is_command("hline"):
            raise p.error("\\hline stands between rows: write \\\\ before it", token)
        elif token.is_command("end") or token.is_char("}"):
            break
        elif token.kind == "end":
            raise p.error(f"{opened} is never closed: add its end", opened)
        else:
            raise p.leftover(token)
    if rows[-1].cells == [[]] and not rows[-1].tag:
        rows.pop()
    return rows, hlines


def _row_space(p: Parser) -> float:
    """The optional length of ``\\\\[6pt]``, in em; a bracket that holds no length is content."""
    match = re.compile(r"\*?\[([^\[\]{}]*)\]").match(p.lexer.latex, p.lexer.position, p.lexer.limit)
    em = length_in_em(match[1]) if match else None
    if match is None or em is None or abs(em) > 100:
        return 0.0
    p.lexer.position = match.end()
    return em


def _end(p: Parser, name: str, opened: Token) -> None:
    token = p.lexer.next()
    if not token.is_command("end"):
        raise p.error(f"\\begin{{{name}}} is never closed: add \\end{{{name}}}", opened)
    raw, start = p.lexer.raw_argument("\\end")
    if raw.strip() != name:
        raise p.lexer.error(f"\\begin{{{name}}} is closed by \\end{{{raw.strip()}}}", start)


def _grid(
    p: Parser,
    token: Token,
    name: str,
    layout: Layout,
    align: str,
    rows: list[n.Row],
    vlines: list[int],
    hlines: list[int],
    limit: int,
) -> n.Node:
    width = max((len(row.cells) for row in rows), default=0)
    if limit and width > limit:
        raise p.error(f"{name} has {limit} column{'s' * (limit > 1)}, a row here has {width} cells", token)
    if width > MAX_COLUMNS:
        raise p.error(f"{name} with {width} columns: more than {MAX_COLUMNS} are not supported", token)
    width = len(align) if name == "array" else width
    for number, row in enumerate(rows):
        row.cells += [[] for _ in range(width - len(row.cells))]
        if layout.aligned:
            row.cells = [[n.Group([]), *c] if i % 2 else c for i, c in enumerate(row.cells)]
        if name.startswith("multline") and number:
            row.cells[0] = [n.Space(2.0), n.Group([]), *row.cells[0]]
    align = (align * max(1, width))[:width] if len(align) < width else align[:width]
    return n.MathArray(
        rows=rows,
        align=align,
        gap=layout.gap,
        row_gap=layout.row_gap,
        left=layout.left,
        right=layout.right,
        vlines=vlines,
        hlines=hlines,
        style=layout.style,
        aligned=layout.aligned,
    )
