"""The words of a report's pages: those of its text, one after the other, and those that leave the text block."""

import re

from notebook_reports.export.read.pdf_text import PdfText, TextRun
from notebook_reports.export.write.arrangement import MARGIN_TOP


def in_the_text(pages: PdfText) -> list[TextRun]:
    """The runs without heads and page numbers, and without words in pictures."""
    return [
        run
        for run in pages.runs()
        if not run.drawn and run.y < pages.sizes[run.page - 1][1] - MARGIN_TOP and run.y > MARGIN_BOTTOM - _SLACK
    ]


def text_of(runs: list[TextRun]) -> str:
    """The runs as text: on one line without a gap they are one word, and a word divided at a line's end is whole."""
    text, last = "", None
    for run in runs:
        near = last and last.page == run.page and abs(last.y - run.y) < 0.5 * run.size
        if text.endswith("\u00ad") and not near:
            text = text[:-1]
        elif last and not (near and abs(run.x0 - last.end) < 0.12 * run.size):
            text += "\n" if not near else " "
        text += run.text
        last = run
    return text


MARGIN_X = MARGIN_BOTTOM = 2.5 * 72 / 2.54
"""Points between the edge of a page and its text: the margins of ``report.typ``."""
_SLACK = 5.0
"""Points that a letter may stand out: punctuation and slanted letters do."""
_HANGING = frozenset("、。，．：；！？）］｝」』】")
"""Marks of which half is empty."""


def outside(pages: PdfText) -> list[TextRun]:
    """The runs that leave the text block of their page; heads and page numbers, and words in pictures, do not count."""
    found = []
    for run in pages.runs():
        width, height = pages.sizes[run.page - 1]
        if run.drawn or not run.text.strip():
            continue
        head = run.y > height - MARGIN_TOP or (run.y < MARGIN_BOTTOM - _SLACK and re.fullmatch(r"[\d /]+", run.text))
        slack = 0.7 * run.size if run.text.rstrip()[-1:] in _HANGING else _SLACK
        beside = run.x0 < MARGIN_X - _SLACK or run.x1 > width - MARGIN_X + slack
        below = run.y < MARGIN_BOTTOM - _SLACK
        if beside or (below and not head):
            found.append(run)
    return found
