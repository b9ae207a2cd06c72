"""The words of a formula, and the error that says which of them is wrong."""

import re
from typing import NamedTuple

from notebook_reports.errors import PressError
from notebook_reports.formula.size import LENGTH
from notebook_reports.mathematics.errors import excerpt

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)|(?P<name>[^\W\d]\w*)"
    r"|(?P<sign>\*\*|[-+*/^()\[\],;=])|(?P<strange>\S))"
)
_ALIKE = str.maketrans({"−": "-", "·": "*", "×": "*"})


class FormulaError(PressError, ValueError):
    """A formula that cannot be read. text: all of it. position: the 0-based index of what is wrong. reason: why.

    >>> print(FormulaError('a name is expected, not "*"', "a +* b", 3, "table_5.toml, claim slope"))
    table_5.toml, claim slope, character 4: a name is expected, not "*"
      a +* b
         ^
    """

    def __init__(self, reason: str, text: str, position: int, where: str = ""):
        self.reason, self.text, self.position, self.where = reason, text, position, where
        place = f"{where}, character" if where else "character"
        super().__init__(f"{place} {position + 1}: {reason}\n{excerpt(text, position)}")


class UnknownName(FormulaError):
    """A formula uses a name, a function or a sample that is not among those it may use."""


class Lexeme(NamedTuple):
    """kind: number, name, sign or end. position: 0-based, in the text."""

    kind: str
    text: str
    position: int


def lexemes(text: str, where: str = "") -> list[Lexeme]:
    """The words of a text, and the end. Raises FormulaError for a sign that no formula has and for too long a text.

    >>> [word.text for word in lexemes("2*y[k-1]")]
    ['2', '*', 'y', '[', 'k', '-', '1', ']', 'the end']
    """
    if len(text) > LENGTH:
        raise FormulaError(f"a formula has at most {LENGTH} characters", text, LENGTH, where)
    found = []
    for match in _TOKEN.finditer(text.translate(_ALIKE)):
        kind = str(match.lastgroup)
        word = Lexeme(kind, match[kind], match.start(kind))
        if kind == "strange" or (kind == "name" and not word.text.isidentifier()):
            raise FormulaError(f'"{word.text}" is no part of a formula', text, word.position, where)
        found.append(word)
    return [*found, Lexeme("end", "the end", len(text.rstrip()))]
