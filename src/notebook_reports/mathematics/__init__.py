"""LaTeX mathematics for the PDF (Typst), for the screen (MathML) and for the ear (text).

Strict: what is not understood is a `MathError` with its position, never a guess and never left out.

>>> print(latex_to_typst(r"\\frac{a}{b}"))
frac(a, b)
"""

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics.errors import MathError
from notebook_reports.mathematics.tree import tree
from notebook_reports.mathematics.write import mathml, text, typst

__all__ = ["MathError", "extract_tag", "latex_to_mathml", "latex_to_text", "latex_to_typst"]


def latex_to_typst(latex: str, display: bool = False) -> str:
    """Typst code that stands between ``$ … $``.

    latex: mathematics without delimiters. display: whether it will be a block.
    A ``\\tag`` is shown at the end of its line; see `extract_tag` for numbers at the margin.
    Raises MathError.
    """
    return typst.emit(tree(latex), display)


def latex_to_mathml(latex: str, display: bool = False) -> str:
    """A complete ``<math>`` element in MathML Core. Raises MathError."""
    return mathml.emit(tree(latex), display)


def latex_to_text(latex: str) -> str:
    """One line of text that reads the formula: the alternative text of tagged PDF. Raises MathError.

    >>> latex_to_text(r"\\frac{a+b}{2} \\le \\sqrt{x}")
    '(a + b)/2 ≤ √x'
    """
    return text.emit(tree(latex))


def extract_tag(latex: str) -> tuple[str, str | None]:
    """The formula without its one ``\\tag{…}``, and the tag's text without parentheses; None if it has none.

    Tags in the rows of an environment and ``\\tag*`` stay where they are: the emitters show them.
    Raises MathError, also where a formula of one line has two tags.

    >>> extract_tag(r"u = K e \\tag{4.9}")
    ('u = K e', '4.9')
    """
    tags = [node for node in _top_level(tree(latex)) if isinstance(node, n.TagNode)]
    if len(tags) > 1:
        raise MathError("a second \\tag for one line", latex, tags[1].start)
    if not tags or tags[0].starred:
        return latex, None
    tag = tags[0]
    return f"{latex[: tag.start].rstrip()} {latex[tag.end :].lstrip()}".strip(), tag.content


def _top_level(items: list[n.Node]) -> list[n.Node]:
    """The list, with the lists of ``\\begin{equation}`` opened."""
    return [node for item in items for node in (_top_level(item.items) if isinstance(item, n.Group) else [item])]
