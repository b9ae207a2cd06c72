"""Do the links of a page lead somewhere? Looked up among the files beside it, with the anchors of those."""

import re
from collections.abc import Mapping
from html import unescape
from pathlib import Path
from urllib.parse import unquote

OUTSIDE = ("http:", "https:", "mailto:", "data:")


_ANCHOR = re.compile(r"""\bid=(["'])(.+?)\1""")
_LINK = re.compile(r"""<(?:a|img|link)\b[^>]*?\s(?:href|src)=(["'])(.+?)\1""")


def read_links(text: str) -> tuple[list[str], set[str]]:
    """(the addresses linked to, in order; the anchors). For our own pages: attributes are quoted, text is escaped.

    >>> read_links('<h2 id="a&amp;b"><a class="x" href="#c">')
    (['#c'], {'a&b'})
    """
    return [unescape(m[2]) for m in _LINK.finditer(text)], {unescape(m[2]) for m in _ANCHOR.finditer(text)}


def dead_links(name: str, folder: Path, made: Mapping[str, bytes]) -> list[str]:
    """What the page cannot lead to, one line each.

    name: of the page. folder: where it will stand. made: pages not written yet, itself among them, by name.
    """
    known: dict[str, set[str] | None] = {}

    def anchors(path: str) -> set[str] | None:
        """Of a page; None where there is no such file."""
        if path not in known:
            file = folder / path
            content = made[path] if path in made else file.read_bytes() if file.is_file() else None
            if content is None:
                known[path] = None
            else:
                known[path] = read_links(content.decode())[1] if path.endswith(".html") else set()
        return known[path]

    wrong = []
    for link in dict.fromkeys(read_links(made[name].decode())[0]):
        if link.startswith(OUTSIDE):
            continue
        path, _, anchor = unquote(link).partition("#")
        found = anchors(path or name)
        if found is None:
            wrong.append(f"a link to {path}, which is not there")
        elif anchor and anchor not in found:
            wrong.append(f"a link to #{anchor}, which is nowhere in {path or name}")
    return wrong
