"""Markdown cells, through nbconvert's own mathematics-aware mistune parsers, into a report's blocks."""

import html
import re
from collections.abc import Sequence
from functools import cache, partial
from typing import Any

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
    FigureBlock,
    Heading,
    Inline,
    Link,
    ListItem,
    Math,
    Mend,
    Note,
    Paragraph,
    Quote,
    Styled,
    Text,
    ThematicBreak,
    Verbatim,
    plain,
)
from notebook_reports.export.read import pictures
from notebook_reports.export.read.css import Looks
from notebook_reports.export.read.footnotes import unused, with_missing
from notebook_reports.export.read.html import HtmlReader, read_html
from notebook_reports.export.read.html_in_markdown import as_html, interleaved
from notebook_reports.export.read.html_names import CODE, STYLES, THROUGH, is_no_tag
from notebook_reports.export.read.html_tree import tree_of
from notebook_reports.export.read.pipe_tables import with_whole_tables
from notebook_reports.export.read.reading import Reading, anchor_of, flow, trim
from notebook_reports.export.read.tables import align_numbers, grid_of
from notebook_reports.export.read.terminal import visible

PLUGINS = ("strikethrough", "table", "url", "task_lists", "def_list", "footnotes")
_EMPHASIS = {"emphasis": "emph", "strong": "strong", "strikethrough": "strike"}
_TABLE_RULE = re.compile(r"^ {0,3}\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)+\|?\s*$", re.MULTILINE)


@cache
def _parser() -> Any:
    from mistune import Markdown, import_plugin
    from nbconvert.filters.markdown_mistune import MathBlockParser, MathInlineParser

    return Markdown(None, MathBlockParser(), MathInlineParser(hard_wrap=False), [import_plugin(p) for p in PLUGINS])


def read_markdown(source: str, reading: Reading) -> list[Block]:
    """The blocks of a Markdown text; what cannot be shown is noted in `reading.problems`."""
    if reading.mending:
        source = with_whole_tables(source)
    whole, shared = with_missing(source, reading.footnotes)
    tokens = _parser()(whole)
    if reading.mending and interleaved(tokens):
        return read_html(as_html(whole), reading)
    notes = {}
    for token in tokens:
        if token["type"] == "footnotes":
            notes = {item["attrs"]["key"]: item["children"] for item in token["children"]}
    cell = _Cell(reading, notes, shared)
    blocks = cell.blocks(tokens)
    for key, text in unused(source, reading.note_references):
        blocks += [Paragraph([Text(f"[^{key}]: ")]), *cell.blocks(_parser()(text))]
    return blocks


class _Cell:
    """Reads the tokens of one text. notes: the tokens of each footnote by key; shared: those of other cells."""

    def __init__(self, reading: Reading, notes: dict[str, list[dict[str, Any]]], shared: frozenset[str] = frozenset()):
        self.reading = reading
        self.notes = notes
        self.shared = shared
        self.numbers: dict[str, int] = {}

    def blocks(self, tokens: list[dict[str, Any]]) -> list[Block]:
        blocks: list[Block] = []
        for token in tokens:
            blocks.extend(self.reading.attempt(partial(self.block, token), _written(token)))
        return blocks

    def block(self, token: dict[str, Any]) -> list[Block]:
        match token["type"]:
            case "blank_line" | "footnotes":
                return []
            case "heading":
                children = _lines_only(self.inline(token["children"]))
                trim(children)
                return [Heading(token["attrs"]["level"], children, anchor_of(plain(children)))]
            case "paragraph" | "block_text":
                nodes = self.inline(token["children"])
                self.refuse_broken_table(nodes)
                return flow(nodes)
            case "block_code":
                info = (token.get("attrs") or {}).get("info") or ""
                return [Verbatim(visible(token["raw"].expandtabs(4)).rstrip("\n"), "code", info.split(" ")[0])]
            case "block_quote":
                return [Quote(self.blocks(token["children"]))]
            case "list":
                items = [self.item(child) for child in token["children"]]
                start = token["attrs"].get("start", 1)
                return [Bullets(items, token["attrs"]["ordered"], start, token["tight"])]
            case "thematic_break":
                return [ThematicBreak()]
            case "table":
                return [self.table(token)]
            case "def_list":
                return [self.definitions(token)]
            case "block_html":
                return read_html(token["raw"], self.reading)
        raise CannotShow(f"Markdown of the kind {token['type']}, which a report cannot show")

    def item(self, token: dict[str, Any]) -> ListItem:
        return ListItem(self.blocks(token["children"]), (token.get("attrs") or {}).get("checked"))

    def definitions(self, token: dict[str, Any]) -> Definitions:
        items: list[tuple[list[Inline], list[Block]]] = []
        for child in token["children"]:
            if child["type"] == "def_list_head":
                items.append((_lines_only(self.inline(child["children"])), []))
            else:
                items[-1][1].extend(self.blocks(child["children"]))
        return Definitions(items)

    def table(self, token: dict[str, Any]) -> Block:
        head, *body = token["children"]
        rows = [head["children"], *(row["children"] for part in body for row in part["children"])]
        cells = [[self.cell(c) for c in row] for row in rows]
        grid = grid_of(cells, 1)
        align_numbers(grid)
        return grid

    def cell(self, token: dict[str, Any]) -> Cell:
        children = _lines_only(self.inline(token["children"]))
        trim(children)
        return Cell(children, align=token["attrs"]["align"] or "", head=token["attrs"]["head"])

    def refuse_broken_table(self, nodes: list[Inline | Display]) -> None:
        if self.reading.mending:
            return
        text = "".join(
            "\n" if isinstance(n, Text) and n.text == " " else plain([n]) for n in nodes if isinstance(n, Text)
        )
        if _TABLE_RULE.search(text):
            raise CannotShow(
                "a pipe table whose rows have different numbers of cells; write \\vert for | in mathematics and give "
                f"each row as many cells as the head: {text.strip().splitlines()[0]}"
            )

    def inline(self, tokens: list[dict[str, Any]]) -> list[Inline | Display]:
        """The nodes of a line. HTML tags pair up inside it."""
        stack: list[tuple[str, str, list[Inline | Display]]] = [("", "", [])]
        for token in tokens:
            if token["type"] != "inline_html":
                stack[-1][2].extend(self.reading.attempt(partial(self.node, token), token.get("raw", "")))
                continue
            raw = token["raw"]
            if is_no_tag(raw):
                stack[-1][2].append(Text(raw))
                continue
            closing = re.fullmatch(r"</\s*([A-Za-z0-9]+)\s*>", raw)
            opening = re.fullmatch(r"<([A-Za-z0-9]+)(\s[^>]*)?>", raw, re.DOTALL)
            if raw.startswith("<!--"):
                continue
            if closing and closing[1].lower() == "br":
                stack[-1][2].append(Break())
            elif closing:
                name = closing[1].lower()
                if stack[-1][0] != name:
                    raise CannotShow(f"HTML {raw} that closes nothing in its paragraph")
                _, tag, children = stack.pop()
                stack[-1][2].extend(self.paired(name, tag, _lines_only(children)))
            elif opening and not raw.endswith("/>") and opening[1].lower() not in ("br", "img", "hr", "wbr"):
                stack.append((opening[1].lower(), raw, []))
            else:
                stack[-1][2].extend(part for block in read_html(raw, self.reading) for part in _line_of(block, raw))
                if re.match(r"<br\b", raw, re.IGNORECASE):
                    stack[-1][2].append(Break())
        if len(stack) > 1:
            raise CannotShow(f"HTML {stack[-1][1]} that is not closed in its paragraph")
        return stack[0][2]

    def paired(self, name: str, raw: str, children: list[Inline]) -> list[Inline]:
        """What stands between two tags, as the first asks for it."""
        tree, _ = tree_of(raw)
        tag, looks = tree.find(), Looks(tree)
        assert tag is not None, "the text of a tag holds a tag"
        look = looks.of(tag)
        if look.hidden:
            return []
        anchor = str(tag.get("id") or (tag.get("name") if name == "a" else "") or "")
        before: list[Inline] = [Anchor(anchor)] if anchor else []
        if name == "a" and tag.get("href"):
            return [*before, Link(str(tag["href"]), children)]
        if name in CODE:
            return [*before, Code(plain(children))]
        if name == "q":
            return [*before, Text("“"), *children, Text("”")]
        if name in STYLES or name in THROUGH or name == "a":
            return [*before, *HtmlReader(self.reading, looks, [], True).dressed(tag, look, children)]
        raise CannotShow(f"HTML {raw}, which a page cannot show; write it in Markdown")

    def node(self, token: dict[str, Any]) -> Sequence[Inline | Display]:
        kind = token["type"]
        match kind:
            case "text":
                return [Text(visible(html.unescape(token["raw"])).replace("\t", " "))]
            case "softbreak":
                return [Text(" ")]
            case "linebreak":
                return [Break()]
            case "codespan":
                return [Code(visible(token["raw"]))]
            case "emphasis" | "strong" | "strikethrough":
                return [Styled(_EMPHASIS[kind], _lines_only(self.inline(token["children"])))]
            case "link":
                return [Link(html.unescape(token["attrs"]["url"]), _lines_only(self.inline(token["children"])))]
            case "image":
                return [self.image(token)]
            case "inline_math":
                return self.reading.math(token["raw"])
            case "block_math":
                return self.reading.display(token["raw"])
            case "latex_environment":
                name, body = token["attrs"]["name"], token["attrs"]["body"]
                return self.reading.display(rf"\begin{{{name}}}{body}\end{{{name}}}")
            case "footnote_ref":
                return [self.note(token["raw"])]
        raise CannotShow(f"Markdown of the kind {kind}, which a report cannot show")

    def image(self, token: dict[str, Any]) -> Inline:
        url = html.unescape(token["attrs"]["url"])
        alt = self.reading.alt(plain(_lines_only(self.inline(token["children"]))), f"the image {url[:60]}")
        return pictures.from_url(url, alt, self.reading.attachments, self.reading.folder, self.reading.root)

    def note(self, key: str) -> Note:
        known = next((k for k in self.notes if k.lower() == key.lower()), None)
        if known is None:
            raise CannotShow(f"the footnote [^{key}] has no text in this cell")
        numbers = self.reading.note_numbers if known in self.shared else self.numbers
        if known in numbers:
            return Note(numbers[known], [])
        self.reading.notes += 1
        numbers[known] = self.reading.notes
        if known in self.reading.footnotes:
            self.reading.note_numbers.setdefault(known, numbers[known])
        return Note(numbers[known], self.blocks(self.notes[known]))


def _written(token: dict[str, Any]) -> str:
    """What is written in a token and below."""
    return token.get("raw", "") + " ".join(_written(child) for child in token.get("children") or ())


def _lines_only(nodes: list[Inline | Display]) -> list[Inline]:
    """Nodes for a place that has no room for a displayed formula, such as a table cell."""
    return [Math(node.latex) if isinstance(node, Display) else node for node in nodes]


def _line_of(block: Block, raw: str) -> list[Inline]:
    match block:
        case Mend():
            return [block]
        case FigureBlock(picture):
            return [picture]
        case Paragraph(children):
            return children
    raise CannotShow(f"HTML {raw[:60]} inside a line of text")
