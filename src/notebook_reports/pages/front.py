"""What makes one want to read: the picture of the front page, what was found, how each chapter begins."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from notebook_reports.display import FIGURE_MIME
from notebook_reports.export.model import Paragraph, plain, words_only
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.export.read.markdown import read_markdown
from notebook_reports.export.read.pictures import from_bundle
from notebook_reports.export.read.reading import Reading
from notebook_reports.export.write.html import HtmlWriter
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import MARKS
from notebook_reports.project.outline import Outline, Part
from notebook_reports.project.project import UsageError

LONGEST_OPENING = 330
"""Characters of the first sentences of a chapter."""


@dataclass(frozen=True)
class ShownFind:
    """A find as the page shows it, as HTML. mark: of its verdict. url: of the cell that shows it."""

    says: str
    mark: str
    verdict: str
    url: str


def finds(part: Part, found: Iterable[LedgerRow]) -> list[ShownFind]:
    """What a part found. Raises UsageError for an entry that the ledger does not have, or with another verdict."""
    document = part.folder.replace("_", "-")
    rows = {(row.table, row.id): row for row in found if row.document == document}
    shown = []
    for find in part.finds:
        row = rows.get((find.table, find.id))
        if row is None:
            raise UsageError(f"notebooks/book.toml: {document} has no {find.table} {find.id!r} in the ledger")
        if row.verdict != find.verdict:
            told = f"{find.table} {find.id!r} of {document} is {row.verdict!r} in the ledger and {find.verdict!r} here"
            raise UsageError(f"notebooks/book.toml: {told}; does the sentence still hold?")
        words = HtmlWriter().inline(read_inline(find.says))
        shown.append(ShownFind(words, MARKS[row.verdict], row.verdict, f"{row.notebook}.html#cell-{row.cell}"))
    return shown


def opening(content: Mapping[str, Any]) -> str:
    """The first sentences of an executed notebook, as HTML; "" where it does not begin with prose."""
    text = next(("".join(c["source"]) for c in content["cells"] if c["cell_type"] == "markdown"), "")
    blocks = read_markdown(re.sub(r"^#[^\n]*\n", "", text.lstrip()), Reading(mending=True))
    first = blocks[0] if blocks else None
    if not isinstance(first, Paragraph):
        return ""
    nodes = words_only(first.children)
    words = plain(nodes)
    if len(words) <= LONGEST_OPENING:
        return HtmlWriter().inline(nodes)
    ends = [m.end() for m in re.finditer(r"[.?!](?=\s+[A-Z])", words) if m.end() <= LONGEST_OPENING]
    return HtmlWriter().inline(read_inline(words[: ends[-1]])) if ends else ""


def front_picture(outline: Outline, content: Mapping[str, Any]) -> str:
    """The figure of the front page from the executed notebook that the outline names, as HTML.

    Raises UsageError where that has no such figure.
    """
    assert outline.picture is not None
    name, number = outline.picture
    outputs = [o for cell in content["cells"] for o in cell.get("outputs", ()) if FIGURE_MIME in o.get("data", {})]
    if number > len(outputs):
        raise UsageError(f"notebooks/book.toml: the picture is figure {number} of {name}, which has {len(outputs)}")
    data = outputs[number - 1]["data"]
    told = data[FIGURE_MIME]
    drawing = from_bundle("image/svg+xml", data["image/svg+xml"], told["alt"])
    writer = HtmlWriter("front")
    caption = writer.inline(read_inline(told["caption"]))
    link = f'<a href="{name}.html">{caption}</a>'
    return f'<figure><div class="sheet">{writer.picture(drawing)}</div><figcaption>{link}</figcaption></figure>'
