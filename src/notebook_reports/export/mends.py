"""What a report of somebody else's notebook shows instead of what no page can show.

A notebook is read in one of two modes. ``strict``: what cannot be shown is an error, all of them at once; a project's
own reports are built so. ``mend``: in its place stands a numbered box that says what is missing and why, with the
alternative text or the address, and all of them are listed at the end. Nothing is left out without a word.
"""

from notebook_reports.export.model import Mend, Report, walk

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


def number(report: Report) -> list[tuple[int, Mend]]:
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


def lines(report: Report) -> list[str]:
    """The list of mends as the command prints it, one a line."""
    return [f"{report.name}, cell {cell}, mend {mend.number}: {sentence(mend)}" for cell, mend in report.mends]


def boxed_cells(report: Report) -> set[int]:
    """The cells in which something is missing; remarks do not count."""
    return {cell for cell, mend in report.mends if not mend.remark}
