"""Text inside formulas: ``\\text{for $x > 0$}``. Spaces count, mathematics stands between dollar signs."""

import unicodedata

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics import symbols
from notebook_reports.mathematics.errors import nearest
from notebook_reports.mathematics.lexer import Lexer, Token
from notebook_reports.mathematics.parser import Parser

_CHARACTERS = {
    **symbols.ESCAPES,
    **{"{": "{", "}": "}", " ": " ", "quad": "\u2003", "qquad": "\u2003\u2003", ",": "\u2009", ";": "\u2005"},
    **{"textbackslash": "\\", "textdegree": "°", "degree": "°", "ldots": "…", "dots": "…", "textellipsis": "…"},
    **{"textendash": "–", "textemdash": "—", "textbar": "|", "textunderscore": "_", "textless": "<"},
    **{"textgreater": ">", "textmu": "µ", "textquotesingle": "'", "slash": "/", "S": "§", "P": "¶", "copyright": "©"},
    **{name: symbols.ORDINARY[name] for name in ("AA", "O", "o", "ae", "AE", "oe", "OE", "ss", "l", "L")},
}


def text(p: Parser, start: int, end: int, variant: str) -> list[n.Node]:
    """The nodes of the text between two positions of the formula."""
    lexer = p.lexer
    found: list[n.Node] = []
    run = ""
    i = start
    if p.depth > 38:
        raise lexer.error("text nested too deeply", start)

    def flush() -> None:
        nonlocal run
        if run:
            found.append(n.MathText(run, variant))
            run = ""

    while i < end:
        char = lexer.latex[i]
        if char == "$":
            close = _closing_dollar(lexer, i, end)
            flush()
            inner = p.sub(i + 1, close)
            inner.font = ""
            found.append(n.Group(inner.formula()))
            i = close + 1
        elif char == "\\":
            token = Lexer(lexer.latex, i, end).peek()
            i = token.end
            if token.text in symbols.TEXT_FONTS:
                inner_lexer = Lexer(lexer.latex, i, end)
                raw, at = inner_lexer.raw_argument(str(token))
                flush()
                p.depth += 1
                inner_variant = symbols.TEXT_FONTS[token.text]
                found += text(p, at, at + len(raw), variant if inner_variant == "normal" else inner_variant)
                p.depth -= 1
                i = inner_lexer.position
            else:
                run += _command(lexer, token)
                if token.text[0].isalpha():
                    while i < end and lexer.latex[i] in " \t\n\r":
                        i += 1
        elif char == "%":
            line = lexer.latex.find("\n", i, end)
            i = end if line < 0 else line + 1
        else:
            if char == "~":
                run += "\u00a0"
            elif char in " \t\n\r":
                run += "" if run.endswith(" ") else " "
            elif char not in "{}":
                run += _printable(lexer, char, i)
            i += 1
    flush()
    return found


def plain(p: Parser, start: int, end: int, command: str) -> list[str]:
    """The text between two positions where mathematics is not allowed."""
    found = []
    for node in text(p, start, end, "normal"):
        if not isinstance(node, n.MathText):
            raise p.lexer.error(f"{command} takes plain text without formulas", start)
        found.append(node.text)
    return found


def _closing_dollar(lexer: Lexer, i: int, end: int) -> int:
    close = i + 1
    while close < end and lexer.latex[close] != "$":
        close += 2 if lexer.latex[close] == "\\" else 1
    if close >= end:
        raise lexer.error("$ in text is never closed: add $ or write \\$", i)
    return close


def _command(lexer: Lexer, token: Token) -> str:
    if token.text in _CHARACTERS:
        return _CHARACTERS[token.text]
    known = {**_CHARACTERS, **symbols.TEXT_FONTS}
    raise lexer.error(
        f"unknown command {token} in text{nearest(token.text, known)}; put mathematics between $ signs", token.position
    )


def _printable(lexer: Lexer, char: str, position: int) -> str:
    if unicodedata.category(char)[0] == "C":
        raise lexer.error(f"unprintable character U+{ord(char):04X} in text", position)
    return char
