"""What the readers of one notebook share: where they are, what they have counted, what they could not show."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from notebook_reports.export.errors import CannotShow, Problem
from notebook_reports.export.model import (
    Block,
    Break,
    Display,
    FigureBlock,
    Inline,
    Math,
    Mend,
    Paragraph,
    Picture,
    Text,
)
from notebook_reports.mathematics import MathError, extract_tag
from notebook_reports.mathematics.macros import Macros

_MATH = re.compile(
    r"(?<!\\)\$\$(?P<display>.+?)(?<!\\)\$\$"
    r"|\\\[(?P<bracket>.+?)\\\]"
    r"|\\\((?P<paren>.+?)\\\)"
    r"|(?P<environment>\\begin\{(?P<name>[a-z]+\*?)\}.*?\\end\{(?P=name)\})"
    r"|(?<![\\$])\$(?P<inline>[^$]+?)(?<![\\$])\$",
    re.DOTALL,
)
_ENVIRONMENTS = {"equation", "align", "aligned", "gather", "gathered", "multline", "eqnarray", "split", "displaymath"}

Node = TypeVar("Node", bound=Block | Inline)


@dataclass
class Reading:
    """The state of reading one notebook.

    folder: where relative images are looked up; root: the folder below which they have to lie. document: what equation
    anchors begin with. strict_alt: a picture without alternative text is a problem, not a picture called "Figure".
    mending: what cannot be shown becomes a `Mend`, not a problem. macros: those defined so far. footnotes: the texts of
    footnotes by key, in Markdown, for cells that refer to another cell's. note_references: the keys that any cell
    refers to. note_numbers: those given.
    """

    folder: Path | None = None
    document: str = ""
    strict_alt: bool = False
    mending: bool = False
    root: Path | None = None
    macros: Macros = field(default_factory=Macros)
    footnotes: dict[str, str] = field(default_factory=dict)
    note_references: frozenset[str] = frozenset()
    note_numbers: dict[str, int] = field(default_factory=dict)
    cell: int = 0
    attachments: dict[str, dict[str, str]] = field(default_factory=dict)
    notes: int = 0
    problems: list[Problem] = field(default_factory=list)

    def attempt(self, read: Callable[[], Sequence[Node]], source: str = "") -> "list[Node | Mend]":
        """What `read` gives; where that cannot be shown, a `Mend` and the source, or, strictly, a problem and nothing.

        One export names every problem of a notebook.
        """
        try:
            return list(read())
        except CannotShow as error:
            if not self.mending:
                self.problems.append(Problem(self.cell, str(error)))
                return []
            return [Mend(error.kind, error.reason, error.text or source, error.address)]
        except (RecursionError, ArithmeticError, LookupError, TypeError, ValueError, AttributeError) as error:
            if not self.mending:
                raise
            return [Mend("cell", f"it cannot be read ({type(error).__name__}: {error})", source)]

    def alt(self, text: str | None, what: str) -> str:
        """The alternative text of a picture."""
        text = (text or "").strip()
        if text:
            return text
        if self.strict_alt:
            raise CannotShow(f"{what} has no alternative text; say in one sentence what it shows")
        return "Figure without a description"

    def display(self, latex: str) -> list[Display]:
        """A formula on its own lines, its ``\\tag`` taken out; nothing where it only defines macros."""
        try:
            latex = trimmed(self.macros.expand(latex))
            if not latex:
                return []
            latex, label = extract_tag(latex)
        except MathError as error:
            if self.mending:
                return [Display(latex)]
            raise CannotShow(f"a formula: {error}") from None
        anchor = "-".join(part for part in ("eq", self.document, label) if part) if label else ""
        return [Display(latex, label or "", anchor)]

    def math(self, latex: str) -> list[Math]:
        """A formula inside a line; nothing where it only defines macros."""
        try:
            latex = trimmed(self.macros.expand(latex))
        except MathError as error:
            if not self.mending:
                raise CannotShow(f"a formula: {error}") from None
        return [Math(latex)] if latex else []


def trimmed(latex: str) -> str:
    r"""A formula without blanks at its ends; the space of ``\ `` at its end stays.

    >>> trimmed(" a\\ ")
    'a\\ '
    """
    bare = latex.strip()
    backslashes = len(bare) - len(bare.rstrip("\\"))
    return bare + " " if backslashes % 2 else bare


def flow(nodes: Iterable[Inline | Display]) -> list[Block]:
    """Paragraphs out of inline nodes: displayed formulas stand alone, and so does a picture that is a paragraph."""
    blocks: list[Block] = []
    line: list[Inline] = []

    def close() -> None:
        trim(line)
        solid = [node for node in line if not (isinstance(node, Text) and not node.text.strip())]
        if len(solid) == 1 and isinstance(solid[0], Picture):
            blocks.append(FigureBlock(solid[0]))
        elif solid and len(mends := [node for node in solid if isinstance(node, Mend)]) == len(solid):
            blocks.extend(mends)
        elif line:
            blocks.append(Paragraph(list(line)))
        line.clear()

    for node in nodes:
        if isinstance(node, Display):
            close()
            blocks.append(node)
        else:
            line.append(node)
    close()
    return blocks


def trim(line: list[Inline]) -> None:
    """Take spaces and line breaks off both ends of a line, in place."""
    for end, strip in ((0, str.lstrip), (-1, str.rstrip)):
        while line and isinstance(last := line[end], Text | Break):
            if isinstance(last, Text):
                last.text = strip(last.text)
                if last.text:
                    break
            del line[end]


def with_math(text: str, reading: Reading) -> list[Inline | Display]:
    """Running text of HTML as MathJax reads it: ``$…$`` is part of a line, ``$$…$$`` and environments stand alone."""
    nodes: list[Inline | Display] = []
    at = 0
    for found in _MATH.finditer(text):
        nodes.append(Text(_spaces(text[at : found.start()])))
        at = found.end()
        environment = found["environment"]
        display = found["display"] or found["bracket"]
        if environment and found["name"].rstrip("*") not in _ENVIRONMENTS:
            nodes += reading.math(environment)
        elif environment or display:
            nodes += reading.display(environment or display)
        else:
            nodes += reading.math(found["paren"] or found["inline"])
    nodes.append(Text(_spaces(text[at:])))
    return [node for node in nodes if not (isinstance(node, Text) and not node.text)]


def _spaces(text: str) -> str:
    return re.sub(r"[ \t\r\n\f]+", " ", text.replace("\\$", "$"))


def anchor_of(text: str) -> str:
    """The anchor Jupyter gives a heading.

    >>> anchor_of(" Two tanks, one delay ")
    'Two-tanks,-one-delay'
    """
    return text.strip().replace(" ", "-")
