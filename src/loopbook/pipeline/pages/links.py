"""Do the links of a page lead somewhere? Looked up among the files beside it, with the anchors of those."""

from collections.abc import Mapping
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

OUTSIDE = ("http:", "https:", "mailto:", "data:")


class _Page(HTMLParser):
    """The addresses a page links to and the anchors it has."""

    def __init__(self):
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        if given.get("id"):
            self.anchors.add(given["id"])
        if tag in ("a", "img", "link") and (given.get("href") or given.get("src")):
            self.links.append(given.get("href") or given["src"])


def read_links(text: str) -> tuple[list[str], set[str]]:
    """(the addresses linked to, in order; the anchors)."""
    page = _Page()
    page.feed(text)
    return page.links, page.anchors


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
