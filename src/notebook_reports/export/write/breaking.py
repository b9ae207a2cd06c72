r"""Where a displayed formula may go on in a new line: before a relation or an operator that stands in no bracket."""

import re

_TOKEN = re.compile(r"\\not(?![A-Za-z])\s*(?:\\[A-Za-z]+|[^\\{\s])|\\[A-Za-z]+|\\.|\s+|.", re.DOTALL)
_RELATIONS = frozenset(
    re.findall(
        r"\S+",
        r"""= < > \le \leq \ge \geq \lt \gt \ne \neq \approx \approxeq \sim \simeq \equiv \cong \propto \ll \gg \lesssim
        \gtrsim \to \rightarrow \Rightarrow \implies \iff \Leftrightarrow \Longrightarrow \mapsto \in""",
    )
)
_OPERATORS = {"+", "-", "−", "\\pm", "\\mp", "\\cdot", "\\times"}
_SPACES = {"\\quad", "\\qquad"}
_OPENING = {"(", "[", "{", "\\{", "\\left", "\\begin", "\\lbrace", "\\langle", "\\lvert", "\\lVert"}
_CLOSING = {")", "]", "}", "\\}", "\\right", "\\end", "\\rbrace", "\\rangle", "\\rvert", "\\rVert"}
_SPACING = {"\\displaystyle", "\\,", "\\;", "\\:", "\\!", "\\ ", "\\middle"}


def formula_pieces(latex: str) -> list[str]:
    r"""Split a formula at the places where a line may end; joined they are the formula again.

    >>> formula_pieces(r"y = a + \left(b + c\right) - d")
    ['y ', '= a ', '+ \\left(b + c\\right) ', '- d']
    >>> formula_pieces(r"e^{-a} = -b")
    ['e^{-a} ', '= -b']
    >>> formula_pieces(r"a \not= b")
    ['a ', '\\not= b']
    """
    found: list[str] = [""]
    depth = 0
    before = ""
    delimiter = False
    for token in _TOKEN.findall(latex):
        blank = token.isspace() or token in _SPACING
        if delimiter and not blank:
            found[-1] += token
            before, delimiter = ".", False
            continue
        if token in _OPENING:
            depth += 1
            delimiter = token == "\\left"
        elif token in _CLOSING:
            depth -= 1
            delimiter = token == "\\right"
        elif depth == 0 and token in ("&", "\\\\"):
            return [latex]
        elif depth == 0 and before and _may_break(token, before):
            found.append("")
        found[-1] += token
        if not blank:
            before = token
    return found if depth == 0 else [latex]


def _may_break(token: str, before: str) -> bool:
    if token in _SPACES:
        return before in {",", ";"}
    unary = before in _RELATIONS | _OPERATORS | _OPENING | {"^", "_", ",", ";"} | _SPACES
    return (token in _RELATIONS | _OPERATORS or token.startswith("\\not")) and not unary
