r"""Macros: ``\newcommand``, ``\def`` and their kin, kept from formula to formula as MathJax keeps them.

>>> macros = Macros()
>>> macros.expand(r"\newcommand{\vect}[1]{\mathbf{#1}}")
''
>>> macros.expand(r"\vect{x} \in A")
'\\mathbf{x} \\in A'
"""

import re
from dataclasses import dataclass, field

from notebook_reports.mathematics.errors import MathError

MOST = 2_000
"""Replacements in one formula; more are a macro that uses itself."""
LONGEST = 200_000
"""Characters of a formula with its macros replaced."""

_DEFINES = {"newcommand", "renewcommand", "providecommand", "newcommand*", "renewcommand*", "providecommand*"}
_KNOWN = (*_DEFINES, "def", "gdef", "edef", "xdef", "let", "DeclareMathOperator", "newenvironment", "renewenvironment")
_ANY = re.compile(r"\\(?:" + "|".join(sorted({name.rstrip("*") for name in _KNOWN})) + r")(?![A-Za-z])")
_NAME = re.compile(r"\\([A-Za-z]+|.)", re.DOTALL)
_BLANK = re.compile(r"(?:\s|%[^\n]*(?:\n|$))*")


@dataclass(frozen=True)
class Macro:
    """parameters: how many, or, for ``\\def`` with delimiters, the text between them. default: of the first one."""

    body: str
    parameters: int = 0
    default: str | None = None
    delimiters: tuple[str, ...] = ()


@dataclass
class Macros:
    """The macros and environments defined so far, by name."""

    commands: dict[str, Macro] = field(default_factory=dict)
    environments: dict[str, tuple[Macro, str]] = field(default_factory=dict)

    def expand(self, latex: str) -> str:
        """The formula without definitions, which are remembered, and with every macro replaced.

        Raises MathError for a definition that is cut short and for a macro that never ends.
        """
        if not self.commands and not self.environments and not _ANY.search(latex):
            return latex
        source, at, count = latex, 0, 0
        while found := _NAME.search(source, at):
            name = found[1]
            if name in {known.rstrip("*") for known in _KNOWN}:
                end = self._define(name, source, found.end())
                source = source[: found.start()] + source[end:]
                at = found.start()
            elif name in self.commands:
                text, end = _replaced(self.commands[name], source, found.end())
                if text[-1:].isalpha() and source[end : end + 1].isalpha() and re.search(r"\\[A-Za-z]+$", text):
                    text += " "
                source = source[: found.start()] + text + source[end:]
                at = found.start()
                count += 1
            elif name in ("begin", "end") and self.environments:
                at, source, count = self._environment(name, source, found, count)
            else:
                at = found.end()
            if count > MOST or len(source) > LONGEST:
                raise MathError("a macro that uses itself without end", latex, 0)
        return source

    def _environment(self, kind: str, source: str, found: re.Match[str], count: int) -> tuple[int, str, int]:
        name, end = _argument(source, found.end())
        if name not in self.environments:
            return end, source, count
        opening, closing = self.environments[name]
        text, end = _replaced(opening, source, end) if kind == "begin" else (closing, end)
        return found.start(), f"{source[: found.start()]}{text} {source[end:]}", count + 1

    def _define(self, name: str, source: str, at: int) -> int:
        """Remember the definition whose command ends here; where it ends."""
        if name == "let":
            target, at = _command_name(source, at)
            at = _past_blanks(source, at)
            at += source[at : at + 1] == "="
            meaning, at = _argument(source, at)
            self.commands[target] = self.commands.get(meaning.removeprefix("\\"), Macro(meaning))
            if meaning == "\\" + target:
                del self.commands[target]
            return at
        if name in ("def", "gdef", "edef", "xdef"):
            target, at = _command_name(source, at)
            open_at = source.find("{", at)
            if open_at < 0:
                raise MathError(f"\\{name} of \\{target} without its braces", source, at)
            pieces = re.split(r"#\d", source[at:open_at])
            body, end = _argument(source, open_at)
            delimited = any(piece.strip() for piece in pieces)
            self.commands[target] = Macro(body, len(pieces) - 1, None, tuple(pieces) if delimited else ())
            return end
        at += source[at : at + 1] == "*"
        if name == "DeclareMathOperator":
            starred = source[at - 1] == "*"
            target, at = _command_name(source, at)
            body, end = _argument(source, at)
            self.commands[target] = Macro(rf"\operatorname{'*' if starred else ''}{{{body}}}")
            return end
        if name in ("newenvironment", "renewenvironment"):
            target, at = _argument(source, at)
            count, default, at = _parameters(source, at)
            opening, at = _argument(source, at)
            closing, at = _argument(source, at)
            self.environments[target] = Macro(opening, count, default), closing
            return at
        target, at = _command_name(source, at)
        count, default, at = _parameters(source, at)
        body, end = _argument(source, at)
        if name != "providecommand" or target not in self.commands:
            self.commands[target] = Macro(body, count, default)
        return end


def _parameters(source: str, at: int) -> tuple[int, str | None, int]:
    """``[2][default]`` after a name."""
    count, default = 0, None
    number = re.compile(r"\s*\[\s*(\d)\s*\]").match(source, at)
    if number:
        count, at = int(number[1]), number.end()
        option = re.compile(r"\s*\[([^\]]*)\]").match(source, at)
        if option:
            default, at = option[1], option.end()
    return count, default, at


def _command_name(source: str, at: int) -> tuple[str, int]:
    """``\\name`` or ``{\\name}``."""
    found = re.compile(r"\s*(?:\{\s*\\([A-Za-z]+|.)\s*\}|\\([A-Za-z]+|.))").match(source, at)
    if found is None:
        raise MathError("a definition without the name of its command", source, at)
    return found[1] or found[2], found.end()


def _past_blanks(source: str, at: int) -> int:
    blank = _BLANK.match(source, at)
    return blank.end() if blank else at


def _argument(source: str, at: int) -> tuple[str, int]:
    """One argument: a group without its braces, a command, or a character; and where it ends."""
    at = _past_blanks(source, at)
    if at >= len(source):
        raise MathError("a macro without its argument", source, len(source))
    if source[at] != "{":
        found = _NAME.match(source, at)
        return (found[0], found.end()) if found else (source[at], at + 1)
    depth, i = 0, at
    while i < len(source):
        if source[i] == "\\":
            i += 1
        elif source[i] == "{":
            depth += 1
        elif source[i] == "}":
            depth -= 1
            if depth == 0:
                return source[at + 1 : i], i + 1
        i += 1
    raise MathError("{ is never closed: add }", source, at)


def _replaced(macro: Macro, source: str, at: int) -> tuple[str, int]:
    """The body of a macro with its arguments put in, and where these end."""
    arguments: list[str] = []
    if macro.delimiters:
        first, *rest = macro.delimiters
        at = _past_blanks(source, at) + len(first.strip())
        for delimiter in rest:
            end = source.find(delimiter.strip(), at) if delimiter.strip() else -1
            if end >= 0:
                arguments.append(source[at:end])
                at = end + len(delimiter.strip())
            else:
                argument, at = _argument(source, at)
                arguments.append(argument)
    else:
        if macro.default is not None:
            option = re.compile(r"\s*\[([^\]]*)\]").match(source, at)
            arguments.append(option[1] if option else macro.default)
            at = option.end() if option else at
        while len(arguments) < macro.parameters:
            argument, at = _argument(source, at)
            arguments.append(argument)

    def put(found: re.Match[str]) -> str:
        index = int(found[1]) - 1
        return arguments[index] if index < len(arguments) else found[0]

    return re.sub(r"#(\d)", put, macro.body), at
