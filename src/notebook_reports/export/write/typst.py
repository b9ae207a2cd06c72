"""A report's blocks as Typst source.

Whatever comes from a notebook enters the source as a string literal, never as markup; mathematics comes from the
strict converter. The functions called here are those of ``templates/loopbook_pdf/report.typ``.
"""

import hashlib
from dataclasses import dataclass, field

from notebook_reports.export.formulas import as_text, as_typst, understood
from notebook_reports.export.mends import KINDS, sentence
from notebook_reports.export.model import (
    Alert,
    Anchor,
    Aside,
    Block,
    Break,
    Bullets,
    Cell,
    Code,
    Coloured,
    Definitions,
    Display,
    FigureBlock,
    Folded,
    Grid,
    Heading,
    Inline,
    Link,
    ListItem,
    Live,
    Math,
    Mend,
    Note,
    PageNumber,
    Paragraph,
    Picture,
    Quote,
    Report,
    ReportCell,
    Styled,
    Text,
    ThematicBreak,
    Verbatim,
    plain,
)
from notebook_reports.export.read.css import readable_on
from notebook_reports.export.read.notebook import relative_address
from notebook_reports.export.read.picture_sizes import pixel_width
from notebook_reports.export.write.arrangement import AS_IT_COMES, Arrangement
from notebook_reports.export.write.breaking import formula_pieces as line_ends
from notebook_reports.export.write.column_widths import (
    LINE,
    TEXT_HEIGHT,
    TEXT_WIDTH,
    breakable_words,
    deciding,
    is_sentence,
    row_heights,
    unbroken,
)
from notebook_reports.export.write.glyphs import latex_without_absent, without_absent
from notebook_reports.export.write.highlighting import highlighted_lines
from notebook_reports.export.write.svg_fonts import with_known_fonts
from notebook_reports.export.write.typst_text import (
    LONGEST_ADDRESS,
    LONGEST_CODE_IN_A_TABLE,
    LONGEST_IN_A_LISTING,
    LONGEST_WORD,
    breakable,
    flowing,
    text_pieces,
    typst_string,
)

STYLES = ("emph", "strong", "strike", "underline", "sub", "super")
IMPORT = '#import "report.typ": ' + ", ".join(
    (
        *("report", "book", "part", "chapter", "section", "landscape"),
        *("m", "long-m", "small-m", "code", "inner", "outer", "page-of", "task", "quoted", "lead", "inline-picture"),
        *("listing", "formula", "drawing", "data-table", "thematic-break", "marked", "brk", "tinted", "alert"),
        "aside",
        *("mend", "mend-words", "mend-remark", "mend-list"),
        *("probe", "probe-code", *(f"probe-{style}" for style in STYLES)),
    )
)
"""Only what is called: a name such as accent would hide the function of that name in mathematics."""
LONG_FORMULA = 40
"""Characters of a formula's text from which on it may need more than one line of a column."""
BREAKABLE_FROM = 0.3 * TEXT_HEIGHT
"""Points of height, by estimate, from which on a table may go on over pages."""
TALLEST_ROW = 0.3 * TEXT_HEIGHT
"""Points of height, by estimate, up to which the rows of a table are not divided between pages."""
KEPT_UP_TO = 0.17 * TEXT_HEIGHT
"""Points of height, by estimate, up to which code and its output stay together."""


@dataclass
class TypstWriter:
    """Writes blocks as Typst source and gathers the pictures it names.

    name: of the notebook. prefix: what its anchors begin with, so that several notebooks fit in one book.
    chapters: the anchors of each notebook of the book by name; None outside a book, where a link to another notebook
    leads to its own PDF beside this one. layout: what is known of the pages; it names tables and figures by notebook,
    count and content ("a/b 3 1f0c"). grids: the tables written, by that name.
    naming: characters known to be in no font are written by their names.
    probing: write what is only measured. The engine looks for a measured element in the page and, having found it, lays
    all out anew; so what is measured equals nothing on the page, but is as wide.
    """

    name: str = ""
    prefix: str = ""
    chapters: dict[str, set[str]] | None = None
    layout: Arrangement = AS_IT_COMES
    naming: bool = False
    files: dict[str, bytes] = field(default_factory=dict)
    grids: dict[str, Grid] = field(default_factory=dict)
    cell: int = 0
    tables: int = 0
    figures: int = 0
    in_table: bool = False
    probing: bool = False

    def report_cell(self, cell: ReportCell) -> str:
        """The source of one cell of the notebook, its anchor on its first block."""
        self.cell = cell.number
        first, *rest = (self.block(block) for block in cell.blocks)
        code = cell.blocks[0]
        if rest and isinstance(code, Verbatim):
            first = self.listing(code, keep=_together(code, cell.blocks[1]))
        if cell.anchor and (isinstance(cell.blocks[0], Paragraph) or first.startswith("#landscape")):
            first = self.node(Anchor(cell.anchor)) + first
        elif cell.anchor and not isinstance(cell.blocks[0], Heading):
            first = f"#[{first}#{self.label(cell.anchor)}]"
        return "\n\n".join([*(["#pagebreak(weak: true)"] if cell.new_page else []), first, *rest])

    def blocks(self, blocks: list[Block], tight: bool = False) -> str:
        """The source of blocks, each on lines of its own."""
        return ("\n" if tight else "\n\n").join(self.block(block) for block in blocks)

    def block(self, block: Block) -> str:
        match block:
            case Paragraph(children, leads):
                return f"#lead[{self.inline(children)}]" if leads else self.inline(children)
            case Heading(level, children, anchor, number):
                return f"#section({level}, {typst_string(number)}, {self.label(anchor)})[{self.inline(children)}]"
            case Display():
                return self.display(block)
            case Verbatim():
                return self.listing(block)
            case Bullets():
                return self.bullets(block)
            case Definitions(items):
                parts = [f"terms.item([{self.inline(term)}], [{self.blocks(body)}])" for term, body in items]
                return f"#terms({', '.join(parts)})"
            case Quote(blocks):
                return f"#quoted[{self.blocks(blocks)}]"
            case Alert(kind, blocks):
                return f"#alert({typst_string(kind)})[{self.blocks(blocks)}]"
            case Folded(_, blocks):
                return self.blocks(blocks)
            case Aside(blocks):
                return f"#aside[{self.blocks(blocks)}]"
            case Mend():
                return self.mend(block)
            case ThematicBreak():
                return "#thematic-break()"
            case Grid():
                return self.grid(block)
            case FigureBlock():
                return self.figure(block)
            case Live():
                return self.blocks(block.instead)
        raise TypeError(f"no Typst form for {type(block).__name__}")

    def listing(self, block: Verbatim, keep: bool = False) -> str:
        """Preformatted text, cut where its colours change. keep: it stays on the page of what follows it."""
        kept = ", keep: true" if keep else ""
        text = self.shown(block.text).replace("\u200b", "")
        rows = ""
        if block.language or any(_stuck(line) for line in text.split("\n")):
            rows = "".join(f"({''.join(runs_of(row))}), " for row in highlighted_lines(text, block.language))
        return f"#listing({typst_string(block.role)}, {typst_string(text)}, ({rows}){kept})"

    def bullets(self, block: Bullets) -> str:
        items = [f"[{self.item(item, block.tight)}]" for item in block.items]
        tight = "true" if block.tight else "false"
        if not block.ordered:
            return f"#list(tight: {tight}, {', '.join(items)})"
        style = f", numbering: {typst_string(block.style + '.')}" if block.style != "1" else ""
        if any(item.value is not None for item in block.items):
            items = [f"enum.item({n}, {item})" for n, item in zip(block.numbers, items, strict=True)]
        return f"#enum(tight: {tight}, start: {block.start}{style}, {', '.join(items)})"

    def item(self, item: ListItem, tight: bool) -> str:
        box = "" if item.checked is None else '#task(true);#" ";' if item.checked else '#task(false);#" ";'
        return box + self.blocks(item.blocks, tight)

    def inline(self, nodes: list[Inline]) -> str:
        return "".join(self.node(node) for node in nodes)

    def node(self, node: Inline) -> str:
        match node:
            case Text(text):
                stuck = LONGEST_CODE_IN_A_TABLE if self.in_table else LONGEST_WORD
                return flowing(self.shown(text), stuck=stuck) if text else ""
            case Code(text):
                return self.code(self.shown(text))
            case Math():
                return self.math(node)
            case Styled(style, children):
                return f"#{'probe-' if self.probing else ''}{style}[{self.inline(children)}];"
            case Coloured(children, ink, ground):
                inside = self.inline(children)
                return inside if self.probing else f"#tinted({typst_string(ink)}, {typst_string(ground)})[{inside}];"
            case Mend():
                return self.mend_in_line(node)
            case Link():
                return self.link(node)
            case PageNumber(target):
                return f"#page-of(label({typst_string(target)}));"
            case Picture():
                return f"#inline-picture({self.picture(node)});"
            case Break():
                return "#linebreak();"
            case Anchor(name):
                return "" if self.probing else f"#[#metadata(none)#{self.label(name)}];"
            case Note(number, blocks):
                label = self.label(f"footnote-{number}")
                return f"#[#footnote[{self.blocks(blocks)}]#{label}];" if blocks else f"#footnote({label});"
        raise TypeError(f"no Typst form for {type(node).__name__}")

    def code(self, text: str) -> str:
        """Code inside a line, with places to break; columns of a table are narrow."""
        longest = LONGEST_CODE_IN_A_TABLE if self.in_table else LONGEST_WORD
        if self.probing:
            return f"#probe-code[{flowing(text, longest, longest)}];"
        parts = text_pieces(text, longest, longest)
        text = text.replace("\u200b", "")
        if len(parts) <= 1 and not any(boxed for _, boxed in parts):
            return f"#code({typst_string(text)});"
        return f"#code({typst_string(text)}, shown: [{flowing(text, longest, longest)}]);"

    def math(self, node: Math) -> str:
        """A formula inside a line. A long one comes with its pieces, so that it is known whether lines can hold it."""
        latex = latex_without_absent(node.latex) if self.naming else node.latex
        if self.probing:
            return f"#probe(${as_typst(latex, False)}$);"
        formula = f"{typst_string(as_text(latex))}, ${as_typst(latex, False)}$"
        if node.small:
            return f"#small-m({formula});"
        if len(as_text(latex)) < LONG_FORMULA:
            return f"#m({formula});"
        parts = ", ".join(f"${as_typst(part, False)}$" for part in _lines(latex))
        return f"#long-m({self.where('a formula inside a line', file_digest(latex))}, {formula}, ({parts},));"

    def shown(self, text: str) -> str:
        """The text with names in place of the characters that no font has, as far as they are known."""
        return without_absent(text) if self.naming else text

    def mend(self, mend: Mend) -> str:
        """What stands in place of a block: a box, or for a remark a line."""
        told = f"{mend.number}, {self.label(f'mend-{mend.number}')}, {self.label(f'mend-list-{mend.number}')}"
        if mend.remark:
            return f"#mend-remark({told})[{self.sentence(mend)}]"
        address = f"[{self.whole(mend.address)}]" if mend.address else "none"
        words = f"[{self.plain(mend.text)}]" if mend.text.strip() else "none"
        source = "true" if mend.kind in ("formula", "cell") else "false"
        parts = f"{typst_string(KINDS[mend.kind])}, [{self.plain(mend.reason)}], {words}, {address}, {source}"
        return f"#mend({told}, {parts})"

    def mend_in_line(self, mend: Mend) -> str:
        """The same inside a line."""
        if self.probing:
            return self.plain(sentence(mend))
        told = f"{mend.number}, {self.label(f'mend-{mend.number}')}, {self.label(f'mend-list-{mend.number}')}"
        text = self.sentence(mend)
        if mend.kind == "formula" and mend.text:
            text = self.plain(f"{mend.text} (") + text + self.plain(")")
        remark = "true" if mend.remark else "false"
        return f"#mend-words({told}, {remark})[{text}];"

    def plain(self, text: str) -> str:
        return flowing(self.shown(text), stuck=LONGEST_CODE_IN_A_TABLE) if text else ""

    def whole(self, address: str) -> str:
        """An address; a short one is not broken into lines, so that it can be found and copied."""
        most = LONGEST_CODE_IN_A_TABLE if self.in_table else LONGEST_ADDRESS
        return f"#box({typst_string(self.shown(address))});" if len(address) <= most else self.plain(address)

    def sentence(self, mend: Mend) -> str:
        told, address = sentence(mend), f"({mend.address})"
        if not mend.address or not told.endswith(address):
            return self.plain(told)
        return f"{self.plain(told.removesuffix(address) + '(')}{self.whole(mend.address)}{self.plain(')')}"

    def title(self, report: Report) -> str:
        """The title, a place to link to."""
        place = self.node(Anchor(report.title_anchor)) if report.title_anchor else ""
        return self.inline(report.title) + place

    def mends(self, report: Report) -> str:
        """The list of mends at the end, or nothing."""
        if not report.mends:
            return ""
        entries = "".join(
            f"({m.number}, {cell}, {self.label(f'mend-{m.number}')}, {self.label(f'mend-list-{m.number}')}, "
            f"[{self.sentence(m)}]),\n"
            for cell, m in report.mends
        )
        return f"// cell 0\n#mend-list(({entries}))"

    def link(self, link: Link) -> str:
        inside = self.inline(link.children)
        if self.probing:
            return inside
        if link.kind == "nowhere":
            return inside
        if link.kind == "internal":
            return f"#inner({self.label(link.target)})[{inside}];"
        if link.kind == "notebook" and self.chapters is not None:
            return f"#inner(label({typst_string(link.target)}))[{inside}];"
        url = relative_address(link.target, self.name, ".pdf") if link.kind == "notebook" else link.target
        return f"#outer({typst_string(url)})[{inside}];"

    def label(self, anchor: str) -> str:
        return f"label({typst_string(self.prefix + anchor)})"

    def display(self, block: Display) -> str:
        latex = latex_without_absent(block.latex) if self.naming else block.latex
        parts = _lines(latex)
        whole = f"({typst_string(as_text(latex))}, ${as_typst(latex, True)}$)"
        broken = ""
        if len(parts) > 1:
            broken = "".join(f"({typst_string(as_text(p))}, ${as_typst(p, True)}$), " for p in parts)
        label = typst_string(f"({block.label})") if block.label else "none"
        anchor = self.label(block.anchor) if block.anchor else "none"
        small = ", small: true" if block.small else ""
        where = self.where("a formula", file_digest(block.latex))
        return f"#formula({where}, {whole}, ({broken}), {label}, {anchor}{small})"

    def figure(self, figure: FigureBlock) -> str:
        """A picture on its own lines; one with a caption may float."""
        picture = self.picture(figure.picture)
        if not figure.caption:
            return f"#drawing({picture}, none, {typst_string(figure.number)})"
        self.figures += 1
        id = f"{self.name} {self.figures} {file_digest(picture)}"
        floats = ", floats: true" if id in self.layout.floating else ""
        told = f"[{self.inline(figure.caption)}], {typst_string(figure.number)}"
        return f"#drawing({picture}, {told}, id: {typst_string(id)}{floats})"

    def grid(self, grid: Grid) -> str:
        self.in_table = True
        cells, measured = ",\n".join(self.table_cell(cell) for cell in grid.cells), self.measured(grid)
        self.in_table = False
        caption = f"[{self.inline(grid.caption)}]" if grid.caption else "none"
        notes = "".join(f"[{self.inline(note)}], " for note in grid.notes)
        self.tables += 1
        id = f"{self.name} {self.tables} {file_digest(measured)}"
        self.grids[id] = grid
        where = typst_string(f"{self.cell}|{grid.number or 'a table'}|{id}")
        size = f"{grid.rows}, {grid.head_rows}"
        rows = row_heights(grid)
        short = "true" if grid.rows <= 12 and sum(rows) < BREAKABLE_FROM else "false"
        whole = "true" if max(rows, default=0) < TALLEST_ROW else "false"
        body = f"(\n{cells},\n), {measured}, short: {short}, whole: {whole}"
        table = f"#data-table({where}, {size}, {caption}, {typst_string(grid.number)}, ({notes}), {body})"
        return f"#landscape[{table}]" if id in self.layout.turned else table

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
        pad = f"#{typst_string(cell.pad)};" if cell.pad else ""
        body = f"[{self.inline(cell.children)}{pad}]"
        if cell.mark:
            return f"marked({typst_string(cell.mark)}, {body})"
        return f"probe-strong({body})" if cell.head else body

    def table_cell(self, cell: Cell) -> str:
        optional = ""
        if cell.colspan > 1 or cell.rowspan > 1:
            optional += f", colspan: {cell.colspan}, rowspan: {cell.rowspan}"
        if cell.mark:
            optional += f", mark: {typst_string(cell.mark)}"
            optional += ", sentence: true" if is_sentence(cell) else ""
        if cell.ink or cell.ground:
            ink = cell.ink or readable_on(cell.ground)
            optional += f", ink: rgb({typst_string(ink)})"
        if cell.ground:
            optional += f", ground: rgb({typst_string(cell.ground)})"
        head = "true" if cell.head else "false"
        optional += ", again: true" if cell.again else ""
        body = self.inline(cell.children) + (f"#hide({typst_string(cell.pad)});" if cell.pad else "")
        return f"(x: {cell.x}, y: {cell.y}, align: {cell.align}, head: {head}{optional}, body: [{body}])"

    def _solid(self, cell: Cell) -> str:
        """The pieces of a cell that no line end divides, the longest word and each formula."""
        nodes = cell.children
        text = self.shown(plain([n for n in nodes if not isinstance(n, Math | Code)]))
        longest = max(breakable_words(breakable(text)), key=len)
        parts = [f"[#{typst_string(longest)};]"] if longest else []
        for node in nodes:
            if isinstance(node, Code):
                code = breakable(self.shown(node.text), LONGEST_CODE_IN_A_TABLE)
                parts.append(f"[{self.node(Code(max(breakable_words(code), key=len)))}]")
            elif isinstance(node, Math):
                short = len(as_text(node.latex)) < LONG_FORMULA
                parts += [
                    f"probe(${as_typst(part, False)}$)" for part in ([node.latex] if short else _lines(node.latex))
                ]
        return "".join(f"probe-strong({part}), " if cell.head else f"{part}, " for part in parts)

    def picture(self, picture: Picture) -> str:
        """The arguments that name a picture: file, alternative text, width in points or none."""
        data = self.drawing(picture.data) if picture.kind == "svg" else picture.data
        file = f"picture-{hashlib.sha256(data).hexdigest()[:16]}.{picture.kind}"
        self.files[file] = data
        width, height = picture.width, picture.height
        if width is None and height is None and picture.share is None and picture.kind != "svg":
            width = pixel_width(picture.data, picture.kind)
        wide = "none" if width is None else f"{min(width * 0.75, TEXT_WIDTH):g}pt"
        wide = f"{picture.share * 100:g}%" if picture.share else wide
        high = "none" if height is None else f"{min(height * 0.75, TEXT_HEIGHT):g}pt"
        return f"{typst_string(file)}, {typst_string(picture.alt)}, {wide}, {high}"

    def drawing(self, svg: bytes) -> bytes:
        """The drawing with fonts we have and without characters that these have not."""
        return with_known_fonts(without_absent(svg.decode(), "□").encode() if self.naming else svg)

    def where(self, what: str, id: str) -> str:
        return typst_string(f"{self.cell}|{what}|{id}")


def file_digest(text: str) -> str:
    """What a piece of a report is called between the engine and us: the same for the same content."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _together(code: Verbatim, output: Block) -> bool:
    """Do code and its output stay on one page? They may part where the two would leave much of a page empty."""
    match output:
        case Display():
            room = 3 * LINE
        case Grid():
            room = sum(row_heights(output)) + 3 * LINE
        case Verbatim():
            room = 2 * LINE
        case FigureBlock():
            return False
        case _:
            room = LINE
    return room + LINE * code.text.count("\n") < KEPT_UP_TO


def _stuck(line: str) -> bool:
    """Are there places in a line of a listing that we have to give it to break?"""
    return len(line) > LONGEST_IN_A_LISTING and len(text_pieces(line, LONGEST_IN_A_LISTING, LONGEST_IN_A_LISTING)) > 1


def runs_of(row: list[tuple[str, str]]) -> list[str]:
    """One line of a listing in runs of one colour, with the places where it may be broken.

    A run is ``("kind", "text"),``; ``none,`` is a place to break; several runs in a box are ``(box: (…)),``.
    """
    line = "".join(text for _, text in row)
    parts = text_pieces(line, LONGEST_IN_A_LISTING, LONGEST_IN_A_LISTING)
    if len(parts) <= 1 and not any(boxed for _, boxed in parts):
        return [f"({typst_string(kind)}, {typst_string(text)})," for kind, text in row]
    found: list[str] = []
    rest = list(row)
    before = True
    for piece, boxed in parts:
        runs, left = "", len(piece)
        while left and rest:
            kind, text = rest.pop(0)
            runs += f"({typst_string(kind)}, {typst_string(text[:left])}),"
            if len(text) > left:
                rest.insert(0, (kind, text[left:]))
            left -= min(left, len(text))
        found += [] if before or boxed else ["none,"]
        found.append(f"(box: ({runs}))," if boxed else runs)
        before = boxed
    return found


def _lines(latex: str) -> list[str]:
    """The pieces of a formula between possible line ends, each a formula: an operator at its start has two sides."""
    parts: list[str] = []
    left = ""
    for part in line_ends(latex):
        left += part
        if understood(left if not parts else "{}" + left):
            parts.append(left)
            left = ""
    if left or not parts:
        return [latex]
    first, *rest = parts
    return [first, *("{}" + part for part in rest)]
