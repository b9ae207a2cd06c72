"""A report's blocks as HTML: semantic elements, mathematics as MathML, drawings inside, nothing fetched."""

import base64
import re
from dataclasses import dataclass, field
from html import escape

from notebook_reports.export import scripts
from notebook_reports.export.formulas import as_mathml, as_text
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
from notebook_reports.export.read.pictures import MIME
from notebook_reports.export.write.column_widths import is_sentence
from notebook_reports.export.write.highlighting import runs
from notebook_reports.export.write.inside_page import inside_page

_STYLES = {"emph": "em", "strong": "strong", "strike": "s", "underline": "u", "sub": "sub", "super": "sup"}
_MARKS = {"good": "✓", "note": "◆", "bad": "✗"}
LONG_FORMULA = 32
"""Characters of a formula's text from which on it may be wider than a phone, and scrolls by itself there."""
_ROLES = {"stderr": "Warning output", "error": "Error"}


@dataclass
class HtmlWriter:
    """Writes blocks as HTML. name: of the notebook. folded: code is shown to who opens it. notes: the footnotes met so
    far. scripts: those that what was written so far needs, each once."""

    name: str = ""
    folded: bool = False
    notes: list[Note] = field(default_factory=list)
    drawings: int = 0
    scripts: dict[str, None] = field(default_factory=dict)

    def report_cell(self, cell: ReportCell) -> str:
        """One cell of the notebook with its anchor."""
        page = ' class="new-page"' if cell.new_page else ""
        anchor = f'<div id="{cell.anchor}"{page}>' if cell.anchor else f"<div{page}>"
        return f"{anchor}\n{self.blocks(cell.blocks)}\n</div>"

    def blocks(self, blocks: list[Block]) -> str:
        return "\n".join(self.block(block) for block in blocks)

    def block(self, block: Block) -> str:
        match block:
            case Paragraph(children):
                return f"<p>{self.inline(children)}</p>"
            case Heading():
                return self.heading(block)
            case Display():
                return self.display(block)
            case Verbatim():
                return self.listing(block)
            case Bullets():
                tag = "ol" if block.ordered else "ul"
                start = f' start="{block.start}"' if block.ordered and block.start != 1 else ""
                style = f' type="{block.style}"' if block.ordered and block.style != "1" else ""
                items = "".join(self.item(item, block.tight) for item in block.items)
                return f"<{tag}{start}{style}>{items}</{tag}>"
            case Definitions(items):
                parts = (f"<dt>{self.inline(term)}</dt><dd>{self.blocks(body)}</dd>" for term, body in items)
                return f"<dl>{''.join(parts)}</dl>"
            case Quote(blocks):
                return f"<blockquote>{self.blocks(blocks)}</blockquote>"
            case Alert(kind, blocks):
                return f'<div class="alert {kind}" role="note">{self.blocks(blocks)}</div>'
            case Folded(words, blocks):
                return _fold(escape(words), self.blocks(blocks))
            case Aside(blocks):
                return f'<aside class="margin">{self.blocks(blocks)}</aside>'
            case Mend():
                return self.mend(block)
            case ThematicBreak():
                return "<hr>"
            case Grid():
                return self.grid(block)
            case FigureBlock(picture, caption, number):
                told = f"<figcaption>{self.caption(number, caption)}</figcaption>" if caption else ""
                return f'<figure><div class="sheet">{self.picture(picture)}</div>{told}</figure>'
            case Live():
                return self.live(block)
        raise TypeError(f"no HTML form for {type(block).__name__}")

    def live(self, block: Live) -> str:
        """Data with the package's markup before it; where no script runs, what stands for it."""
        self.scripts[block.script] = None
        data = f'<script type="application/json" class="data">{scripts.as_text(block.data)}</script>'
        instead = f"<noscript>{self.blocks(block.instead)}</noscript>" if block.instead else ""
        return f'<div class="live" data-mime="{escape(block.mime)}">{block.markup}{data}</div>{instead}'

    def use(self, *scripts: str) -> None:
        """Put scripts of the page before those of its data."""
        self.scripts = {**dict.fromkeys(script for script in scripts if script), **self.scripts}

    def ending(self) -> str:
        """The scripts of the page, at its end."""
        return "".join(f"<script>{script}</script>\n" for script in self.scripts)

    def policy(self) -> str:
        """The page's policy; known when all of it is written."""
        return scripts.policy(self.scripts)

    def heading(self, heading: Heading) -> str:
        tag = f"h{min(heading.level + 1, 6)}"
        number = f'<span class="number">{heading.number}</span> ' if heading.number else ""
        anchor = escape(heading.anchor)
        link = f'<a class="anchor" href="#{anchor}" aria-label="Link to this section"></a>' if anchor else ""
        return f'<{tag} id="{anchor}">{number}{self.inline(heading.children)}{link}</{tag}>'

    def display(self, block: Display) -> str:
        anchor = f' id="{escape(block.anchor)}"' if block.anchor else ""
        label = f'<span class="label">({escape(block.label)})</span>' if block.label else ""
        body = f'<div class="scroll" tabindex="0">{as_mathml(block.latex, True)}</div>'
        return f'<div class="formula"{anchor}>{body}{label}</div>'

    def listing(self, block: Verbatim) -> str:
        cut = ((kind, escape(text, quote=False)) for kind, text in runs(block.text, block.language))
        body = "".join(f'<span class="{kind}">{text}</span>' if kind else text for kind, text in cut)
        told = f' role="group" aria-label="{_ROLES[block.role]}"' if block.role in _ROLES else ""
        shown = f'<pre class="{block.role}"{told}><code>{body}</code></pre>'
        if block.role != "input" or not (self.folded or block.folded):
            return shown
        lines = block.text.count("\n") + 1
        return _fold(f"Code<small>, {lines} line{'s' if lines > 1 else ''}</small>", shown)

    def item(self, item: ListItem, tight: bool) -> str:
        checked = " checked" if item.checked else ""
        start = "<li>" if item.value is None else f'<li value="{item.value}">'
        if item.checked is not None:
            start = f'<li class="task"><input type="checkbox" disabled{checked} aria-label="task"> '
        parts = [self.inline(b.children) if tight and isinstance(b, Paragraph) else self.block(b) for b in item.blocks]
        return start + "\n".join(parts) + "</li>"

    def caption(self, number: str, caption: list[Inline]) -> str:
        return (f"<b>{number}.</b> " if number else "") + self.inline(caption)

    def grid(self, grid: Grid) -> str:
        rows: list[list[str]] = [[] for _ in range(grid.rows)]
        for cell in sorted(grid.cells, key=lambda c: (c.y, c.x)):
            rows[cell.y].append(self.cell(cell, cell.y < grid.head_rows))
        lines = [f"<tr>{''.join(row)}</tr>" for row in rows]
        head = f"<thead>{''.join(lines[: grid.head_rows])}</thead>" if grid.head_rows else ""
        body = "\n".join(lines[grid.head_rows :])
        caption = f"<caption>{self.caption(grid.number, grid.caption)}</caption>" if grid.caption else ""
        name = escape(f"{grid.number}. {plain(grid.caption)}" if grid.caption else "Table")
        notes = "".join(f"<p>{self.inline(note)}</p>" for note in grid.notes)
        notes = f'<div class="notes">{notes}</div>' if notes else ""
        table = f"<table>{caption}{head}<tbody>{body}</tbody></table>"
        scrolls = f'<div class="scroll" role="region" aria-label="{name}" tabindex="0">{table}</div>'
        return f'<div class="table">{scrolls}{notes}</div>'

    def cell(self, cell: Cell, in_head: bool) -> str:
        tag = "th" if cell.head else "td"
        spans = "".join(f' {k}="{v}"' for k, v in (("colspan", cell.colspan), ("rowspan", cell.rowspan)) if v > 1)
        scope = f' scope="{("colgroup" if cell.colspan > 1 else "col") if in_head else "row"}"' if cell.head else ""
        mark = "" if is_sentence(cell) else cell.mark
        classes = [c for c in (cell.align if cell.align != "left" else "", mark, "again" * cell.again) if c]
        if len(plain(cell.children)) > 28:
            classes.append("long")
        css = f' class="{" ".join(classes)}"' if classes else ""
        css += _looks(cell)
        symbol = f'<span class="symbol {cell.mark}">{_MARKS[cell.mark]}</span> ' if cell.mark else ""
        return f"<{tag}{spans}{scope}{css}>{symbol}{self.inline(cell.children)}</{tag}>"

    def inline(self, nodes: list[Inline]) -> str:
        """Inline nodes; a formula keeps the punctuation after it on its line."""
        parts: list[str] = []
        for i, node in enumerate(nodes):
            shown = self.node(node)
            before = nodes[i - 1] if i else None
            mark = re.match(r"[.,;:!?)\]…’”-]+", shown) if isinstance(before, Math) and isinstance(node, Text) else None
            if mark:
                parts[-1] = f'<span class="together">{parts[-1]}{mark[0]}</span>'
                shown = shown[mark.end() :]
            parts.append(shown)
        return "".join(parts)

    def node(self, node: Inline) -> str:
        match node:
            case Text(text):
                return escape(text, quote=False)
            case Code(text):
                return f"<code>{escape(text, quote=False)}</code>"
            case Math(latex):
                shown = as_mathml(latex, False)
                return f'<span class="wide">{shown}</span>' if len(as_text(latex)) > LONG_FORMULA else shown
            case Styled(style, children):
                return f"<{_STYLES[style]}>{self.inline(children)}</{_STYLES[style]}>"
            case Coloured(children, ink, ground):
                return f"<span{_colours(ink, ground)}>{self.inline(children)}</span>"
            case Mend():
                return self.mend_in_line(node)
            case Link(kind="nowhere"):
                return self.inline(node.children)
            case Link():
                return f'<a href="{escape(self.address(node))}">{self.inline(node.children)}</a>'
            case Picture():
                return self.picture(node)
            case Break():
                return "<br>"
            case Anchor(name):
                return f'<span id="{escape(name)}"></span>'
            case Note(number, blocks):
                again = not blocks
                if blocks:
                    self.notes.append(node)
                back = "" if again else f' id="footnote-{number}-from"'
                return f'<sup><a{back} href="#footnote-{number}" role="doc-noteref">{number}</a></sup>'
        raise TypeError(f"no HTML form for {type(node).__name__}")

    def mend(self, mend: Mend) -> str:
        """What stands in place of a block: a box, or for a remark a line."""
        if mend.remark:
            return f'<p class="remark">{_mend_number(mend)} {escape(sentence(mend))}</p>'
        words = f"<p>{escape(mend.text)}</p>" if mend.text.strip() else ""
        if words and mend.kind in ("formula", "cell"):
            words = f"<pre><code>{escape(mend.text)}</code></pre>"
        address = f'<p class="address">{escape(mend.address)}</p>' if mend.address else ""
        told = f"<b>{KINDS[mend.kind]} not shown</b>: {escape(mend.reason)}"
        return f'<div class="mend" role="note"><p>{_mend_number(mend)} {told}</p>{words}{address}</div>'

    def mend_in_line(self, mend: Mend) -> str:
        """The same inside a line."""
        if mend.remark:
            told = f"{mend.reason}{f': {mend.address}' if mend.address else ''}"
            return f' <span class="remark">[{_mend_number(mend)} {escape(told)}]</span>'
        source = f"<code>{escape(mend.text)}</code> " if mend.kind == "formula" else ""
        return f'<span class="mend">{_mend_number(mend)} {source}{escape(sentence(mend))}</span>'

    def mends(self, report: Report) -> str:
        """The list of mends at the end, or nothing."""
        items = "".join(
            f'<li id="mend-list-{m.number}"><a href="#mend-{m.number}">{f"Cell {cell}. " if cell else ""}</a>'
            f"{escape(sentence(m))}</li>"
            for cell, m in report.mends
        )
        title = "What this document shows otherwise"
        return f'<section class="mends"><h2>{title}</h2><ol>{items}</ol></section>' if items else ""

    def address(self, link: Link) -> str:
        if link.kind == "internal":
            return "#" + link.target
        return relative_address(link.target, self.name, ".html") if link.kind == "notebook" else link.target

    def footnotes(self) -> str:
        """The footnotes met so far, or nothing."""
        items = []
        for note in self.notes:
            back = f'<a href="#footnote-{note.number}-from" role="doc-backlink" aria-label="back to the text">↩</a>'
            items.append(f'<li id="footnote-{note.number}">{self.blocks(note.blocks)} {back}</li>')
        if not items:
            return ""
        return (
            f'<section class="footnotes" role="doc-endnotes" aria-label="Footnotes"><ol>{"".join(items)}</ol></section>'
        )

    def picture(self, picture: Picture) -> str:
        """A drawing inside the page where it can be, so that its text can be found; else as an image of data."""
        alt = escape(picture.alt)
        if picture.kind == "svg":
            self.drawings += 1
            inside = inside_page(picture.data.decode(), f"d{self.drawings}", alt)
            if inside:
                return inside
        width = f' width="{picture.width:g}"' if picture.width else ""
        width += f' height="{picture.height:g}"' if picture.height else ""
        width = f' style="width:{picture.share * 100:g}%"' if picture.share else width
        data = base64.b64encode(picture.data).decode()
        return f'<img src="data:{MIME[picture.kind]};base64,{data}" alt="{alt}"{width}>'


def _looks(cell: Cell) -> str:
    """The style of a cell: its colours, and the room behind a number for the decimal points of its column."""
    digits, point = cell.pad.count("0"), 0.5 * cell.pad.count(".")
    pad = f"padding-right:calc(.6rem + {digits + point:g}ch)" if cell.pad else ""
    colours = _colours(cell.ink, cell.ground)
    return colours if not pad else f'{colours[:-1]};{pad}"' if colours else f' style="{pad}"'


def _fold(words: str, body: str) -> str:
    return f'<details class="fold"><summary>{words}</summary>{body}</details>'


def _colours(ink: str, ground: str) -> str:
    if not ink and not ground:
        return ""
    ink = ink or readable_on(ground)
    return f' style="color:{ink}{f";background:{ground}" if ground else ""}"'


def _mend_number(mend: Mend) -> str:
    return f'<a class="mend-number" id="mend-{mend.number}" href="#mend-list-{mend.number}">{mend.number}</a>'
