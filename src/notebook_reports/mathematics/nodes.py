"""The tree a formula is parsed into. Both emitters walk it; neither sees LaTeX.

A list of nodes is a horizontal list in TeX's sense. TeX's atom classes are the strings ``ord op bin rel open close
punct``; they decide the spaces between neighbours (see `spacing`).
"""

from dataclasses import dataclass, field


class Node:
    """Anything in a horizontal list."""


@dataclass
class Symbol(Node):
    """One character. upright: a letter that is not set in italics. large: grows in displays (∑ ∫)."""

    char: str
    cls: str = "ord"
    upright: bool = False
    large: bool = False
    limits: bool = False


@dataclass
class Number(Node):
    """Digits with at most one decimal point or decimal comma."""

    text: str


@dataclass
class Word(Node):
    """Letters set as one word in one alphabet (``\\mathrm{TPM}``), already mapped to that alphabet's characters."""

    text: str


@dataclass
class MathText(Node):
    """Text from ``\\text{…}``; its spaces count. variant: normal, bold, italic, mono or sans."""

    text: str
    variant: str = "normal"


@dataclass
class Space(Node):
    """A horizontal space in em, possibly negative."""

    em: float


@dataclass
class Group(Node):
    """``{…}``: an ordinary atom, whatever is in it."""

    items: list[Node]


@dataclass
class Classed(Node):
    """``\\mathrel{…}`` and its kin: content that behaves as one atom of a given class."""

    items: list[Node]
    cls: str


@dataclass
class StyleSwitch(Node):
    """``\\displaystyle`` and its kin: holds for the rest of the list."""

    style: str


@dataclass
class Scripts(Node):
    """A base with sub- and superscript. limits: True above and below, False beside, None as the base likes it."""

    base: Node
    sub: list[Node] | None = None
    sup: list[Node] | None = None
    primes: int = 0
    limits: bool | None = None


@dataclass
class Fraction(Node):
    """num over den. style: "", display or text. line: False for a binomial or ``\\atop``."""

    num: list[Node]
    den: list[Node]
    style: str = ""
    line: bool = True


@dataclass
class Root(Node):
    body: list[Node]
    index: list[Node] | None = None


@dataclass
class Fenced(Node):
    """Delimiters that grow with what they enclose; "" is the invisible delimiter ``.``."""

    left: str
    items: list[Node]
    right: str


@dataclass
class Middle(Node):
    """A growing delimiter inside `Fenced`."""

    char: str


@dataclass
class Big(Node):
    """``\\big(`` and its kin: a delimiter of a fixed height in em."""

    char: str
    em: float
    cls: str


@dataclass
class Accent(Node):
    """name: of `symbols.ACCENTS`. wide: as wide as the body."""

    name: str
    body: list[Node]
    wide: bool = False


@dataclass
class Line(Node):
    """A line over or under the body."""

    body: list[Node]
    over: bool


@dataclass
class Brace(Node):
    """A horizontal brace (or bracket) over or under the body; a script on it becomes its label."""

    body: list[Node]
    char: str
    over: bool


@dataclass
class Stack(Node):
    """``\\overset``, ``\\underset``, ``\\stackrel``: small annotations above and below a base."""

    base: list[Node]
    over: list[Node] | None
    under: list[Node] | None
    cls: str


@dataclass
class Arrow(Node):
    """An arrow as long as the labels above and below it."""

    char: str
    over: list[Node]
    under: list[Node] | None


@dataclass
class Operator(Node):
    """A named function. limits: its subscript goes below it in displays (lim, max)."""

    name: list[Node]
    limits: bool


@dataclass
class Tag:
    """An equation number as it is shown, with its parentheses."""

    text: str


@dataclass
class Row:
    """space: extra space below the row, in em."""

    cells: list[list[Node]]
    tag: Tag | None = None
    space: float = 0.0


@dataclass
class MathArray(Node):
    """Rows and columns: matrices, arrays, cases, aligned equations.

    align: one of l, c, r per column. gap, row_gap: between columns and rows, in em. left, right: delimiters.
    vlines, hlines: how many columns (rows) stand before each line. style: display, text or script, of the cells.
    aligned: columns come in pairs around a relation.
    """

    rows: list[Row]
    align: str
    gap: float = 1.0
    row_gap: float = 0.3
    left: str = ""
    right: str = ""
    vlines: list[int] = field(default_factory=list)
    hlines: list[int] = field(default_factory=list)
    style: str = "text"
    aligned: bool = False


@dataclass
class Phantom(Node):
    """Invisible, but takes its width, its height, or both."""

    body: list[Node]
    width: bool = True
    height: bool = True


@dataclass
class Boxed(Node):
    body: list[Node]


@dataclass
class Cancel(Node):
    """kind: cancel, bcancel, xcancel or sout."""

    body: list[Node]
    kind: str


@dataclass
class Colored(Node):
    """color: #rrggbb."""

    body: list[Node]
    color: str


@dataclass
class Sized(Node):
    """Content in another size. factor: of the size around it."""

    body: list[Node]
    factor: float


@dataclass
class TagNode(Node):
    """An equation number of a formula of one line. start, end: where ``\\tag{…}`` stands in the LaTeX."""

    tag: Tag
    content: str
    start: int
    end: int
    starred: bool
