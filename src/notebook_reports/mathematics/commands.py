"""What each LaTeX command turns into: one small function a command, collected in `COMMANDS`."""

import unicodedata
from collections.abc import Callable
from functools import partial

from notebook_reports.mathematics import environments, symbols, textmode
from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics.alphabets import combine
from notebook_reports.mathematics.lengths import _LENGTH, length_in_em
from notebook_reports.mathematics.lexer import Token
from notebook_reports.mathematics.more_commands import MORE, SWITCHES
from notebook_reports.mathematics.parser import Handler, Parser, Vocabulary
from notebook_reports.mathematics.spacing import edges


def binomial(num: list[n.Node], den: list[n.Node], style: str = "") -> n.Node:
    return n.Fenced("(", [n.Fraction(num, den, style, line=False)], ")")


INFIX: dict[str, Callable[[list[n.Node], list[n.Node]], n.Node]] = {
    "over": n.Fraction,
    "atop": partial(n.Fraction, line=False),
    "choose": binomial,
    "brace": lambda num, den: n.Fenced("{", [n.Fraction(num, den, line=False)], "}"),
    "brack": lambda num, den: n.Fenced("[", [n.Fraction(num, den, line=False)], "]"),
}


# -- fractions, roots, accents -------------------------------------------------------------------------------------


def _fraction(p: Parser, token: Token, style: str) -> n.Node:
    if token.text == "cfrac":
        p.lexer.raw_option()
    return n.Fraction(p.argument(token), p.argument(token), style)


def _binomial(p: Parser, token: Token, style: str) -> n.Node:
    return binomial(p.argument(token), p.argument(token), style)


def _genfrac(p: Parser, token: Token) -> n.Node:
    """``\\genfrac{(}{)}{0pt}{style}{n}{k}``; the thickness is the usual one (empty) or 0pt."""
    fences = []
    for _ in range(2):
        raw, start = p.lexer.raw_argument(str(token))
        if raw.strip() and raw.strip() not in symbols.DELIMITERS:
            raise p.lexer.error(f"{token} needs a delimiter or nothing, found {raw.strip()}", start)
        fences.append(symbols.DELIMITERS.get(raw.strip(), ""))
    raw, start = p.lexer.raw_argument(str(token))
    if raw.strip() and length_in_em(raw) != 0.0:
        raise p.lexer.error(f"{token} draws a line of the usual thickness (empty) or none (0pt), got {raw}", start)
    line = not raw.strip()
    raw, start = p.lexer.raw_argument(str(token))
    styles = {"": "", "0": "display", "1": "text"}
    if raw.strip() not in styles:
        raise p.lexer.error(f"the style of {token} is empty, 0 or 1, got {raw}", start)
    body = n.Fraction(p.argument(token), p.argument(token), styles[raw.strip()], line)
    return n.Fenced(fences[0], [body], fences[1]) if any(fences) else body


def _root(p: Parser, token: Token) -> n.Node:
    index = p.option()
    return n.Root(p.argument(token), index)


def _accent(p: Parser, token: Token, name: str, wide: bool) -> n.Node:
    return n.Accent(name, p.argument(token), wide)


def _line(p: Parser, token: Token, over: bool) -> n.Node:
    return n.Line(p.argument(token), over)


def _brace(p: Parser, token: Token) -> n.Node:
    char, over = symbols.BRACES[token.text]
    return n.Brace(p.argument(token), char, over)


def _stack(p: Parser, token: Token) -> n.Node:
    first, base = p.argument(token), p.argument(token)
    cls = (edges(base[0]) or ("ord",))[0] if len(base) == 1 else "ord"
    if token.text == "stackrel":
        cls = "rel"
    return n.Stack(base, None, first, cls) if token.text == "underset" else n.Stack(base, first, None, cls)


def _arrow(p: Parser, token: Token) -> n.Node:
    under = p.option()
    return n.Arrow(symbols.LONG_ARROWS[token.text], p.argument(token), under)


# -- delimiters, operators, spaces -----------------------------------------------------------------------------------


def _big(p: Parser, token: Token) -> n.Node:
    size = token.text.rstrip("lrm")
    char = p.delimiter(token)
    cls = {"l": "open", "r": "close", "m": "rel"}.get(token.text[len(size) :], "ord")
    if token.text == size:
        named = [cls for known, cls in symbols.SYMBOLS.values() if known == char]
        cls = next((c for c in [symbols.CHARACTERS.get(char, ("", ""))[1], *named] if c in ("open", "close")), "ord")
    return n.Big(char, symbols.BIG[size], cls)


def _wide_relation(p: Parser, token: Token) -> n.Node:
    r"""amsmath's \implies, \impliedby and \iff: a long arrow with a space on both sides."""
    thick = n.Space(symbols.SPACES[";"])
    return n.Classed([thick, n.Symbol(symbols.WIDE_RELATIONS[token.text], "rel"), thick], "rel")


def _function(p: Parser, token: Token) -> n.Node:
    limits = token.text in symbols.LIMIT_FUNCTIONS
    words = symbols.LIMIT_FUNCTIONS.get(token.text, token.text).split()
    name: list[n.Node] = [n.Word(words[0])]
    for word in words[1:]:
        name += [n.Space(symbols.SPACES[","]), n.Word(word)]
    return n.Operator(name, limits)


def _operator(p: Parser, token: Token) -> n.Node:
    limits = p.lexer.take("*")
    before, p.operator_name = p.operator_name, True
    name = p.with_font("normal", token)
    p.operator_name = before
    return n.Operator(name, limits or token.text == "operatornamewithlimits")


def _limit_variant(p: Parser, token: Token) -> n.Node:
    word: list[n.Node] = [n.Word("lim")]
    return n.Operator([n.Line(word, over=token.text == "varlimsup")], limits=True)


def _mod(p: Parser, token: Token) -> n.Node:
    word, thick = n.Word("mod"), n.Space(1 / 3)
    if token.text == "bmod":
        return n.Classed([word], "bin")
    if token.text == "mod":
        return n.Group([n.Space(1.0), word, thick])
    inner = [] if token.text == "pod" else [word, thick]
    body = p.argument(token)
    return n.Group([n.Space(1.0), n.Symbol("(", "open"), *inner, *body, n.Symbol(")", "close")])


def _not(p: Parser, token: Token) -> n.Node:
    target = p.argument(token)
    if len(target) == 1 and isinstance(target[0], n.Symbol):
        negated = unicodedata.normalize("NFC", target[0].char + "\u0338")
        if len(negated) == 1:
            return n.Symbol(negated, "rel" if target[0].cls == "rel" else target[0].cls)
    raise p.error("\\not is known before relations and arrows only, such as \\not= or \\not\\in", token)


def _space(p: Parser, token: Token) -> n.Node:
    """``\\hspace{1em}``, ``\\mspace{18mu}``, ``\\kern1em``"""
    p.lexer.take("*")
    if p.lexer.peek().is_char("{"):
        raw, start = p.lexer.raw_argument(str(token))
    else:
        start = p.lexer.peek().position
        match = _LENGTH.match(p.lexer.latex, start, p.lexer.limit)
        raw = match[0] if match else ""
        p.lexer.position = start + len(raw)
    em = length_in_em(raw)
    if em is None or abs(em) > 1000:
        raise p.lexer.error(f"{token} needs a length such as 1em, 6pt or 18mu, got {raw or 'none'}", start)
    return n.Space(em)


# -- fonts, text, colour -------------------------------------------------------------------------------------------


def _font(p: Parser, token: Token) -> n.Node:
    found = p.with_font(symbols.FONTS[token.text], token)
    return found[0] if len(found) == 1 and edges(found[0]) else n.Group(found)


def _font_switch(p: Parser, token: Token) -> None:
    p.font = combine(p.font, symbols.FONT_SWITCHES[token.text])


def _text(p: Parser, token: Token) -> n.Node:
    raw, start = p.lexer.raw_or_single(str(token))
    found = textmode.text(p, start, start + len(raw), symbols.TEXT_FONTS[token.text])
    return found[0] if len(found) == 1 else n.Group(found)


# -- the rest --------------------------------------------------------------------------------------------------------


def _phantom(p: Parser, token: Token) -> n.Node:
    return n.Phantom(p.argument(token), width=token.text != "vphantom", height=token.text != "hphantom")


def _strut(p: Parser, token: Token) -> n.Node:
    return n.Phantom([n.Symbol("(", "open")], width=False)


def _cancel(p: Parser, token: Token) -> n.Node:
    return n.Cancel(p.argument(token), token.text)


def tag(p: Parser, token: Token) -> n.TagNode:
    """``\\tag{4.9}`` shows (4.9), ``\\tag*{A}`` shows A."""
    starred = p.lexer.take("*")
    raw, start = p.lexer.raw_argument(str(token))
    shown = "".join(textmode.plain(p, start, start + len(raw), str(token)))
    text = shown if starred else f"({shown})"
    return n.TagNode(n.Tag(text), shown, token.position, p.lexer.position, starred)


COMMANDS: dict[str, Handler] = {
    **dict.fromkeys(("frac",), partial(_fraction, style="")),
    **dict.fromkeys(("dfrac", "cfrac"), partial(_fraction, style="display")),
    "tfrac": partial(_fraction, style="text"),
    "binom": partial(_binomial, style=""),
    "dbinom": partial(_binomial, style="display"),
    "tbinom": partial(_binomial, style="text"),
    "genfrac": _genfrac,
    "sqrt": _root,
    **{name: partial(_accent, name=name, wide=False) for name in symbols.ACCENTS if not name.startswith("over")},
    **{name: partial(_accent, name=accent, wide=True) for name, accent in symbols.WIDE_ACCENTS.items()},
    **dict.fromkeys(("overline", "widebar"), partial(_line, over=True)),
    "underline": partial(_line, over=False),
    "underbar": partial(_line, over=False),
    **dict.fromkeys(symbols.BRACES, _brace),
    **dict.fromkeys(("overset", "underset", "stackrel"), _stack),
    **dict.fromkeys(symbols.LONG_ARROWS, _arrow),
    "left": lambda p, token: p.fenced(token),
    **{size + side: _big for size in symbols.BIG for side in ("", "l", "r", "m")},
    **{
        name: lambda p, token: n.Symbol(symbols.LARGE[token.text], "op", large=True, limits=True)
        for name in symbols.LARGE
    },
    **{name: lambda p, token: n.Symbol(symbols.INTEGRALS[token.text], "op", large=True) for name in symbols.INTEGRALS},
    **dict.fromkeys((*symbols.FUNCTIONS, *symbols.LIMIT_FUNCTIONS), _function),
    **dict.fromkeys(("operatorname", "operatornamewithlimits"), _operator),
    **dict.fromkeys(("varlimsup", "varliminf"), _limit_variant),
    **dict.fromkeys(("bmod", "mod", "pmod", "pod"), _mod),
    **dict.fromkeys(symbols.WIDE_RELATIONS, _wide_relation),
    "not": _not,
    **{name: lambda p, token: n.Space(symbols.SPACES[token.text]) for name in symbols.SPACES},
    **dict.fromkeys(("hspace", "mspace", "kern", "mkern", "hskip", "mskip"), _space),
    **dict.fromkeys(symbols.FONTS, _font),
    **dict.fromkeys(symbols.FONT_SWITCHES, _font_switch),
    **dict.fromkeys(symbols.TEXT_FONTS, _text),
    **{name: lambda p, token: n.Symbol(symbols.ITALIC_GREEK[token.text]) for name in symbols.ITALIC_GREEK},
    **{name: lambda p, token: n.Classed(p.argument(token), symbols.CLASSES[token.text]) for name in symbols.CLASSES},
    **{name: lambda p, token: n.StyleSwitch(symbols.STYLES[token.text]) for name in symbols.STYLES},
    **dict.fromkeys(("phantom", "hphantom", "vphantom"), _phantom),
    **dict.fromkeys(("strut", "mathstrut"), _strut),
    **dict.fromkeys(("boxed", "fbox"), lambda p, token: n.Boxed(p.argument(token))),
    **dict.fromkeys(("cancel", "bcancel", "xcancel", "sout"), _cancel),
    "substack": environments.substack,
    "begin": environments.begin,
    **MORE,
    **dict.fromkeys(("notag", "nonumber", "relax", "allowbreak", "nobreak", "displaylimits"), lambda p, token: None),
}

VOCABULARY = Vocabulary(COMMANDS, INFIX, SWITCHES, tag)
