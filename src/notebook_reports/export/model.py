"""What a report is made of, independent of the format it is written in.

A notebook is read once into these blocks (`report.read`); the PDF and the HTML are two ways to write them. Mathematics
stays LaTeX here, pictures are bytes, text is plain characters: nothing is markup.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from notebook_reports.export.formulas import as_text


@dataclass
class Text:
    text: str


@dataclass
class Code:
    text: str


@dataclass
class Math:
    """Mathematics inside a line, LaTeX without delimiters. small: as small as it has to be."""

    latex: str
    small: bool = False


@dataclass
class Styled:
    """style: emph, strong, strike, underline, sub, super."""

    style: str
    children: list["Inline"]


@dataclass
class Link:
    """url as written; `kind` and `target` are settled when the whole report is known.

    kind: internal (target is an anchor), notebook (target is "name" or "name#anchor"), external (target is a URL),
    nowhere (its words are shown, and a mend says where it should lead).
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
class Coloured:
    """Text in a colour of its own, on a ground of its own: "#rrggbb", or "" for the page's."""

    children: list["Inline"]
    ink: str = ""
    ground: str = ""


@dataclass
class Picture:
    """kind: svg, png, jpg, gif or webp. width, height: as the notebook asks for, in CSS pixels, None for the picture's
    own. share: of the text's width, instead of a width in pixels."""

    data: bytes
    kind: str
    alt: str
    width: float | None = None
    height: float | None = None
    share: float | None = None


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


@dataclass
class Mend:
    """Stands where something cannot be shown, as a block or inside a line.

    kind: what is missing, one of `mends.KINDS`. reason: why, a sentence without its end. text: the alternative text, or
    the source of a formula. address: where it is. number: counts in the report. remark: nothing is missing, but
    something is shown in another way than the notebook has it.
    """

    kind: str
    reason: str
    text: str = ""
    address: str = ""
    remark: bool = False
    number: int = 0


Inline = Text | Code | Math | Styled | Coloured | Link | PageNumber | Picture | Break | Anchor | Note | Mend


@dataclass
class Heading:
    """level: 1 for a section of the report. number: "2.1" or ""."""

    level: int
    children: list[Inline]
    anchor: str
    number: str = ""


@dataclass
class Paragraph:
    """leads: it introduces what follows, and stays on the page of that."""

    children: list[Inline]
    leads: bool = False


@dataclass
class Display:
    """A formula on its own lines. label: the number at the right, "" for none. small: as small as it has to be."""

    latex: str
    label: str = ""
    anchor: str = ""
    small: bool = False


@dataclass
class Verbatim:
    """Preformatted text. role: input, code, output, stderr or error. language: a Pygments name, "" for plain text.
    folded: to be shown only to who asks; not on paper."""

    text: str
    role: str = "code"
    language: str = ""
    folded: bool = False


@dataclass
class ListItem:
    """checked: None where the item is no task. value: the number of the item where it is not one more than the last."""

    blocks: list["Block"]
    checked: bool | None = None
    value: int | None = None


@dataclass
class Bullets:
    """style: of the numbers, one of 1 a A i I."""

    items: list[ListItem]
    ordered: bool = False
    start: int = 1
    tight: bool = True
    style: str = "1"

    @property
    def numbers(self) -> list[int]:
        """The number of each item."""
        found: list[int] = []
        for item in self.items:
            following = found[-1] + 1 if found else self.start
            found.append(following if item.value is None else item.value)
        return found


@dataclass
class Definitions:
    items: list[tuple[list[Inline], list["Block"]]]


@dataclass
class Quote:
    blocks: list["Block"]


@dataclass
class Alert:
    """A box that asks for attention. kind: info, success, warning or danger."""

    kind: str
    blocks: list["Block"]


@dataclass
class Folded:
    """What is shown to who asks for it, on a screen; on paper it is there."""

    words: str
    blocks: list["Block"]


@dataclass
class Aside:
    """A note in the margin, of one line or two."""

    blocks: list["Block"]


@dataclass
class ThematicBreak:
    """A thematic break."""


@dataclass
class Cell:
    """One cell of a table at column x, row y of its grid.

    again: it repeats the cell above, and is seen only where that is not: on another page. pad: what its number lacks
    behind for the decimal points of its column to stand below each other, "" or such as "0" or ".00".
    """

    children: list[Inline]
    x: int = 0
    y: int = 0
    colspan: int = 1
    rowspan: int = 1
    align: str = "left"
    head: bool = False
    mark: str = ""
    ink: str = ""
    ground: str = ""
    again: bool = False
    pad: str = ""


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
class FigureBlock:
    """A picture on its own lines. number: "Figure 2", or "" without a caption."""

    picture: Picture
    caption: list[Inline] = field(default_factory=list)
    number: str = ""


@dataclass
class Live:
    """Data that a script shows on the screen, see `scripts`. script, markup: an installed package's own. instead: the
    blocks that stand for it where nothing runs."""

    mime: str
    data: Any
    script: str
    markup: str
    instead: list["Block"] = field(default_factory=list)


Block = (
    Heading
    | Paragraph
    | Display
    | Verbatim
    | Bullets
    | Definitions
    | Quote
    | Alert
    | Folded
    | Aside
    | ThematicBreak
    | Grid
    | FigureBlock
    | Mend
    | Live
)


@dataclass
class ReportCell:
    """The blocks of one cell. number: its 1-based position in the notebook. anchor: "cell-7" for a code cell.

    new_page: a page begins with it. folded: on a screen, the section that begins with it opens when asked.
    """

    number: int
    blocks: list[Block]
    anchor: str = ""
    new_page: bool = False
    folded: bool = False


@dataclass
class Report:
    """A notebook, read. name: as errors call it, for example "double_tank/03_pole_placement". mended: not strictly;
    mends: what stands for something that cannot be shown, in reading order, with the number of its cell. aliases: other
    names of anchors. contents: may it have a table of contents?"""

    name: str
    title: list[Inline]
    title_anchor: str
    cells: list[ReportCell]
    document: str = ""
    chapter: str = ""
    language: str = "en"
    author: str = ""
    anchors: set[str] = field(default_factory=set)
    mended: bool = False
    contents: bool = True
    aliases: dict[str, str] = field(default_factory=dict)
    mends: list[tuple[int, Mend]] = field(default_factory=list)

    @property
    def place(self) -> str:
        """What stands above the title: the chapter of a book, else the document it belongs to."""
        return self.chapter or self.document

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
        case ReportCell() | Quote() | Alert() | Folded() | Aside() | ListItem() | Note():
            return node.blocks
        case Paragraph() | Heading() | Styled() | Coloured() | Link() | Cell():
            return node.children
        case Bullets():
            return node.items
        case Definitions():
            return [part for term, blocks in node.items for part in (*term, *blocks)]
        case Grid():
            return [*node.caption, *node.cells, *(part for note in node.notes for part in note)]
        case FigureBlock():
            return [node.picture, *node.caption]
        case Live():
            return node.instead
    return []


def walk(node: Any) -> Iterator[Any]:
    """Every node below, in reading order."""
    for child in children(node):
        yield child
        yield from walk(child)


def rewrite(node: Any, change: Callable[[Any], list[Any] | None]) -> None:
    """Replace nodes everywhere below, in place. change: gives what stands instead of a node, None to keep it."""

    def changed(nodes: list[Any]) -> None:
        kept = []
        for child in nodes:
            new = change(child)
            if new is None:
                rewrite(child, change)
                kept.append(child)
            else:
                kept += new
        nodes[:] = kept

    match node:
        case Definitions():
            for term, blocks in node.items:
                changed(term)
                changed(blocks)
        case Grid():
            changed(node.caption)
            changed(node.cells)
            for note in node.notes:
                changed(note)
        case FigureBlock():
            changed(node.caption)
        case _:
            found = children(node)
            changed(found)


def words_only(nodes: list[Inline], pictures: bool = True) -> list[Inline]:
    """A heading as contents show it: without notes, mends and anchors; links are their words, and so are pictures, or
    these are left out."""
    kept: list[Inline] = []
    for node in nodes:
        match node:
            case Anchor() | Note() | Mend():
                continue
            case Picture():
                kept += [Text(node.alt)] if pictures else []
            case Break():
                kept.append(Text(" "))
            case Link() if words_only(node.children, pictures) != node.children:
                kept += words_only(node.children, pictures)
            case Styled():
                kept.append(Styled(node.style, words_only(node.children, pictures)))
            case Coloured():
                kept.append(Coloured(words_only(node.children, pictures), node.ink, node.ground))
            case _:
                kept.append(node)
    return kept


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
                parts.append(as_text(latex))
            case Styled() | Coloured() | Link():
                parts.append(plain(node.children, math))
            case Mend():
                parts.append(" ".join(part for part in (node.text, node.reason, node.address) if part))
            case Break():
                parts.append(" ")
            case Picture():
                parts.append(node.alt)
    return "".join(parts)
