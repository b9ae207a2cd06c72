"""What a report is made of, independent of the format it is written in.

A notebook is read once into these blocks (`report.read`); the PDF and the HTML are two ways to write them. Mathematics
stays LaTeX here, pictures are bytes, text is plain characters: nothing is markup.
"""

from dataclasses import dataclass, field
from typing import Any


@dataclass
class Text:
    text: str


@dataclass
class Code:
    text: str


@dataclass
class Math:
    """Mathematics inside a line, LaTeX without delimiters."""

    latex: str


@dataclass
class Styled:
    """style: emph, strong, strike, underline, sub, super."""

    style: str
    children: list["Inline"]


@dataclass
class Link:
    """url as written; `kind` and `target` are settled when the whole report is known.

    kind: internal (target is an anchor), notebook (target is "name" or "name#anchor"), external (target is a URL).
    """

    url: str
    children: list["Inline"]
    kind: str = "external"
    target: str = ""


@dataclass
class PageNumber:
    """The page of a place in the same book. target: "notebook" or "notebook#anchor"."""

    target: str


@dataclass
class Picture:
    """kind: svg, png, jpg, gif or webp. width: as the notebook asks for, in CSS pixels, None for the picture's own."""

    data: bytes
    kind: str
    alt: str
    width: float | None = None


@dataclass
class Break:
    """A line break."""


@dataclass
class Anchor:
    """A place to link to, from ``<a id="...">``."""

    name: str


@dataclass
class Note:
    """A footnote. number counts in the report; blocks is empty where the note was already given."""

    number: int
    blocks: list["Block"]


Inline = Text | Code | Math | Styled | Link | PageNumber | Picture | Break | Anchor | Note


@dataclass
class Heading:
    """level: 1 for a section of the report. number: "2.1" or ""."""

    level: int
    children: list[Inline]
    anchor: str
    number: str = ""


@dataclass
class Paragraph:
    children: list[Inline]


@dataclass
class Display:
    """A formula on its own lines. label: the number at the right, "" for none."""

    latex: str
    label: str = ""
    anchor: str = ""


@dataclass
class Listing:
    """Preformatted text. role: input, code, output, stderr or error. language: a Pygments name, "" for plain text."""

    text: str
    role: str = "code"
    language: str = ""


@dataclass
class Item:
    """checked: None where the item is no task."""

    blocks: list["Block"]
    checked: bool | None = None


@dataclass
class Bullets:
    items: list[Item]
    ordered: bool = False
    start: int = 1
    tight: bool = True


@dataclass
class Definitions:
    items: list[tuple[list[Inline], list["Block"]]]


@dataclass
class Quote:
    blocks: list["Block"]


@dataclass
class Rule:
    """A thematic break."""


@dataclass
class Cell:
    """One cell of a table at column x, row y of its grid."""

    children: list[Inline]
    x: int = 0
    y: int = 0
    colspan: int = 1
    rowspan: int = 1
    align: str = "left"
    head: bool = False
    mark: str = ""


@dataclass
class Grid:
    """A table. The first `head_rows` rows repeat on each page. number: "Table 2", or "" without a caption."""

    cells: list[Cell]
    columns: int
    rows: int
    head_rows: int
    caption: list[Inline] = field(default_factory=list)
    notes: list[list[Inline]] = field(default_factory=list)
    number: str = ""


@dataclass
class Figure:
    """A picture on its own lines. number: "Figure 2", or "" without a caption."""

    picture: Picture
    caption: list[Inline] = field(default_factory=list)
    number: str = ""


Block = Heading | Paragraph | Display | Listing | Bullets | Definitions | Quote | Rule | Grid | Figure


@dataclass
class ReportCell:
    """The blocks of one cell. number: its 1-based position in the notebook. anchor: "cell-7" for a code cell."""

    number: int
    blocks: list[Block]
    anchor: str = ""


@dataclass
class Report:
    """A notebook, read. name: as errors call it, for example "double_tank/03_pole_placement"."""

    name: str
    title: list[Inline]
    title_anchor: str
    cells: list[ReportCell]
    document: str = ""
    chapter: str = ""
    language: str = "en"
    author: str = ""
    anchors: set[str] = field(default_factory=set)

    @property
    def plain_title(self) -> str:
        """The title in characters, for metadata and running heads."""
        return plain(self.title, "text")

    @property
    def headings(self) -> list[Heading]:
        """All headings below the title, in reading order."""
        return [block for block in walk(self.cells) if isinstance(block, Heading)]


def children(node: Any) -> list[Any]:
    """The nodes directly inside one node."""
    match node:
        case list():
            return node
        case ReportCell() | Quote() | Item() | Note():
            return node.blocks
        case Paragraph() | Heading() | Styled() | Link() | Cell():
            return node.children
        case Bullets():
            return node.items
        case Definitions():
            return [part for term, blocks in node.items for part in (*term, *blocks)]
        case Grid():
            return [*node.caption, *node.cells, *(part for note in node.notes for part in note)]
        case Figure():
            return [node.picture, *node.caption]
    return []


def walk(node: Any):
    """Every node below, in reading order."""
    for child in children(node):
        yield child
        yield from walk(child)


def plain(nodes: list[Inline], math: str = "latex") -> str:
    """The characters of inline nodes.

    math: "latex" gives ``$x^2$``, the form Jupyter makes anchors of; "text" reads the formula.
    """
    parts = []
    for node in nodes:
        match node:
            case Text(text) | Code(text):
                parts.append(text)
            case Math(latex) if math == "latex":
                parts.append(f"${latex}$")
            case Math(latex):
                from notebook_reports.export.formulas import as_text

                parts.append(as_text(latex))
            case Styled() | Link():
                parts.append(plain(node.children, math))
            case Break():
                parts.append(" ")
            case Picture():
                parts.append(node.alt)
    return "".join(parts)
