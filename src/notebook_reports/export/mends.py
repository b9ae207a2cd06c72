"""What a report of somebody else's notebook shows instead of what no page can show.

A notebook is read in one of two modes. ``strict``: what cannot be shown is an error, all of them at once; a project's
own reports are built so. ``mend``: in its place stands a numbered box that says what is missing and why, with the
alternative text or the address, and all of them are listed at the end. Nothing is left out without a word.
"""

import re

from notebook_reports.export.model import (
    Block,
    Code,
    Link,
    Math,
    Mend,
    Paragraph,
    Picture,
    Report,
    ReportCell,
    Text,
    Verbatim,
    walk,
)

MODES = ("strict", "mend")

KINDS = {
    "image": "Image",
    "script": "Script",
    "widget": "Interactive widget",
    "frame": "Embedded page",
    "video": "Video",
    "audio": "Audio",
    "link": "Link",
    "formula": "Formula",
    "table": "Table",
    "text": "Text",
    "character": "Character",
    "output": "Output",
    "cell": "Cell",
}
"""By kind, what the box calls it."""


def number_mends(report: Report) -> list[tuple[int, Mend]]:
    """Number the mends of a report in reading order; they, each with its cell (0: the title)."""
    found = [(0, node) for node in walk(report.title) if isinstance(node, Mend)]
    found += [(cell.number, node) for cell in report.cells for node in walk(cell) if isinstance(node, Mend)]
    for count, (_, mend) in enumerate(found, start=1):
        mend.number = count
    report.mends = found
    return found


def sentence(mend: Mend) -> str:
    """What is missing and why, in one line of plain characters.

    >>> sentence(Mend("image", "it is on the web", "a loop", "https://example.org/loop.png"))
    'Image "a loop" not shown: it is on the web (https://example.org/loop.png)'
    """
    what = KINDS[mend.kind]
    words = " ".join(mend.text.split())
    if words and mend.kind in ("image", "video", "audio", "frame", "link"):
        what += f' "{words if len(words) <= 80 else words[:77] + "…"}"'
    told = mend.reason if mend.remark else f"not shown: {mend.reason}"
    where = f" ({mend.address})" if mend.address else ""
    return f"{what}{':' if mend.remark else ''} {told}{where}"


def mend_lines(report: Report) -> list[str]:
    """The list of mends as the command prints it, one a line."""
    return [f"{report.name}, cell {cell}, mend {mend.number}: {sentence(mend)}" for cell, mend in report.mends]


def boxed_cells(report: Report) -> set[int]:
    """The cells that are boxes: something in them is missing, and nothing else of them is shown, their code apart.

    Text that stands in for an output, such as ``<Figure size 640x480>``, is not what was to be shown.
    """
    return {cell.number for cell in report.cells if _is_box(cell)}


def _is_box(cell: ReportCell) -> bool:
    missing = any(isinstance(node, Mend) and not node.remark for node in walk(cell))
    blocks = [b for b in cell.blocks if not isinstance(b, Verbatim) or b.role not in ("input", "code")]
    shown = [b for b in blocks if not isinstance(b, Mend) and not (isinstance(b, Verbatim) and _stand_in(b.text))]
    return missing and not any(_says_something(block) for block in shown)


def _stand_in(text: str) -> bool:
    return bool(re.fullmatch(r"\s*<[\w.]+( object)?( [^<>]*)?>\s*|\s*\w+\([^\n]*\)\s*", text)) or not text.strip()


def _worded(link: Link) -> bool:
    """Does a link that leads somewhere say where, if only by the words of a picture that is not there?"""
    return any(isinstance(node, Mend) and node.text.strip() for node in walk(link))


def _says_something(block: Block) -> bool:
    """Is there a word, a formula or a picture in the block besides its mends?"""
    inside = [node for node in walk(block) if not isinstance(node, Mend)]
    if any(isinstance(node, Link) and node.kind != "nowhere" and _worded(node) for node in inside):
        return True
    return not isinstance(block, Paragraph) or any(
        (isinstance(node, Text | Code) and re.search(r"\w", node.text)) or isinstance(node, Math | Picture)
        for node in inside
    )
