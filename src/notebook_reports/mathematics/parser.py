"""Tokens into the tree of `nodes`: groups, scripts, letters, numbers and delimiters.

What each command does is in `commands`, environments are in `environments`, text is in `textmode`.
"""

import unicodedata
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics import symbols
from notebook_reports.mathematics.alphabets import combine, styled
from notebook_reports.mathematics.errors import MathError, nearest
from notebook_reports.mathematics.lexer import Lexer, Token

MAX_DEPTH = 40
_WORD_FONTS = {"normal", "bold", "italic", "sans", "mono"}
_CLASS_OF_CHAR = dict(symbols.SYMBOLS.values()) | dict(symbols.CHARACTERS.values())
_LARGE_CHARS = dict.fromkeys(symbols.LARGE.values(), True) | dict.fromkeys(symbols.INTEGRALS.values(), False)


Handler = Callable[["Parser", Token], n.Node | None]
Switch = Callable[["Parser", Token], Callable[[list[n.Node]], n.Node] | n.Node]


class Vocabulary(NamedTuple):
    """What each command does: those before their arguments, those between them, those for the rest of a group, tags."""

    commands: Mapping[str, Handler]
    infix: Mapping[str, Callable[[list[n.Node], list[n.Node]], n.Node]]
    switches: Mapping[str, Switch]
    tag: Callable[["Parser", Token], n.TagNode]


class Parser:
    """Recursive descent over a `Lexer`.

    font: the alphabet in force. operator_name: inside ``\\operatorname``, where a hyphen is a hyphen.
    """

    def __init__(self, lexer: Lexer, vocabulary: Vocabulary, font: str = "", depth: int = 0):
        self.lexer = lexer
        self.vocabulary = vocabulary
        self.font = font
        self.depth = depth
        self.operator_name = False

    def formula(self) -> list[n.Node]:
        """The whole input; anything left over is an error."""
        found = self.items(tags=True)
        token = self.lexer.peek()
        if token.kind != "end":
            raise self.leftover(token)
        return found

    def error(self, reason: str, token: Token) -> MathError:
        return self.lexer.error(reason, token.position)

    def leftover(self, token: Token) -> MathError:
        """The error for a token that ends a list where nothing is open that it could end."""
        reasons = {
            "}": "} without {: remove it or add {",
            "&": "& outside of a matrix or an aligned environment: write \\& for the character",
            "\\\\": "\\\\ outside of an environment: put the lines into \\begin{aligned} … \\end{aligned}",
            "\\cr": "\\cr outside of an environment",
            "\\tabularnewline": "\\tabularnewline outside of an environment",
            "\\right": "\\right without \\left",
            "\\middle": "\\middle that is not directly between \\left and \\right",
            "\\end": "\\end without \\begin",
            "\\hline": "\\hline outside of an array",
        }
        return self.error(reasons[str(token)], token)

    @contextmanager
    def nested(self, token: Token) -> Iterator[None]:
        """One level deeper; font switches end with the level."""
        if self.depth >= MAX_DEPTH:
            raise self.error(f"nested deeper than {MAX_DEPTH} levels: name a part and write it separately", token)
        font = self.font
        self.depth += 1
        yield
        self.depth -= 1
        self.font = font

    # -- lists ---------------------------------------------------------------------------------------------------

    def items(self, in_fence: bool = False, tags: bool = False) -> list[n.Node]:
        """A horizontal list up to a token that only the caller can judge, such as } & or \\end."""
        found: list[n.Node] = []
        with self.nested(self.lexer.peek()):
            while True:
                token = self.lexer.peek()
                if token.kind == "end" or token.is_char("}&"):
                    return found
                if token.is_command("\\", "cr", "right", "end", "hline", "tabularnewline"):
                    return found
                if token.is_command("middle"):
                    if not in_fence:
                        return found
                    self.lexer.next()
                    found.append(n.Middle(self.delimiter(token)))
                elif in_fence and (middle := self.braced_middle()):
                    found.append(middle)
                elif token.is_command(*self.vocabulary.infix):
                    self.lexer.next()
                    rest = self.items(in_fence)
                    if any(isinstance(item, n.Middle) for item in found + rest):
                        raise self.error(f"{token} and \\middle in one group: put {token} into braces", token)
                    return [self.vocabulary.infix[token.text](found, rest)]
                elif token.is_command(*self.vocabulary.switches):
                    self.lexer.next()
                    switched = self.vocabulary.switches[token.text](self, token)
                    if isinstance(switched, n.Node):
                        if (scripted := self.with_scripts(switched)) is not None:
                            found.append(scripted)
                        continue
                    rest = self.items(in_fence, tags)
                    held = [item for item in rest if isinstance(item, n.TagNode | n.Middle)]
                    return [*found, switched([item for item in rest if item not in held]), *held]
                elif token.is_command("tag"):
                    self.lexer.next()
                    if not tags:
                        raise self.error("\\tag inside a group or matrix: move it to the end of its line", token)
                    found.append(self.vocabulary.tag(self, token))
                else:
                    node = self.scripted()
                    if node is not None:
                        found.append(node)

    def braced_middle(self) -> n.Middle | None:
        """``{\\middle|}``: no valid TeX, but what SymPy writes between the vectors of a dot product."""
        start = self.lexer.position
        if self.lexer.take("{") and self.lexer.peek().is_command("middle"):
            found = n.Middle(self.delimiter(self.lexer.next()))
            if self.lexer.take("}"):
                return found
        self.lexer.position = start
        return None

    def argument(self, command: Token) -> list[n.Node]:
        """The argument of a command or script: a group, or the next single character or command."""
        token = self.lexer.next()
        if token.is_char("{"):
            found = self.items()
            self.close_brace(token)
            return found
        if token.kind == "end" or token.is_char("}&^_'") or token.is_command("\\", "cr", "right", "end", "middle"):
            raise self.error(f"{command} needs an argument, found {token}", token)
        with self.nested(token):
            node = self.atom(token, single=True)
        return [] if node is None else [node]

    def option(self) -> list[n.Node] | None:
        """An optional argument in square brackets."""
        raw = self.lexer.raw_option()
        if raw is None:
            return None
        text, start = raw
        return self.sub(start, start + len(text)).formula()

    def sub(self, start: int, end: int) -> "Parser":
        """A parser of a stretch of the same formula, so that positions stay true."""
        return Parser(Lexer(self.lexer.latex, start, end), self.vocabulary, self.font, self.depth + 1)

    def close_brace(self, opened: Token) -> None:
        token = self.lexer.peek()
        if token.is_char("}"):
            self.lexer.next()
        elif token.kind == "end":
            raise self.error("{ is never closed: add }", opened)
        else:
            raise self.leftover(token) if str(token) != "\\end" else self.error("\\end inside { … }: add }", token)

    # -- atoms ---------------------------------------------------------------------------------------------------

    def scripted(self) -> n.Node | None:
        """One atom with its scripts, or None for a command that shows nothing."""
        token = self.lexer.peek()
        base = n.Group([]) if token.is_char("^_'") else self.atom(self.lexer.next())
        return self.with_scripts(base)

    def with_scripts(self, base: n.Node | None) -> n.Node | None:
        """A node with the scripts that follow it."""
        if base is None or isinstance(base, n.Space | n.StyleSwitch):
            return base
        found = n.Scripts(base)
        while True:
            token = self.lexer.peek()
            if token.is_command("limits", "nolimits", "displaylimits"):
                if not takes_limits(base):
                    raise self.error(f"{token} must follow an operator such as \\sum, \\int or \\lim", token)
                self.lexer.next()
                found.limits = {"limits": True, "nolimits": False}.get(token.text)
            elif token.is_char("_"):
                if found.sub is not None:
                    raise self.error("two subscripts on one base: use braces", token)
                found.sub = self.argument(self.lexer.next())
            elif token.is_char("^"):
                if found.sup is not None:
                    raise self.error("two superscripts on one base: use braces", token)
                found.sup = self.argument(self.lexer.next())
            elif token.is_char("'"):
                if found.sup is not None:
                    raise self.error("a prime after a superscript: write the prime first or use braces", token)
                self.lexer.next()
                found.primes += 1
            else:
                break
        plain = found.sub is None and found.sup is None and not found.primes
        return base if plain else found

    def atom(self, token: Token, single: bool = False) -> n.Node | None:
        """The node that starts with this (already consumed) token. single: a digit or letter stands alone."""
        if token.kind == "command":
            return self.command(token)
        char = token.text
        if char == "{":
            found = self.items()
            self.close_brace(token)
            return _group(found)
        if char in "^_'":
            raise self.error(f"{char} is not expected here", token)
        if char == "~":
            return n.Space(symbols.SPACES["nobreakspace"])
        if char == "#":
            raise self.error("# is not a mathematical character: write \\# for the character", token)
        if char == "$":
            raise self.error("a dollar sign inside a formula: write \\$ for the character", token)
        if char.isascii() and char.isdigit():
            return self.number(token, single)
        if self.is_letter(char):
            return self.letters(token, single)
        if char in symbols.CHARACTERS:
            return n.Symbol(*symbols.CHARACTERS[char])
        return self.symbol(char, token)

    def symbol(self, char: str, token: Token) -> n.Symbol:
        """A character beyond ASCII that stands for itself."""
        if char in _LARGE_CHARS:
            return n.Symbol(char, "op", large=True, limits=_LARGE_CHARS[char])
        if char in _CLASS_OF_CHAR:
            return n.Symbol(char, _CLASS_OF_CHAR[char])
        if char.isalpha() and unicodedata.normalize("NFC", char) == char:
            return n.Symbol(char, upright=True)
        if unicodedata.category(char) == "No" and char.isprintable():
            return n.Symbol(char, upright=True)
        shown = char if char.isprintable() else "?"
        raise self.error(f"unknown character {shown} (U+{ord(char):04X}): write it in \\text{{…}} if it is text", token)

    def is_letter(self, char: str) -> bool:
        if self.operator_name and char in "-*/.":
            return True
        return (char.isascii() and char.isalpha()) or "α" <= char <= "ω" or "Α" <= char <= "Ω" or char in "ϑϕϖϱϵϰıȷ"

    def letters(self, token: Token, single: bool) -> n.Node:
        """A letter; in an alphabet for words (\\mathrm) all letters and digits that follow."""
        run = token.text
        while self.font in _WORD_FONTS and not single:
            following = self.lexer.peek()
            if following.kind != "char" or not (self.is_letter(following.text) or following.text in "0123456789"):
                break
            run += self.lexer.next().text
        if len(run) > 1:
            return n.Word("".join(styled(c, self.font) or c for c in run))
        char = styled(run, self.font)
        if char is not None:
            return n.Symbol(char)
        return n.Symbol(run, upright=self.font == "normal" or "Α" <= run <= "Ω" or not run.isalpha())

    def number(self, token: Token, single: bool) -> n.Node:
        """Digits; a point or a comma in braces between digits is the decimal separator."""
        text = token.text
        separator = ""
        while not single:
            following = self.lexer.peek()
            if following.kind == "char" and following.text in "0123456789":
                text += self.lexer.next().text
                continue
            rest = self.lexer.latex[following.position : min(following.position + 4, self.lexer.limit)]
            mark = next((m for m in (".", "{,}") if rest.startswith(m) and rest[len(m) :][:1].isdecimal()), "")
            if not mark or separator or not rest[len(mark)].isascii():
                break
            separator = mark.strip("{}")
            self.lexer.position = following.position + len(mark)
            text += separator
        if styled("0", self.font) and self.font != "normal":
            return n.Word("".join(styled(c, self.font) or c for c in text))
        return n.Number(text)

    # -- commands ------------------------------------------------------------------------------------------------

    def command(self, token: Token) -> n.Node | None:
        name = token.text
        if name in symbols.SYMBOLS:
            return n.Symbol(*symbols.SYMBOLS[name])
        if name in symbols.GREEK:
            return self.letters(Token("char", symbols.GREEK[name], token.position, token.end), single=True)
        if name in self.vocabulary.commands:
            return self.vocabulary.commands[name](self, token)
        if token.is_command("\\", "cr", "tabularnewline", "right", "end", "middle", "hline"):
            raise self.leftover(token)
        if token.is_command("tag", *self.vocabulary.infix):
            raise self.error(f"{token} cannot be an argument by itself: put the argument into braces", token)
        words = self.vocabulary
        known = {*symbols.SYMBOLS, *symbols.GREEK, *words.commands, *words.infix, *words.switches, "left", "tag"}
        raise self.error(f"unknown command {token}{nearest(name, known)}", token)

    def with_font(self, font: str, command: Token) -> list[n.Node]:
        """The argument of a font command."""
        before, self.font = self.font, combine(self.font, font)
        found = self.argument(command)
        self.font = before
        return found

    def delimiter(self, command: Token) -> str:
        """The delimiter after ``\\left`` and its kin; "" for the invisible one."""
        token = self.lexer.next()
        if token.is_char("{") and command.text != "left":
            inner = self.delimiter(command)
            self.close_brace(token)
            return inner
        if str(token) not in symbols.DELIMITERS:
            known = [d.removeprefix("\\") for d in symbols.DELIMITERS if d.startswith("\\")]
            hint = nearest(token.text, known) if token.kind == "command" else ""
            raise self.error(f"{command} needs a delimiter such as ( [ \\{{ | or . , found {token}{hint}", token)
        return symbols.DELIMITERS[str(token)]

    def fenced(self, token: Token) -> n.Node:
        """``\\left( … \\right)``"""
        left = self.delimiter(token)
        body = self.items(in_fence=True)
        closing = self.lexer.peek()
        if not closing.is_command("right"):
            if closing.kind == "end" or closing.is_char("}&") or closing.is_command("end", "\\"):
                raise self.error("\\left is never closed: add \\right with a delimiter or \\right.", token)
            raise self.leftover(closing)
        self.lexer.next()
        return n.Fenced(left, body, self.delimiter(closing))


def takes_limits(node: n.Node) -> bool:
    """Whether ``\\limits`` may follow."""
    match node:
        case n.Symbol():
            return node.large
        case n.Classed():
            return node.cls == "op"
        case _:
            return isinstance(node, n.Operator | n.Brace)


def _group(items: list[n.Node]) -> n.Node:
    """A group of one growing pair of delimiters, or of one ordinary atom, is that atom."""
    if len(items) == 1 and isinstance(items[0], n.Fenced | n.Number | n.Word | n.Fraction | n.Root | n.Group):
        return items[0]
    if len(items) == 1 and isinstance(items[0], n.Symbol) and items[0].cls == "ord":
        return items[0]
    return n.Group(items)
