"""How to read the book: what a chapter is, and what each verdict says, before the first one is given."""

from collections.abc import Sequence
from typing import Any

from notebook_reports.display import Table
from notebook_reports.export.page import Page
from notebook_reports.ledger.coverage import VERDICTS, Count, total
from notebook_reports.ledger.verdicts import MARKS, MEANINGS
from notebook_reports.pages.ledger_page import ERRATA
from notebook_reports.pages.medium import Medium

TITLE = "How to read this book"
NAME = "preface"
KINDS = {"value": "A printed number", "claim": "A statement", "misprint": "A misprint"}
DIGITS = """\
A number is compared as it is printed: computed to full precision and rounded to as many digits as the document shows.
A statement is tested by what was computed, and the numbers that decided it stand beside it. What the document has wrong
is listed with its correction and, where something can be computed, with the proof."""


def preface(medium: Medium, counts: Sequence[Count]) -> Page:
    """One page; of the verdicts, those that were given."""
    ledger = f"[the errata]({medium.page('errata', ERRATA)})"
    content: list[Any] = [
        "Each chapter is a notebook that ran. Its code, shown where it stands or kept for who asks for it, derived the "
        "equations, computed the numbers, drew the figures and set them beside what the document prints. No number "
        "beside a verdict was typed in.",
        DIGITS,
    ]
    whole = total(counts)
    rows, marks = [], []
    for table, verdicts in VERDICTS.items():
        given = dict(whole.of(table))
        for verdict in verdicts:
            if given.get(verdict):
                rows.append([KINDS[table], MEANINGS[verdict], str(given[verdict]), verdict])
                marks.append(MARKS[verdict])
    if rows:
        align = ["left", "left", "right", "left"]
        told = Table(["what", "its verdict says", "here", "verdict"], rows, "The verdicts", align, (), marks, groups=1)
        where = f"Who wants only what is wrong reads {ledger}; who doubts a number finds its place in the index."
        content += [told, where]
    return Page(TITLE, content, NAME)
