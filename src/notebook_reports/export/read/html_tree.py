"""HTML text as a tree: the one place where HTML of others is parsed.

Drawings are taken out before, as they stand: a parser of HTML would lose the letter case of their attributes.
"""

import re
import warnings

from bs4 import BeautifulSoup, MarkupResemblesLocatorWarning, PageElement, Tag

from notebook_reports.export.read.html_names import with_text_for_no_tags

_SVG = re.compile(r"<svg\b|</svg\s*>", re.IGNORECASE)
_CLOSES = {
    "li": {"li"},
    "p": {"p", "div", "table", "ul", "ol", "pre", "blockquote", "h1", "h2", "h3", "h4", "h5", "h6", "hr", "dl"},
    "td": {"td", "th", "tr"},
    "th": {"td", "th", "tr"},
    "tr": {"tr"},
    "dt": {"dt", "dd"},
    "dd": {"dt", "dd"},
    "option": {"option"},
}
"""By element without an end tag, the elements whose beginning ends it."""


def tree_of(source: str) -> tuple[BeautifulSoup, list[str]]:
    """The tree, and the drawings that stood in it: an element ``x-svg`` stands for each, with its number."""
    source, drawings = _without_drawings(source)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MarkupResemblesLocatorWarning)
        tree = BeautifulSoup(with_text_for_no_tags(_math_safe(source)), "html.parser")
    _end_what_ends(tree)
    return tree, drawings


def _without_drawings(source: str) -> tuple[str, list[str]]:
    drawings: list[str] = []
    kept, at, depth, start = "", 0, 0, 0
    for found in _SVG.finditer(source):
        if found[0][1] != "/":
            start = found.start() if depth == 0 else start
            depth += 1
        elif depth:
            depth -= 1
            if depth == 0:
                kept += f'{source[at:start]}<x-svg data-index="{len(drawings)}"></x-svg>'
                drawings.append(source[start : found.end()])
                at = found.end()
    return kept + source[at:], drawings


_MATH = re.compile(r"(?<![\\$])(\$\$?)(?=\S)((?:\\.|[^$\\]){1,2000}?)(?<=\S)\1(?!\$)", re.DOTALL)
_LESS = re.compile(r"<(?![A-Za-z/!]|$)|<(?=[A-Za-z]\s*(?:$|[^A-Za-z\s>/=]))")


def _math_safe(source: str) -> str:
    """``<`` that begins no tag inside mathematics is a character: ``$a<b$``."""
    return _MATH.sub(lambda found: _LESS.sub("&lt;", found[0]), source)


def _end_what_ends(tree: BeautifulSoup) -> None:
    """Put beside each other what a missing end tag put inside each other: ``<li>one<li>two``."""
    for name, ending in _CLOSES.items():
        for tag in reversed(tree.find_all(name)):
            for child in list(tag.children):
                if isinstance(child, Tag) and child.name in ending:
                    following = [child, *child.next_siblings]
                    place: PageElement = tag
                    for node in following:
                        place.insert_after(node.extract())
                        place = node
                    break
