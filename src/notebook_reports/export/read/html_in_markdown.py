"""Markdown whose HTML elements open in one piece and close in another, read as a browser reads it: as HTML.

``<div class="alert">``, an empty line, Markdown, ``</div>``: the Markdown inside is set by mistune, formulas and code
stay what they are, and the whole is one HTML text. Tags that are never closed, or close nothing, are mended there.
"""

import functools
import re
from html import escape
from html.parser import HTMLParser
from typing import Any

from notebook_reports.export.read.html_names import CODE, STYLES, THROUGH, is_no_tag

VOID = {"br", "img", "hr", "wbr", "input", "link", "meta", "source", "track", "col", "area", "base", "embed", "param"}
_IMPLIED_END = {"p", "li", "td", "th", "tr", "dt", "dd", "tbody", "thead", "option"}
_SIMPLE = {*STYLES, *CODE, *(THROUGH - {"picture", "ruby", "rt", "noscript"}), "a", "br", "img", "wbr"}
PLUGINS = ("strikethrough", "table", "url", "task_lists", "def_list", "footnotes")


class _Balance(HTMLParser):
    """The tags of a text that stay open, and whether one closes nothing."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.stray = False

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: Any) -> None:
        pass

    def handle_endtag(self, tag: str) -> None:
        if tag in VOID:
            return
        while self.open and self.open[-1] != tag and self.open[-1] in _IMPLIED_END:
            self.open.pop()
        if self.open and self.open[-1] == tag:
            self.open.pop()
        else:
            self.stray = True


def balanced(sources: list[str]) -> bool:
    """Does each tag of the pieces, read one after the other, close within them?"""
    balance = _Balance()
    for source in sources:
        if not is_no_tag(source):
            balance.feed(source)
    balance.close()
    return not balance.stray and not [tag for tag in balance.open if tag not in _IMPLIED_END]


def interleaved(tokens: list[dict[str, Any]]) -> bool:
    """Is there a piece of HTML among the tokens whose tags do not pair up within it?"""
    for token in tokens:
        if token["type"] == "block_html" and not balanced([token["raw"]]):
            return True
        children = token.get("children") or []
        pieces = [child["raw"] for child in children if child["type"] == "inline_html"]
        if pieces and (not balanced(pieces) or not all(map(_in_a_line, pieces))):
            return True
        if interleaved(children):
            return True
    return False


def _in_a_line(raw: str) -> bool:
    """Is the tag one that Markdown's own reader pairs in a line?"""
    found = re.match(r"</?\s*([A-Za-z][\w:-]*)", raw)
    return not found or found[1].lower() in _SIMPLE or is_no_tag(raw)


def as_html(source: str) -> str:
    """The Markdown as HTML; formulas and code become elements that `foreign_html` knows."""
    return _renderer()(source)


@functools.cache
def _renderer() -> Any:
    from mistune import HTMLRenderer, Markdown, import_plugin
    from nbconvert.filters.markdown_mistune import MathBlockParser, MathInlineParser

    class Renderer(HTMLRenderer):
        def inline_math(self, text: str) -> str:
            return f'<x-math data-latex="{escape(text)}"></x-math>'

        def block_math(self, text: str) -> str:
            return f'<x-math data-display="1" data-latex="{escape(text)}"></x-math>'

        def latex_environment(self, name: str, body: str) -> str:
            return self.block_math(rf"\begin{{{name}}}{body}\end{{{name}}}")

        def inline_html(self, html: str) -> str:
            return escape(html) if is_no_tag(html) else html

        def text(self, text: str) -> str:
            return f"<x-text>{escape(text)}</x-text>" if "$" in text or "\\" in text else escape(text, quote=False)

        def heading(self, text: str, level: int, **attrs: Any) -> str:
            return f"<h{level}>{text}</h{level}>\n"

        def block_code(self, code: str, info: str | None = None) -> str:
            language = (info or "").split(" ")[0]
            return f'<pre data-language="{escape(language)}">{escape(code)}</pre>\n'

    renderer = Renderer(escape=False, allow_harmful_protocols=True)
    plugins = [import_plugin(name) for name in PLUGINS]
    markdown = Markdown(renderer, MathBlockParser(), MathInlineParser(hard_wrap=False), plugins)
    renderer.register("table", lambda _, text: f"<table>{text}</table>\n")
    return lambda text: re.sub(r"(?<=<pre)\s", " ", str(markdown(text)))
