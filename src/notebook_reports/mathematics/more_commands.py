r"""Commands that people write in notebooks and that are no core LaTeX: plain TeX's forms, MathJax's extensions,
chemistry and units. Each is a small function, collected in `MORE`; what holds for the rest of its group is in
`SWITCHES`.
"""

import re
from collections.abc import Callable

from notebook_reports.mathematics import chemistry, environments, units
from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics.colours import NAMES, colour
from notebook_reports.mathematics.errors import nearest
from notebook_reports.mathematics.lexer import Lexer, Token
from notebook_reports.mathematics.parser import Handler, Parser, Switch

SIZES = {"tiny": 0.5, "scriptsize": 0.7, "Tiny": 0.6, "footnotesize": 0.8, "small": 0.85, "normalsize": 1.0}
SIZES |= {"large": 1.2, "Large": 1.44, "LARGE": 1.73, "huge": 2.07, "Huge": 2.49}
OLD_GRIDS = {"matrix": "matrix", "pmatrix": "pmatrix", "bmatrix": "bmatrix", "vmatrix": "vmatrix", "cases": "cases"}
OLD_GRIDS |= {"eqalign": "aligned", "eqalignno": "aligned", "displaylines": "gathered", "smallmatrix": "smallmatrix"}


def _read(p: Parser, latex: str) -> n.Node:
    """LaTeX that a command stands for."""
    return n.Group(Parser(Lexer(latex), p.vocabulary, "", p.depth + 1).formula())


def _old_grid(p: Parser, token: Token) -> n.Node:
    r"""``\matrix{a & b \cr c & d}``"""
    return environments.braced(p, token, OLD_GRIDS[token.text])


def _root(p: Parser, token: Token) -> n.Node:
    r"""``\root 3 \of x``"""
    index: list[n.Node] = []
    while not p.lexer.peek().is_command("of"):
        if p.lexer.peek().kind == "end" or p.lexer.peek().is_char("}&"):
            raise p.error("\\root is followed by its index and \\of: \\root 3 \\of x", token)
        node = p.scripted()
        index += [node] if node is not None else []
    p.lexer.next()
    return n.Root(p.argument(token), index)


def _build(p: Parser, token: Token) -> n.Node:
    r"""``\buildrel a \over =``"""
    above: list[n.Node] = []
    while not p.lexer.peek().is_command("over"):
        if p.lexer.peek().kind == "end" or p.lexer.peek().is_char("}&"):
            raise p.error("\\buildrel is followed by what stands above and \\over: \\buildrel a \\over =", token)
        node = p.scripted()
        above += [node] if node is not None else []
    p.lexer.next()
    return n.Stack(p.argument(token), above, None, "rel")


def _option_of_colour(p: Parser, token: Token) -> str:
    """``{red}``, ``{#ff0000}``, ``[rgb]{1,0,0}``: "#rrggbb"."""
    model = p.lexer.raw_option()
    raw, start = p.lexer.raw_argument(str(token))
    found = colour(raw, model[0] if model else "")
    if found is None:
        hint = nearest(raw.strip(), NAMES, "")
        raise p.lexer.error(f"unknown colour {raw.strip()}{hint}; known: {', '.join(NAMES)} and #rrggbb", start)
    return found


def _coloured(p: Parser, token: Token) -> n.Node:
    told = _option_of_colour(p, token)
    return n.Colored(p.argument(token), told)


def _color_switch(p: Parser, token: Token) -> Callable[[list[n.Node]], n.Node] | n.Node:
    r"""``\color{red} x`` for the rest of its group, or, as MathJax has it, ``\color{red}{x}``."""
    told = _option_of_colour(p, token)
    if p.lexer.peek().is_char("{"):
        return n.Colored(p.argument(token), told)
    return lambda rest: n.Colored(rest, told)


def _size_switch(p: Parser, token: Token) -> Callable[[list[n.Node]], n.Node]:
    return lambda rest: n.Sized(rest, SIZES[token.text])


SWITCHES: dict[str, Switch] = {
    "color": _color_switch,
    **dict.fromkeys(SIZES, _size_switch),
}
"""What holds for the rest of a group: from a command to what makes one node of the rest."""


def _nothing(arguments: int, option: bool = False) -> Handler:
    """A command that shows nothing, and its arguments with it."""

    def read(p: Parser, token: Token) -> None:
        p.lexer.take("*")
        if option:
            p.lexer.raw_option()
        for _ in range(arguments):
            p.lexer.raw_argument(str(token))

    return read


def _content(before: int, option: bool = False) -> Handler:
    """A command that shows its last argument. before: how many others it has."""

    def read(p: Parser, token: Token) -> n.Node:
        if option:
            p.lexer.raw_option()
        for _ in range(before):
            p.lexer.raw_argument(str(token))
        return n.Group(p.argument(token))

    return read


def _logo(name: str) -> Handler:
    return lambda p, token: n.MathText(name)


def _bracket(left: str, right: str) -> Handler:
    def read(p: Parser, token: Token) -> n.Node:
        raw, start = p.lexer.raw_argument(str(token))
        return n.Fenced(left, _with_bars(p.sub(start, start + len(raw)).formula()), right)

    return read


def _with_bars(items: list[n.Node]) -> list[n.Node]:
    bars = {"|", "∣"}
    return [n.Middle("|") if isinstance(i, n.Symbol) and i.char in bars else i for i in items]


def _chemistry(p: Parser, token: Token) -> n.Node:
    raw, _ = p.lexer.raw_argument(str(token))
    return _read(p, chemistry.latex_of(raw))


def _quantity(p: Parser, token: Token) -> n.Node:
    p.lexer.raw_option()
    number, _ = p.lexer.raw_argument(str(token))
    unit, _ = p.lexer.raw_argument(str(token))
    return _read(p, rf"{units.latex_of_number(number)}\,{units.latex_of_unit(unit)}")


def _one(read: Callable[[str], str]) -> Handler:
    def handler(p: Parser, token: Token) -> n.Node:
        p.lexer.raw_option()
        raw, _ = p.lexer.raw_argument(str(token))
        return _read(p, read(raw))

    return handler


def _unicode(p: Parser, token: Token) -> n.Node:
    r"""``\unicode{x2022}``"""
    p.lexer.raw_option()
    raw, start = p.lexer.raw_argument(str(token))
    found = re.fullmatch(r"\s*(?:[xX]([0-9A-Fa-f]+)|(\d+))\s*", raw)
    code = (int(found[1], 16) if found[1] else int(found[2])) if found else -1
    if not 32 <= code < 0x110000 or not chr(code).isprintable():
        raise p.lexer.error(f"\\unicode needs the code of a character, got {raw}", start)
    return n.MathText(chr(code))


def _verb(p: Parser, token: Token) -> n.Node:
    at = token.end
    if at >= p.lexer.limit:
        raise p.error("\\verb needs a text between two equal characters", token)
    end = p.lexer.latex.find(p.lexer.latex[at], at + 1, p.lexer.limit)
    if end < 0:
        raise p.error("\\verb is never closed", token)
    p.lexer.position = end + 1
    return n.MathText(p.lexer.latex[at + 1 : end], "mono")


def _enclose(p: Parser, token: Token) -> n.Node:
    raw, _ = p.lexer.raw_argument(str(token))
    p.lexer.raw_option()
    body = p.argument(token)
    if "strike" in raw:
        return n.Cancel(body, "cancel")
    return n.Boxed(body)


def _boxed(before: int) -> Handler:
    def read(p: Parser, token: Token) -> n.Node:
        p.lexer.raw_option()
        for _ in range(before):
            p.lexer.raw_argument(str(token))
        return n.Boxed(p.argument(token))

    return read


def _under_arrow(char: str) -> Handler:
    return lambda p, token: n.Stack(p.argument(token), None, [n.Symbol(char, "rel")], "ord")


def _sideset(p: Parser, token: Token) -> n.Node:
    """The scripts at the left of a large operator, then those at its right."""
    left, right = p.argument(token), p.argument(token)
    return n.Group([*left, p.scripted() or n.Group([]), *right])


MORE: dict[str, Handler] = {
    **dict.fromkeys(OLD_GRIDS, _old_grid),
    "root": _root,
    "buildrel": _build,
    "textcolor": _coloured,
    "require": _nothing(1),
    "label": _nothing(1),
    "vspace": _nothing(1),
    "rule": _nothing(2, option=True),
    "definecolor": _nothing(3),
    "bibliography": _nothing(1),
    **dict.fromkeys(("hfill", "hfil", "vfill", "noindent", "centering", "protect", "par", "newline"), _nothing(0)),
    **dict.fromkeys(("smallskip", "medskip", "bigskip", "allowdisplaybreaks", "limits", "nolimits"), _nothing(0)),
    **dict.fromkeys(("smash",), _content(0, option=True)),
    **dict.fromkeys(("llap", "rlap", "mathllap", "mathrlap", "mathclap", "ensuremath"), _content(0)),
    **dict.fromkeys(("href", "class", "cssId", "style", "raisebox", "colorbox", "data"), _content(1)),
    "bbox": _boxed(0),
    "fcolorbox": _boxed(2),
    "enclose": _enclose,
    "LaTeX": _logo("LaTeX"),
    "TeX": _logo("TeX"),
    "bra": _bracket("⟨", "|"),
    "ket": _bracket("|", "⟩"),
    "Bra": _bracket("⟨", "|"),
    "Ket": _bracket("|", "⟩"),
    "braket": _bracket("⟨", "⟩"),
    "Braket": _bracket("⟨", "⟩"),
    "Set": _bracket("{", "}"),
    "abs": _bracket("|", "|"),
    "norm": _bracket("‖", "‖"),
    "ce": _chemistry,
    "cee": _chemistry,
    **dict.fromkeys(("SI", "qty"), _quantity),
    **dict.fromkeys(("si", "unit"), _one(units.latex_of_unit)),
    "num": _one(units.latex_of_number),
    "ang": _one(units.latex_of_angle),
    "unicode": _unicode,
    "verb": _verb,
    "underrightarrow": _under_arrow("→"),
    "underleftarrow": _under_arrow("←"),
    "sideset": _sideset,
}
