"""The elements of HTML by what becomes of them on a page; a name that is none of them is text in angle brackets."""

import re

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
THROUGH = {"span", "font", "small", "big", "abbr", "acronym", "label", "time", "q", "bdi", "bdo", "nobr", "data"}
THROUGH |= {"ruby", "rt", "rp", "rb", "output", "blink", "slot", "picture", "noscript", "map", "legend", "option"}
"""Inside a line, shown as what is in them."""
BOXES = {"div", "section", "article", "main", "header", "footer", "center", "address", "p", "html", "body", "details"}
BOXES |= {"form", "fieldset", "nav", "aside", "hgroup", "search", "dialog", "figcaption", "marquee", "listing"}
"""On lines of their own, shown as what is in them."""
CONTROLS = {"button", "input", "select", "textarea", "progress", "meter", "datalist"}
DROPPED = {"style", "colgroup", "col", "head", "title", "meta", "wbr", "link", "template", "source", "track", "param"}
DROPPED |= {"base", "area", "basefont"}
EMBEDDED = {"iframe": "frame", "frame": "frame", "frameset": "frame", "embed": "frame", "object": "frame"}
EMBEDDED |= {"applet": "frame", "video": "video", "audio": "audio", "canvas": "script", "script": "script"}
"""What a page cannot hold, and the kind of its mend."""
BLOCKS = {"table", "pre", "ul", "ol", "menu", "dir", "dl", "blockquote", "hr", "summary", "figure", "xmp", "plaintext"}
_PARTS = {
    "a",
    "br",
    "img",
    "image",
    "svg",
    "math",
    "li",
    "dt",
    "dd",
    "thead",
    "tbody",
    "tfoot",
    "tr",
    "td",
    "th",
    "caption",
}
_HEADINGS = {f"h{level}" for level in range(1, 7)}
NAMES = {*STYLES, *CODE, *THROUGH, *BOXES, *CONTROLS, *DROPPED, *EMBEDDED, *BLOCKS, *_PARTS, *_HEADINGS, "optgroup"}
_INSIDE_PICTURES = {"path", "g", "rect", "circle", "line", "text", "defs", "use", "mi", "mo", "mn", "mrow"}

_TAG = re.compile(r"<(?=(/?)([A-Za-z][A-Za-z0-9]*)(?![\w:.-]*[:-]))")


def is_no_tag(raw: str) -> bool:
    """Is this text in angle brackets, as in ``vector<int>``, and no element of HTML? Names with - or : are elements.

    >>> is_no_tag("<int>"), is_no_tag("<b>"), is_no_tag("<my-widget>")
    (True, False, False)
    """
    found = _TAG.match(raw)
    return found is not None and found[2].lower() not in NAMES | _INSIDE_PICTURES


def with_text_for_no_tags(source: str) -> str:
    """The HTML with ``<`` written out before every name that is no element.

    >>> with_text_for_no_tags("a vector<int> of <b>x</b>")
    'a vector&lt;int> of <b>x</b>'
    """
    return _TAG.sub(lambda found: "&lt;" if is_no_tag(found[0] + found[1] + found[2]) else "<", source)
