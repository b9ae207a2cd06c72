"""HTML that others made (pandas, python-control, a Markdown cell) read into a report's blocks.

Tables keep their spans, mathematics between dollars is mathematics, text keeps its emphasis. What a page cannot show
(scripts, forms, frames, canvases, media) raises CannotShow with the element's name.
"""

import re
from typing import Any

from bs4 import BeautifulSoup, CData, Comment, Declaration, Doctype, NavigableString, ProcessingInstruction, Tag

from notebook_reports.export.errors import CannotShow
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
    Paragraph,
    Quote,
    Rule,
    Styled,
    Text,
    plain,
)
from notebook_reports.export.read import pictures
from notebook_reports.export.read.reading import Reading, anchor_of, flow, trim, with_math
from notebook_reports.export.read.tables import align_numbers, place

STYLES = {
    "b": "strong",
    "strong": "strong",
    "i": "emph",
    "em": "emph",
    "var": "emph",
    "cite": "emph",
    "dfn": "emph",
    "u": "underline",
    "ins": "underline",
    "del": "strike",
    "s": "strike",
    "strike": "strike",
    "sub": "sub",
    "sup": "super",
    "mark": "strong",
}
CODE = {"code", "kbd", "samp", "tt"}
THROUGH = {"span", "font", "small", "big", "abbr", "label", "time", "q", "bdi", "nobr", "data"}
BOXES = {"div", "section", "article", "main", "header", "footer", "center", "address", "p", "html", "body", "details"}
DROPPED = {"style", "colgroup", "col", "head", "title", "meta", "wbr", "link"}
_NOT_SHOWN = (Comment, Declaration, Doctype, ProcessingInstruction, CData)


def read_html(source: str, reading: Reading) -> list[Block]:
    """The blocks of an HTML text. Raises CannotShow for what has no form on a page."""
    return _blocks(BeautifulSoup(source, "html.parser"), reading)


def _blocks(parent: Tag, reading: Reading, math: bool = True) -> list[Block]:
    blocks: list[Block] = []
    line: list[Inline | Display] = []

    def close() -> None:
        blocks.extend(flow(line))
        line.clear()

    for child in parent.children:
        if not isinstance(child, Tag) or _is_inline(child):
            line.extend(_inline(child, reading, math))
            continue
        close()
        blocks.extend(_block(child, reading, math))
    close()
    return blocks


def _is_inline(tag: Tag) -> bool:
    return tag.name in STYLES or tag.name in CODE or tag.name in THROUGH or tag.name in {"a", "br", "img"}


def _block(tag: Tag, reading: Reading, math: bool) -> list[Block]:
    name = tag.name
    math = math and not _says_no_math(tag)
    named = [Paragraph([Anchor(str(tag["id"]))])] if name in BOXES and tag.get("id") else []
    if name in DROPPED:
        return []
    if name in BOXES:
        return named + _blocks(tag, reading, math)
    if name == "table":
        return [_table(tag, reading, math)]
    if name == "pre":
        return [Listing(tag.get_text().strip("\n"))]
    if name in ("ul", "ol"):
        items = [Item(_blocks(li, reading, math)) for li in tag.find_all("li", recursive=False)]
        return [Bullets(items, name == "ol", int(_number(tag, "start", 1)))]
    if name == "dl":
        return [_definitions(tag, reading, math)]
    if name == "blockquote":
        return [Quote(_blocks(tag, reading, math))]
    if name == "hr":
        return [Rule()]
    if name == "summary":
        return [Paragraph([Styled("strong", _line(tag, reading, math))])]
    if name == "figure":
        return _figure(tag, reading, math)
    if re.fullmatch("h[1-6]", name):
        children = _line(tag, reading, math)
        return [Heading(int(name[1]), children, str(tag.get("id") or anchor_of(plain(children))))]
    raise CannotShow(
        f"HTML with <{name}>, which a page cannot show; give the result another form (table, figure, text)"
    )


def _inline(node: Any, reading: Reading, math: bool) -> list[Inline | Display]:
    if isinstance(node, _NOT_SHOWN):
        return []
    if isinstance(node, NavigableString):
        text = str(node)
        return with_math(text, reading) if math else [Text(re.sub(r"[ \t\r\n]+", " ", text))]
    math = math and not _says_no_math(node)
    name = node.name
    inside = [part for child in node.children for part in _inline(child, reading, math)] if name not in CODE else []
    anchor = (
        [Anchor(str(node.get("id") or node["name"]))] if node.get("id") or (name == "a" and node.get("name")) else []
    )
    if name in CODE:
        return [*anchor, Code(node.get_text())]
    if name == "br":
        return [Break()]
    if name == "img":
        alt = reading.alt(node.get("alt"), "an image in HTML")
        picture = pictures.from_url(str(node.get("src", "")), alt, reading.attachments, reading.folder)
        picture.width = _number(node, "width", None)
        return [*anchor, picture]
    if name == "a" and node.get("href"):
        return [*anchor, Link(str(node["href"]), _no_display(inside))]
    if name in STYLES:
        return [*anchor, Styled(STYLES[name], _no_display(inside))]
    if name in THROUGH or name == "a":
        return [*anchor, *inside]
    if name in DROPPED:
        return []
    blocks = _block(node, reading, math)
    return _flat(blocks)


def _line(tag: Tag, reading: Reading, math: bool) -> list[Inline]:
    """The content of a tag as one line."""
    nodes: list[Inline] = []
    for child in tag.children:
        if isinstance(child, Tag) and not _is_inline(child):
            part = _flat(_block(child, reading, math))
            nodes += [*([Break()] if nodes and part else []), *part]
        else:
            nodes += _no_display(_inline(child, reading, math))
    trim(nodes)
    return nodes


def _flat(blocks: list[Block]) -> list[Inline]:
    """Blocks inside a line or a table cell, with line breaks between them."""
    parts: list[list[Inline]] = []
    for block in blocks:
        match block:
            case Paragraph(children) | Heading(_, children):
                parts.append(children)
            case Display(latex):
                parts.append([Math(latex)])
            case Listing(text):
                lines = [Code(line) for line in text.split("\n")]
                parts += [[line] for line in lines]
            case Bullets(items):
                parts += [[Text("• "), *_flat(item.blocks)] for item in items]
            case Figure(picture):
                parts.append([picture])
            case _:
                raise CannotShow(f"a {type(block).__name__.lower()} inside a table cell or a line of text")
    joined: list[Inline] = []
    for part in parts:
        joined += [*([Break()] if joined else []), *part]
    return joined


def _no_display(nodes: list[Inline | Display]) -> list[Inline]:
    return [Math(node.latex) if isinstance(node, Display) else node for node in nodes]


def _definitions(tag: Tag, reading: Reading, math: bool) -> Definitions:
    items: list[tuple[list[Inline], list[Block]]] = []
    for child in tag.find_all(["dt", "dd"]):
        if child.name == "dt":
            items.append((_line(child, reading, math), []))
        elif items:
            items[-1][1].extend(_blocks(child, reading, math))
    return Definitions(items)


def _figure(tag: Tag, reading: Reading, math: bool) -> list[Block]:
    caption = tag.find("figcaption")
    words = _line(caption, reading, math) if caption else []
    if caption:
        caption.extract()
    blocks = _blocks(tag, reading, math)
    if words and len(blocks) == 1 and isinstance(blocks[0], Figure | Grid):
        blocks[0].caption = words
        return blocks
    return [*blocks, *([Paragraph(words)] if words else [])]


def _table(tag: Tag, reading: Reading, math: bool) -> Grid:
    if tag.find("table"):
        raise CannotShow("an HTML table inside a table cell; show the tables one after the other")
    caption = tag.find("caption")
    sections = {"thead": [], "tbody": [], "tfoot": []}
    for row in tag.find_all("tr"):
        section = row.parent.name if row.parent.name in sections else "tbody"
        sections[section].append(row)
    head = sections["thead"]
    rows = head + sections["tbody"] + sections["tfoot"]
    if not head:
        leading = [row.find("td") is None and row.find("th") is not None for row in rows]
        head = rows[: leading.index(False) if False in leading else 0]
    cells = [[_cell(c, row, reading, math) for c in row.find_all(["th", "td"], recursive=False)] for row in rows]
    grid = place(cells, len(head))
    align_numbers(grid)
    grid.caption = _line(caption, reading, math) if caption else []
    return grid


def _cell(tag: Tag, row: Tag, reading: Reading, math: bool) -> Cell:
    spans = {key: max(1, int(_number(tag, key, 1))) for key in ("colspan", "rowspan")}
    styled = re.search(r"text-align:\s*(left|right|center)", str(tag.get("style", "")))
    align = styled[1] if styled else str(tag.get("align", ""))
    align = align if align in ("left", "right", "center") else ""
    return Cell(_line(tag, reading, math), align=align, head=tag.name == "th", **spans)


def _number(tag: Tag, key: str, default: Any) -> Any:
    found = re.match(r"\d+(\.\d+)?", str(tag.get(key, "")))
    return float(found[0]) if found else default


def _says_no_math(tag: Tag) -> bool:
    return bool({"tex2jax_ignore", "mathjax_ignore"} & set(tag.get("class") or ()))
