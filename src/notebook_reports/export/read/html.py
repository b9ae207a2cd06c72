"""HTML that others made (pandas, python-control, a Markdown cell) read into a report's blocks.

Tables keep their spans, mathematics between dollars is mathematics, text keeps its emphasis and its colours. What a
page cannot show (scripts, frames, canvases, media) becomes a `Mend`, or, strictly, a `CannotShow` with the element's
name.
"""

import re
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeVar

from bs4 import CData, Comment, Declaration, Doctype, NavigableString, ProcessingInstruction, Tag

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import (
    Alert,
    Anchor,
    Block,
    Break,
    Bullets,
    Code,
    Coloured,
    Definitions,
    Display,
    FigureBlock,
    Grid,
    Heading,
    Inline,
    Link,
    ListItem,
    Math,
    Mend,
    Paragraph,
    Picture,
    Quote,
    Styled,
    Text,
    ThematicBreak,
    Verbatim,
    plain,
)
from notebook_reports.export.read import html_tables, pictures
from notebook_reports.export.read.css import Appearance, Looks
from notebook_reports.export.read.flat import flat
from notebook_reports.export.read.html_names import (
    BLOCKS,
    BOXES,
    CODE,
    CONTROLS,
    DROPPED,
    EMBEDDED,
    NAMES,
    STYLES,
    THROUGH,
)
from notebook_reports.export.read.html_tree import tree_of
from notebook_reports.export.read.reading import Reading, anchor_of, flow, trim, with_math
from notebook_reports.export.read.terminal import visible

_NOT_SHOWN = (Comment, Declaration, Doctype, ProcessingInstruction, CData)
_HEADING = re.compile(r"h[1-6]")
_LINE = {*STYLES, *CODE, *THROUGH, *CONTROLS, "a", "br", "img", "image", "x-math", "x-text", "x-svg", "math"}
_FOR_FORMULAS = re.compile(r"\A\s*(/\*.*?\*/\s*|//[^\n]*\n\s*)*MathJax\.Hub\.Config\(", re.DOTALL)
LineNode = TypeVar("LineNode", bound=Inline | Display)
_NO_SCRIPT = re.compile(r"json|template|html|math/tex|plain|glsl|x-shader")


def read_html(source: str, reading: Reading, anchors: bool = True) -> list[Block]:
    """The blocks of an HTML text. anchors: its ids are places that links may lead to.

    Strictly, raises CannotShow for what has no form on a page.
    """
    tree, drawings = tree_of(source)
    blocks = HtmlReader(reading, Looks(tree), drawings, anchors).blocks(tree)
    return _scripts_together(blocks)


def _scripts_together(blocks: list[Block]) -> list[Block]:
    """Neighbouring boxes for scripts as one with their number."""
    kept: list[Block] = []
    count = 1
    for block in blocks:
        last = kept[-1] if kept else None
        if isinstance(block, Mend) and isinstance(last, Mend) and block.kind == last.kind == "script":
            count += 1
            last.reason = f"a page runs no scripts; here are {count}"
        else:
            count = 1
            kept.append(block)
    return kept


class HtmlReader:
    """Reads one tree. drawings: the SVG texts that stood in it, by number."""

    def __init__(self, reading: Reading, looks: Looks, drawings: list[str], anchors: bool):
        self.reading = reading
        self.looks = looks
        self.drawings = drawings
        self.anchors = anchors

    # -- blocks ------------------------------------------------------------------------------------------------

    def blocks(self, parent: Tag, math: bool = True) -> list[Block]:
        """What is inside an element, as blocks."""
        blocks: list[Block] = []
        line: list[Inline | Display] = []

        def close() -> None:
            blocks.extend(flow(line))
            line.clear()

        for child in parent.children:
            if not isinstance(child, Tag) or self.is_inline(child):
                line.extend(self.inline(child, math))
                continue
            close()
            blocks.extend(self.reading.attempt(partial(self.block, child, math)))
        close()
        return blocks

    def is_inline(self, tag: Tag) -> bool:
        """Does the element stand in a line? One that holds blocks does not."""
        if tag.name not in _LINE and (tag.name in NAMES or tag.name in ("html", "[document]")):
            return False
        return not any(
            isinstance(inside, Tag) and inside.name not in _LINE and inside.name in NAMES - DROPPED - {"script"}
            for inside in tag.descendants
        )

    def block(self, tag: Tag, math: bool) -> list[Block]:
        """One element that stands on lines of its own. Raises CannotShow."""
        name, look = tag.name, self.looks.of(tag)
        math = math and not says_no_math(tag)
        if look.hidden:
            return [*self.hidden(tag)]
        if name in DROPPED:
            return []
        if name in EMBEDDED:
            return self.embedded(tag, math)
        if name == "form" and not self.reading.mending:
            raise CannotShow(_refusal(name))
        if name in BLOCKS or _HEADING.fullmatch(name):
            return self.known_block(tag, math, look)
        named = [Paragraph([Anchor(str(tag["id"]))])] if self.anchors and tag.get("id") and name in BOXES else []
        alert = re.search(r"\b(?:alert|admonition)(?:-(info|success|warning|danger|error))?\b", _classes(tag))
        inside = self.blocks(tag, math)
        if alert and inside:
            return [*named, Alert(_alert_kind(_classes(tag)), inside)]
        return named + self.wrapped(tag, look, inside)

    def known_block(self, tag: Tag, math: bool, look: Appearance) -> list[Block]:
        match tag.name:
            case "table":
                return html_tables.read(self, tag, math)
            case "pre" | "xmp" | "plaintext" | "listing":
                for br in tag.find_all("br"):
                    br.replace_with("\n")
                text = visible(tag.get_text().expandtabs(8)).strip("\n")
                return [Verbatim(text, "code", str(tag.get("data-language", "")))] if text.strip() else []
            case "ul" | "ol" | "menu" | "dir":
                return self.bullets(tag, math)
            case "dl":
                return [self.definitions(tag, math)]
            case "blockquote":
                return [Quote(self.blocks(tag, math))]
            case "hr":
                return [ThematicBreak()]
            case "summary":
                return [Paragraph([Styled("strong", self.line(tag, math))])]
            case "figure":
                return self.figure(tag, math)
        children = self.line(tag, math)
        if not plain(children).strip() and not any(isinstance(node, Picture | Mend) for node in children):
            return []
        return [Heading(int(tag.name[1]), children, str(tag.get("id") or anchor_of(plain(children))))]

    def hidden(self, tag: Tag) -> list[Mend]:
        """Nothing of a hidden element is shown; the macros that it defines are known."""
        text = tag.get_text()
        if "\\" in text:
            with_math(text, self.reading)
        return []

    def wrapped(self, tag: Tag, look: Appearance, blocks: list[Block]) -> list[Block]:
        """The blocks inside an element that belongs in a line, such as ``<font><p>``, its look on their words."""
        for block in blocks:
            if isinstance(block, Paragraph | Heading):
                block.children = self.dressed(tag, look, block.children)
        return blocks

    def bullets(self, tag: Tag, math: bool) -> list[Block]:
        items: list[ListItem] = []
        for child in tag.children:
            if isinstance(child, Tag) and child.name == "li" and not self.looks.of(child).hidden:
                value = _number(child, "value") if tag.name == "ol" else None
                items.append(ListItem(self.blocks(child, math), value=None if value is None else int(value)))
            elif not isinstance(child, Tag) and not (isinstance(child, NavigableString) and child.strip()):
                continue
            else:
                blocks = self.block(child, math) if isinstance(child, Tag) else flow(self.inline(child, math))
                if blocks and items:
                    items[-1].blocks.extend(blocks)
                elif blocks:
                    items.append(ListItem(blocks))
        if not items:
            return []
        style = str(tag.get("type", "1"))
        start = int(_number(tag, "start") or 1)
        return [Bullets(items, tag.name == "ol", start, style=style if style in "1aAiI" else "1")]

    def definitions(self, tag: Tag, math: bool) -> Definitions:
        items: list[tuple[list[Inline], list[Block]]] = []
        for child in tag.children:
            if not isinstance(child, Tag):
                body = flow(self.inline(child, math))
            elif child.name == "dt":
                items.append((self.line(child, math), []))
                continue
            elif child.name == "div":
                items += self.definitions(child, math).items
                continue
            elif child.name == "dd":
                body = self.blocks(child, math)
            elif not self.is_inline(child):
                body = self.block(child, math)
            else:
                body = flow(self.inline(child, math))
            if body and items:
                items[-1][1].extend(body)
            elif body:
                items.append(([], body))
        return Definitions(items)

    def figure(self, tag: Tag, math: bool) -> list[Block]:
        caption = tag.find("figcaption")
        words = self.line(caption, math) if caption else []
        if caption:
            caption.extract()
        blocks = self.blocks(tag, math)
        if words and len(blocks) == 1 and isinstance(blocks[0], FigureBlock | Grid):
            blocks[0].caption = words
            return blocks
        return [*blocks, *([Paragraph(words)] if words else [])]

    def embedded(self, tag: Tag, math: bool) -> list[Block]:
        """A box for a frame, a film, a script; of a film its poster too."""
        kind = EMBEDDED[tag.name]
        if tag.name == "script":
            type_ = str(tag.get("type", ""))
            if "math/tex" in type_:
                text = tag.get_text()
                return flow(self.reading.display(text) if "display" in type_ else self.reading.math(text))
            if _NO_SCRIPT.search(type_) or _FOR_FORMULAS.search(tag.get_text()):
                return []
        if tag.name == "frameset":
            return [block for child in tag.find_all("frame") for block in self.embedded(child, math)]
        inside = tag.find("source")
        address = str(tag.get("src") or tag.get("data") or (inside.get("src") if inside else "") or "")
        if not self.reading.mending:
            raise CannotShow(_refusal(tag.name))
        reasons = {
            "script": "a page runs no scripts" if tag.name == "script" else "a script draws it",
            "frame": "a page holds no other page",
            "video": "a page does not move",
            "audio": "a page makes no sound",
        }
        if address.startswith("data:"):
            address = (
                f"{address[5:].partition(',')[0].partition(';')[0]} of {len(address) * 3 // 4:,} bytes, in the notebook"
            )
        words = str(tag.get("title") or tag.get("aria-label") or tag.get("alt") or "")
        found: list[Block] = []
        if tag.get("poster"):
            found += flow(self.reading.attempt(lambda: [self.picture_from(str(tag["poster"]), "poster", tag)]))
        found.append(Mend(kind, reasons[kind], words, address[:300]))
        if tag.name in ("object", "canvas", "audio", "video"):
            found += self.blocks(tag, math)
        return found

    # -- lines -------------------------------------------------------------------------------------------------

    def inline(self, node: Any, math: bool) -> Sequence[Inline | Display]:
        """The nodes of one piece of a line."""
        if isinstance(node, _NOT_SHOWN):
            return []
        if isinstance(node, NavigableString):
            text = visible(str(node))
            return with_math(text, self.reading) if math else [Text(re.sub(r"[ \t\r\n\f]+", " ", text))]
        return self.reading.attempt(lambda: self.inline_tag(node, math))

    def inline_tag(self, tag: Tag, math: bool) -> Sequence[Inline | Display]:
        name, look = tag.name, self.looks.of(tag)
        if look.hidden:
            return self.hidden(tag)
        if name in DROPPED:
            return []
        if name not in _LINE and (name in NAMES or _HEADING.fullmatch(name)):
            return flat(self.block(tag, math))
        math = math and not says_no_math(tag)
        id_ = str(tag.get("id") or (tag.get("name") if name == "a" else "") or "")
        anchor: list[Inline | Display] = [Anchor(id_)] if id_ and self.anchors else []
        match name:
            case "x-math":
                latex = str(tag["data-latex"])
                return self.reading.display(latex) if tag.get("data-display") else self.reading.math(latex)
            case "x-text":
                return [Text(re.sub(r"[ \t\r\n\f]+", " ", tag.get_text()))]
            case "x-svg":
                return self.drawing(tag, look)
            case "math":
                return self.formula(tag)
            case "br":
                return [*anchor, Break()]
            case "img" | "image":
                alt = self.reading.alt(str(tag.get("alt") or tag.get("title") or ""), "an image in HTML")
                return [*anchor, self.picture_from(str(tag.get("src") or tag.get("data-src") or ""), alt, tag)]
        if name in CODE:
            return [*anchor, Code(visible(tag.get_text()))]
        if name in CONTROLS:
            return [*anchor, *self.control(tag, math)]
        inside: list[Inline | Display] = [part for child in tag.children for part in self.inline(child, math)]
        if name == "q":
            inside = [Text("“"), *inside, Text("”")]
        if name == "rt":
            inside = [Text(" ("), *inside, Text(")")]
        if name == "a" and tag.get("href"):
            if "anchor-link" in _classes(tag):
                return anchor
            return [*anchor, Link(str(tag["href"]), _no_display(inside))]
        return [*anchor, *self.dressed(tag, look, inside)]

    def dressed(self, tag: Tag, look: Appearance, inside: list[LineNode]) -> list[LineNode] | list[Inline]:
        """The nodes with the emphasis and the colours of their element."""
        wraps: list[Callable[[list[Inline]], Inline]] = []
        styles = [STYLES[tag.name]] if tag.name in STYLES else []
        styles += [s for s, asked in (("strong", look.bold), ("emph", look.italic), ("strike", look.strike)) if asked]
        for style in dict.fromkeys(styles):
            wraps.append(partial(Styled, style))
        if look.ink or look.ground:
            wraps.append(lambda nodes: Coloured(nodes, look.ink, look.ground))
        if not wraps or not inside:
            return inside
        nodes = _no_display(inside)
        for wrap in wraps:
            nodes = [wrap(nodes)]
        return nodes

    def control(self, tag: Tag, math: bool) -> Sequence[Inline | Display]:
        """What a form's control says, in characters."""
        if not self.reading.mending:
            raise CannotShow(_refusal(tag.name))
        kind = str(tag.get("type", "text")).lower()
        value = str(tag.get("value", ""))
        match tag.name:
            case "input" if kind in ("checkbox", "radio"):
                return [Text("☑ " if tag.has_attr("checked") else "☐ ")]
            case "input":
                return [Text(value)] if value and kind not in ("hidden", "password") else []
            case "progress" | "meter":
                most = _number(tag, "max") or 1.0
                done = _number(tag, "value")
                return [] if done is None else [Text(f"{100 * done / most:.0f} % ")]
            case "select":
                chosen = tag.find_all("option", selected=True) or tag.find_all("option")[:1]
                return [Text(", ".join(option.get_text(" ", strip=True) for option in chosen))]
            case "datalist":
                return []
        return [part for child in tag.children for part in self.inline(child, math)]

    def picture_from(self, url: str, alt: str, tag: Tag) -> Picture:
        """The picture at an address, in the size its element asks for. Raises CannotShow."""
        picture = pictures.from_url(url, alt, self.reading.attachments, self.reading.folder, self.reading.root)
        look = self.looks.of(tag)
        picture.width, picture.height, picture.share = look.width, look.height, look.share
        return picture

    def drawing(self, tag: Tag, look: Appearance) -> list[Inline]:
        """An SVG that stands in the HTML; one of no size, or without anything to see, is nothing."""
        svg = self.drawings[int(str(tag["data-index"]))]
        body = re.sub(
            r"<(defs|style|symbol|metadata)\b.*?</\1>|<[^>]*>", lambda m: m[0][:5] if m[1] is None else "", svg
        )
        nothing = re.search(r"(width|height)[:=]\s*[\"']?0(px)?\b(?![.\d])", svg.partition(">")[0])
        if nothing or not re.search(r"<(path|rect|circ|line|poly|elli|text|imag|use)|\S", body):
            return []
        return [pictures.from_bundle("image/svg+xml", svg, str(tag.get("alt") or "Drawing"), look.width)]

    def formula(self, tag: Tag) -> Sequence[Inline | Display]:
        """MathML: its TeX where it says so, else its characters."""
        source = tag.find("annotation", encoding=re.compile("tex", re.IGNORECASE))
        if source:
            latex = source.get_text()
            return self.reading.display(latex) if tag.get("display") == "block" else self.reading.math(latex)
        for annotation in tag.find_all(["annotation", "annotation-xml"]):
            annotation.extract()
        return [Text(tag.get_text(" ", strip=True))]

    def line(self, tag: Tag, math: bool) -> list[Inline]:
        """The content of an element as one line."""
        nodes: list[Inline] = []
        for child in tag.children:
            if isinstance(child, Tag) and not self.is_inline(child):
                part = flat(self.reading.attempt(partial(self.block, child, math)))
                nodes += [*([Break()] if nodes and part else []), *part]
            else:
                nodes += _no_display(self.inline(child, math))
        trim(nodes)
        return nodes


def _refusal(name: str) -> str:
    return f"HTML with <{name}>, which a page cannot show; give the result another form (table, figure, text)"


def _no_display(nodes: Sequence[Inline | Display]) -> list[Inline]:
    return [Math(node.latex) if isinstance(node, Display) else node for node in nodes]


def _classes(tag: Tag) -> str:
    found = tag.get("class") or ()
    return found if isinstance(found, str) else " ".join(found)


def _alert_kind(classes: str) -> str:
    found = re.search(r"\b(success|warning|danger|error|caution|important|tip)\b", classes.replace("-", " "))
    kinds = {"error": "danger", "caution": "warning", "important": "warning", "tip": "success"}
    return kinds.get(found[1], found[1]) if found else "info"


def _number(tag: Tag, key: str) -> float | None:
    found = re.match(r"\s*-?\d+(\.\d+)?", str(tag.get(key, "")))
    return float(found[0]) if found else None


def says_no_math(tag: Tag) -> bool:
    """Does MathJax leave the element alone?"""
    return bool({"tex2jax_ignore", "mathjax_ignore"} & set(tag.get("class") or ()))
