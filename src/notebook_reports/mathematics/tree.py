"""LaTeX into the tree of `nodes`, with every command that is known."""

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics.commands import VOCABULARY
from notebook_reports.mathematics.lexer import Lexer
from notebook_reports.mathematics.parser import Parser


def tree(latex: str) -> list[n.Node]:
    """The tree of a formula. Raises MathError."""
    return Parser(Lexer(latex), VOCABULARY).formula()
