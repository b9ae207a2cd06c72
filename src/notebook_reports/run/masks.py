"""What a machine writes into outputs and another would write otherwise: where folders lie, where objects lie.

Only whole absolute paths are masked, with a boundary before and after, and of each folder it is known who writes it:
the project (tracebacks, warnings, the working folder), the installed packages and the standard library (the same), the
folder for temporary files, the user's home. A home of one part, ``/`` or ``/root``, is too short to be told from other
text: it stays as it is, and the stamp of a run holds it. Of addresses only those in the representation of an object
are masked; a number in hexadecimal is a result.
"""

import html
import re
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from notebook_reports.project.home import home

CELL = "<cell>"
TEMPORARY = "/tmp"
_CELL_FILE = re.compile(r"ipykernel_\d+[/\\]\d+\.py")
_AT = re.compile(r"( at )0x[0-9a-f]{6,16}(?![0-9a-z_])", re.IGNORECASE)
_OPENED = re.compile(r"<|&lt;")
_NEAR = 300
"""How far before its address the representation of an object begins, at most."""


def home_shown() -> str:
    """The home as outputs show it: "~", or its path where that is too short to be masked, "" where there is none."""
    folder = home()
    if folder is None:
        return ""
    return "~" if len(folder.parts) > 2 else str(folder)


class Masks:
    """The masks of one run. root: the project's folder. folder: the notebook's, where it lies elsewhere."""

    def __init__(self, root: Path, folder: Path | None = None):
        places = {str(p): "" for p in (folder, root) if p is not None and len(p.parts) > 1}
        if sys.prefix != sys.base_prefix:
            places.setdefault(sys.prefix, "")
        places |= {sysconfig.get_path(name): "site-packages" for name in ("purelib", "platlib")}
        places |= {sysconfig.get_path(name): "lib/python" for name in ("stdlib", "platstdlib")}
        for temporary in dict.fromkeys((tempfile.gettempdir(), str(Path(tempfile.gettempdir()).resolve()))):
            if len(Path(temporary).parts) > 1:
                places.setdefault(temporary, TEMPORARY)
        if (own := home()) and home_shown() == "~":
            places.setdefault(str(own), "~")
        self._places = places
        longest_first = "|".join(re.escape(p) for p in sorted(places, key=len, reverse=True))
        before, after = r"(?:(?<=file://)|(?<![\w.~/\\+@%-]))", r"(?![\w+@~%-]|\.\w)"
        self._pattern = re.compile(rf"{before}(?P<place>{longest_first}){after}(?P<more>[/\\](?=[^\s/\\]))?")

    def paths(self, text: str) -> str:
        """The text without the places of folders.

        >>> Masks(Path("/x/project")).paths("/x/project/a.csv, /x/project-2/a.csv, 1/2")
        'a.csv, /x/project-2/a.csv, 1/2'
        """
        return self._pattern.sub(self._instead, text)

    def _instead(self, found: re.Match[str]) -> str:
        instead, more = self._places[found["place"]], found["more"] or ""
        return instead + more if instead else "" if more else "."

    def text(self, text: str, markup: bool = False) -> str:
        """Printed text without places of folders, of cells' files and of objects. markup: it is HTML or Markdown."""
        return _addresses(self.paths(_name_cells(text, html.escape(CELL) if markup else CELL)))

    def data(self, value: Any) -> Any:
        """Plain data, with the places of folders masked in every string of it."""
        if isinstance(value, str):
            return self.paths(value)
        if isinstance(value, list):
            return [self.data(v) for v in value]
        if isinstance(value, dict):
            return {k: self.data(v) for k, v in value.items()}
        return value


def _addresses(text: str) -> str:
    """``<x at 0x7f…>`` for every address that stands in the representation of an object, begun on the same line."""

    def mask(found: re.Match[str]) -> str:
        line = text[max(0, found.start() - _NEAR) : found.start()].rpartition("\n")[2]
        return f"{found[1]}0x…" if _OPENED.search(line) else found[0]

    return _AT.sub(mask, text)


def _name_cells(text: str, name: str) -> str:
    """The temporary file of a cell, with the folders before it, becomes `name`; one pass, however long a line."""
    pieces, end = [], 0
    for found in _CELL_FILE.finditer(text):
        start = found.start()
        while start > end and text[start - 1] not in " \t\n\"'<>;":
            start -= 1
        pieces += [text[end:start], name]
        end = found.end()
    return "".join([*pieces, text[end:]])
