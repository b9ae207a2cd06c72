"""A report's blocks as Typst source.

Whatever comes from a notebook enters the source as a string literal, never as markup; mathematics comes from the
strict converter. The functions called here are those of ``templates/loopbook_pdf/report.typ``.
"""

import hashlib
import re
import struct
from dataclasses import dataclass, field

from notebook_reports.export.formulas import as_text, as_typst
from notebook_reports.export.model import (
    Anchor,
    Block,
    Break,
    Bullets,
    Cell,
    Code,
    Definitions,
    Display,
    Figure,
    Grid,
    Heading,
    Inline,
    Item,
    Link,
    Listing,
    Math,
    Note,
    PageNumber,
    Paragraph,
    Picture,
    Quote,
    ReportCell,
    Rule,
    Styled,
    Text,
    plain,
)
from notebook_reports.export.read.notebook import beside
from notebook_reports.export.write.breaking import pieces
from notebook_reports.export.write.column_widths import TEXT_HEIGHT, TEXT_WIDTH, deciding, height, unbroken, words
from notebook_reports.export.write.highlighting import lines
from notebook_reports.export.write.svg_fonts import with_known_fonts
from notebook_reports.export.write.typst_text import LONGEST_CODE_IN_A_TABLE, LONGEST_WORD, breakable, literal

STYLES = ("emph", "strong", "strike", "underline", "sub", "super")
IMPORT = '#import "report.typ": ' + ", ".join(
    (
        *("report", "book", "part", "chapter", "section", "landscape"),
        *("m", "long-m", "code", "inner", "outer", "page-of", "task", "quoted", "inline-picture"),
        *("listing", "formula", "drawing", "data-table", "thematic-break", "marked"),
        *("probe", "probe-code", *(f"probe-{style}" for style in STYLES)),
    )
)
"""Only what is called: a name such as accent would hide the function of that name in mathematics."""
LONG_FORMULA = 40
"""Characters of a formula's text from which on it may need more than one line of a column."""
BREAKABLE_FROM = 0.3 * TEXT_HEIGHT
"""Points of height, by estimate, from which on a table may go on over pages."""
_UNBROKEN = re.compile(r"\S{60}")


@dataclass
class TypstWriter:
    """Writes blocks as Typst source and gathers the pictures it names.

    name: of the notebook. prefix: what its anchors begin with, so that several notebooks fit in one book.
    chapters: the anchors of each notebook of the book by name; None outside a book, where a link to another notebook
    leads to its own PDF beside this one. turned: the tables that get a landscape page, by name, count and content
    ("a/b 3 1f0c").
    probing: write what is only measured. The engine looks for a measured element in the page and, having found it, lays
    all out anew; so what is measured equals nothing on the page, but is as wide.
    """

    name: str = ""
    prefix: str = ""
    chapters: dict[str, set[str]] | None = None
    turned: frozenset[str] = frozenset()
    files: dict[str, bytes] = field(default_factory=dict)
    cell: int = 0
    tables: int = 0
    in_table: bool = False
    probing: bool = False

    def report_cell(self, cell: ReportCell) -> str:
        """The source of one cell of the notebook, its anchor on its first block."""
        self.cell = cell.number
        first, *rest = (self.block(block) for block in cell.blocks)
        if rest and isinstance(cell.blocks[0], Listing):
            first = self.listing(cell.blocks[0], keep=True)
        if cell.anchor and (isinstance(cell.blocks[0], Paragraph) or first.startswith("#landscape")):
            first = self.node(Anchor(cell.anchor)) + first
        elif cell.anchor and not isinstance(cell.blocks[0], Heading):
            first = f"#[{first}#{self.label(cell.anchor)}]"
        return "\n\n".join([first, *rest])

    def blocks(self, blocks: list[Block], tight: bool = False) -> str:
        """The source of blocks, each on lines of its own."""
        return ("\n" if tight else "\n\n").join(self.block(block) for block in blocks)

    def block(self, block: Block) -> str:
        match block:
            case Paragraph(children):
                return self.inline(children)
            case Heading(level, children, anchor, number):
                return f"#section({level}, {literal(number)}, {self.label(anchor)})[{self.inline(children)}]"
            case Display():
                return self.display(block)
            case Listing():
                return self.listing(block)
            case Bullets():
                return self.bullets(block)
            case Definitions(items):
                parts = [f"terms.item([{self.inline(term)}], [{self.blocks(body)}])" for term, body in items]
                return f"#terms({', '.join(parts)})"
            case Quote(blocks):
                return f"#quoted[{self.blocks(blocks)}]"
            case Rule():
                return "#thematic-break()"
            case Grid():
                return self.grid(block)
            case Figure(picture, caption, number):
                told = f"[{self.inline(caption)}]" if caption else "none"
                return f"#drawing({self.picture(picture)}, {told}, {literal(number)})"
        raise TypeError(f"no Typst form for {type(block).__name__}")

    def listing(self, block: Listing, keep: bool = False) -> str:
        """Preformatted text, cut where its colours change. keep: a short one stays on the page of what follows it."""
        kept = ", keep: true" if keep and block.text.count("\n") < 15 else ""
        rows = ""
        if block.language:
            rows = ", ".join(
                f"({''.join(f'({literal(kind)}, {literal(text)}),' for kind, text in row)})"
                for row in lines(block.text, block.language)
            )
        long = ", long: true" if _UNBROKEN.search(block.text) else ""
        return f"#listing({literal(block.role)}, {literal(block.text)}, ({rows}{',' if rows else ''}){kept}{long})"

    def bullets(self, block: Bullets) -> str:
        items = ", ".join(f"[{self.item(item, block.tight)}]" for item in block.items)
        tight = "true" if block.tight else "false"
        if block.ordered:
            return f"#enum(tight: {tight}, start: {block.start}, {items})"
        return f"#list(tight: {tight}, {items})"

    def item(self, item: Item, tight: bool) -> str:
        box = "" if item.checked is None else '#task(true);#" ";' if item.checked else '#task(false);#" ";'
        return box + self.blocks(item.blocks, tight)

    def inline(self, nodes: list[Inline]) -> str:
        return "".join(self.node(node) for node in nodes)

    def node(self, node: Inline) -> str:
        match node:
            case Text(text):
                return f"#{literal(breakable(text))};" if text else ""
            case Code(text):
                return f"#{'probe-code' if self.probing else 'code'}({literal(self.code(text))});"
            case Math(latex):
                return self.math(latex)
            case Styled(style, children):
                return f"#{'probe-' if self.probing else ''}{style}[{self.inline(children)}];"
            case Link():
                return self.link(node)
            case PageNumber(target):
                return f"#page-of(label({literal(target)}));"
            case Picture():
                return f"#inline-picture({self.picture(node)});"
            case Break():
                return "#linebreak();"
            case Anchor(name):
                return f"#[#metadata(none)#{self.label(name)}];"
            case Note(number, blocks):
                label = self.label(f"footnote-{number}")
                return f"#[#footnote[{self.blocks(blocks)}]#{label}];" if blocks else f"#footnote({label});"
        raise TypeError(f"no Typst form for {type(node).__name__}")

    def code(self, text: str) -> str:
        """Code inside a line, with places to break; columns of a table are narrow."""
        return breakable(text, LONGEST_CODE_IN_A_TABLE if self.in_table else LONGEST_WORD)

    def math(self, latex: str) -> str:
        """A formula inside a line. A long one comes with its pieces, so that it is known whether lines can hold it."""
        if self.probing:
            return f"#probe(${as_typst(latex, False)}$);"
        formula = f"{literal(as_text(latex))}, ${as_typst(latex, False)}$"
        if len(as_text(latex)) < LONG_FORMULA:
            return f"#m({formula});"
        parts = ", ".join(f"${as_typst(part, False)}$" for part in _lines(latex))
        return f"#long-m({self.where('a formula inside a line')}, {formula}, ({parts},));"

    def link(self, link: Link) -> str:
        inside = self.inline(link.children)
        if self.probing:
            return inside
        if link.kind == "internal":
            return f"#inner({self.label(link.target)})[{inside}];"
        if link.kind == "notebook" and self.chapters is not None:
            return f"#inner(label({literal(link.target)}))[{inside}];"
        url = beside(link.target, self.name, ".pdf") if link.kind == "notebook" else link.target
        return f"#outer({literal(url)})[{inside}];"

    def label(self, anchor: str) -> str:
        return f"label({literal(self.prefix + anchor)})"

    def display(self, block: Display) -> str:
        parts = _lines(block.latex)
        whole = f"({literal(as_text(block.latex))}, ${as_typst(block.latex, True)}$)"
        broken = ""
        if len(parts) > 1:
            broken = "".join(f"({literal(as_text(p))}, ${as_typst(p, True)}$), " for p in parts)
        label = literal(f"({block.label})") if block.label else "none"
        anchor = self.label(block.anchor) if block.anchor else "none"
        return f"#formula({self.where('a formula')}, {whole}, ({broken}), {label}, {anchor})"

    def grid(self, grid: Grid) -> str:
        self.in_table = True
        cells, measured = ",\n".join(self.table_cell(cell) for cell in grid.cells), self.measured(grid)
        self.in_table = False
        caption = f"[{self.inline(grid.caption)}]" if grid.caption else "none"
        notes = "".join(f"[{self.inline(note)}], " for note in grid.notes)
        self.tables += 1
        id = f"{self.name} {self.tables} {hashlib.sha256(measured.encode()).hexdigest()[:16]}"
        where = literal(f"{self.cell}|{grid.number or 'a table'}|{id}")
        size = f"{grid.rows}, {grid.head_rows}"
        short = "true" if grid.rows <= 12 and height(grid) < BREAKABLE_FROM else "false"
        body = f"(\n{cells},\n), {measured}, short: {short}"
        table = f"#data-table({where}, {size}, {caption}, {literal(grid.number)}, ({notes}), {body})"
        return f"#landscape[{table}]" if id in self.turned else table

    def measured(self, grid: Grid) -> str:
        """What the engine measures to know the columns: for each its widest cells, and pieces that no line end divides;
        then the cells over several columns."""
        self.probing = True
        found = deciding(grid)
        columns = []
        for widest, solid, *kind in zip(found.widest, found.solid, found.tight, found.weight, strict=True):
            cells = "".join(f"{self.probe(grid.cells[place])}, " for place in widest)
            pieces = (
                f"{self.probe(cell)}, " if unbroken(cell) else self._solid(cell)
                for cell in (grid.cells[place] for place in solid)
            )
            columns.append(f"(({cells}), ({''.join(pieces)}), {str(kind[0]).lower()}, {kind[1]:.0f}pt)")
        wide = "".join(f"({c.x}, {c.colspan}, {self.probe(c)}), " for c in grid.cells if c.colspan > 1)
        self.probing = False
        return f"({', '.join(columns)},), ({wide})"

    def probe(self, cell: Cell) -> str:
        body = f"[{self.inline(cell.children)}]"
        if cell.mark:
            return f"marked({literal(cell.mark)}, {body})"
        return f"probe-strong({body})" if cell.head else body

    def table_cell(self, cell: Cell) -> str:
        optional = ""
        if cell.colspan > 1 or cell.rowspan > 1:
            optional += f", colspan: {cell.colspan}, rowspan: {cell.rowspan}"
        if cell.mark:
            optional += f", mark: {literal(cell.mark)}"
        head = "true" if cell.head else "false"
        body = self.inline(cell.children)
        return f"(x: {cell.x}, y: {cell.y}, align: {cell.align}, head: {head}{optional}, body: [{body}])"

    def _solid(self, cell: Cell) -> str:
        """The pieces of a cell that no line end divides, the longest word and each formula."""
        nodes = cell.children
        longest = max(words(breakable(plain([n for n in nodes if not isinstance(n, Math | Code)]))), key=len)
        parts = [f"[#{literal(longest)};]"] if longest else []
        for node in nodes:
            if isinstance(node, Code):
                parts.append(f"[{self.node(Code(max(words(self.code(node.text)), key=len)))}]")
            elif isinstance(node, Math):
                short = len(as_text(node.latex)) < LONG_FORMULA
                parts += [
                    f"probe(${as_typst(part, False)}$)" for part in ([node.latex] if short else _lines(node.latex))
                ]
        return "".join(f"probe-strong({part}), " if cell.head else f"{part}, " for part in parts)

    def picture(self, picture: Picture) -> str:
        """The arguments that name a picture: file, alternative text, width in points or none."""
        data = with_known_fonts(picture.data) if picture.kind == "svg" else picture.data
        file = f"picture-{hashlib.sha256(data).hexdigest()[:16]}.{picture.kind}"
        self.files[file] = data
        width = picture.width
        if width is None and picture.kind == "png":
            width = struct.unpack(">I", picture.data[16:20])[0]
        points = "none" if width is None else f"{min(width * 0.75, TEXT_WIDTH):g}pt"
        return f"{literal(file)}, {literal(picture.alt)}, {points}"

    def where(self, what: str) -> str:
        return literal(f"{self.cell}|{what}|")


def _lines(latex: str) -> list[str]:
    """The pieces of a formula between possible line ends, each a formula: an operator at its start has two sides."""
    first, *rest = pieces(latex)
    return [first, *("{}" + part for part in rest)]
