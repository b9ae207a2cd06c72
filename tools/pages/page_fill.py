"""How full the pages of a PDF are: the share of each page's text block on which nothing stands."""

from collections.abc import Iterable
from dataclasses import dataclass

from tools.pages.page_words import MARGIN_BOTTOM

from notebook_reports.export.read.pdf_text import PdfText
from notebook_reports.export.write.arrangement import MARGIN_TOP

BETWEEN = 30.0
"""Points without anything that are no gap: the space between blocks, above a heading, around a formula."""


@dataclass(frozen=True)
class PageFill:
    """One page. empty: the share of the height of its text block that lies in gaps; inside: a page that is neither the
    first nor the last."""

    page: int
    empty: float
    inside: bool


def fills(pdf: bytes) -> list[PageFill]:
    """The pages of a PDF that Typst made."""
    pages = PdfText(pdf)
    marks: dict[int, list[tuple[float, float]]] = {}
    for mark in pages.marks():
        marks.setdefault(mark.page, []).append((mark.low, mark.high))
    found = []
    for place, (_, height) in enumerate(pages.sizes, start=1):
        low, high = MARGIN_BOTTOM, height - MARGIN_TOP
        gap = sum(size for size in _gaps(marks.get(place, ()), low, high) if size > BETWEEN)
        found.append(PageFill(place, gap / (high - low), 1 < place < len(pages.sizes)))
    return found


def _gaps(marks: Iterable[tuple[float, float]], low: float, high: float) -> list[float]:
    """The heights between the marks, from the top of the text block down to its end."""
    found, reached = [], high
    for bottom, top in sorted(marks, key=lambda mark: -mark[1]):
        if top > high + 1 or top < low - 1:  # a running head, a page number
            continue
        found.append(max(0.0, reached - top))
        reached = min(reached, bottom)
    return [*found, max(0.0, reached - low)]
