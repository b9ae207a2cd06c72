"""The same tables for paper and for the screen: paper names the page, the screen links the section."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from notebook_reports import display
from notebook_reports.display import Table, number
from notebook_reports.export.page import LinkedTable, Page
from notebook_reports.ledger.row import LedgerRow

LONG_INTEGER = 12
"""Digits in a row from which on a number is not shown whole."""

MOST_DIGITS = 10
"""More of a computed number are not shown here; the ledger's files have all."""


@dataclass(frozen=True)
class At:
    """A cell of a table that leads to where a record stands."""

    notebook: str
    cell: int
    section: str

    @property
    def url(self) -> str:
        return f"notebook:{self.notebook}#cell-{self.cell}"


@dataclass(frozen=True)
class To:
    """A cell of a table that shows its text and leads to a notebook."""

    text: str
    notebook: str

    @property
    def url(self) -> str:
        return f"notebook:{self.notebook}"


def place_of(found: LedgerRow) -> At:
    """Where a record stands; the words of its heading without their links."""
    return At(found.notebook, found.cell, re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", found.section))


@dataclass(frozen=True)
class Medium:
    """paper: a book with numbered pages; else a page for the screen. names: what the documents are called, by id."""

    paper: bool
    names: Mapping[str, str] = field(default_factory=dict)

    def name(self, document: str) -> str:
        """What a document is called; where nothing is said, its id."""
        return self.names.get(document, document)

    @property
    def where(self) -> str:
        """The head of the column that leads to the notebooks."""
        return "page" if self.paper else "shown in"

    def page(self, name: str, title: str) -> str:
        """The address of another of these pages."""
        return f"notebook:{name}" if self.paper else "#" + title.replace(" ", "-")

    def table(
        self,
        columns: Sequence[str],
        rows: Sequence[Sequence[Any]],
        caption: str,
        align: Sequence[str] = (),
        marks: Sequence[str] = (),
        once: int = 1,
    ) -> LinkedTable:
        """A table of inline text with links where a cell is an `At` or a `To`.

        once: so many of the first columns show a text only where it changes.
        """
        links, pages, texts = {}, set(), []
        for y, row in enumerate(rows):
            shown = []
            for x, cell in enumerate(row):
                if isinstance(cell, To):
                    links[y, x] = cell.url
                    shown.append(cell.text)
                elif isinstance(cell, At):
                    links[y, x] = cell.url
                    pages |= {(y, x)} if self.paper else set()
                    shown.append("" if self.paper else cell.section or cell.notebook)
                else:
                    shown.append(cell)
            texts.append(shown)
        table = Table(columns, texts, caption, align or ["left"] * len(columns), (), marks, groups=once)
        return LinkedTable(table, links, frozenset(pages))


PAPER, SCREEN = Medium(True), Medium(False)


def as_sections(pages: Sequence[Page]) -> list[Any]:
    """The content of several pages as sections of one."""
    content: list[Any] = []
    for page in pages:
        inner = [re.sub(r"^## ", "### ", c, flags=re.MULTILINE) if isinstance(c, str) else c for c in page.content]
        content += [f"## {page.title}", *inner]
    return content


def plain_words(text: str) -> str:
    r"""Plain words as inline text.

    >>> plain_words("costs 5 $")
    'costs 5 \\$'
    """
    return display.literal(" ".join(text.split()))


def as_code(text: str) -> str:
    """A formula or a line of a program as it is printed, as inline text."""
    return "`" + " ".join(text.split()).replace("`", "'") + "`" if text.strip() else ""


def short(digits: str) -> str:
    """A long row of digits by its ends and its length; its notebook shows all of them.

    >>> short("-2361183241434822606848"), short("8360")
    ('-236118…6848 (22 digits)', '8360')
    """
    row = digits.lstrip("-")
    if len(row) <= LONG_INTEGER or not row.isdigit():
        return digits
    return f"{digits[: len(digits) - len(row) + 6]}…{row[-4:]} ({len(row)} digits)"


def beside(computed: str, printed: str) -> str:
    """A computed number as it stands beside a print: with two digits more, at least four.

    >>> beside("39.52067436560929", "39.6"), beside("", "1")
    ('39.521', '')
    """
    if not computed:
        return ""
    if computed.lstrip("-").isdigit() and len(computed) > LONG_INTEGER:
        return short(computed)
    digits = sum(c.isdigit() for c in re.sub(r"[eE].*", "", printed).lstrip("-0."))
    return number(float(computed), min(max(4, digits + 2), MOST_DIGITS))
