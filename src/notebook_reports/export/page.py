"""Pages that come from no notebook: Markdown text and tables whose cells lead somewhere, for the book and the screen.

page = Page("Ledger", [LinkedTable(table, {(0, 0): "notebook:double_tank/03_pole_placement#cell-7"})], "ledger")
html = export_page(page)
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from notebook_reports.export.around import Around, Tools
from notebook_reports.export.errors import ExportError
from notebook_reports.export.model import Block, Grid, Link, PageNumber, Report, ReportCell, Text
from notebook_reports.export.read.markdown import read_markdown
from notebook_reports.export.read.notebook import collect_anchors, level_headings, number_blocks, settle_links
from notebook_reports.export.read.reading import Reading
from notebook_reports.export.read.tables import from_data


@dataclass(frozen=True)
class LinkedTable:
    """A table whose cells lead somewhere.

    table: a `notebook_reports.display.Table` or its data. links: by (row, column), 0-based without the head, where the
    cell leads: "notebook:double_tank/03_pole_placement#cell-7", or a URL. pages: cells shown as the number of the page
    their link leads to; in a book only.
    """

    table: Any
    links: Mapping[tuple[int, int], str] = field(default_factory=dict)
    pages: frozenset[tuple[int, int]] = frozenset()


@dataclass(frozen=True)
class Page:
    """A page. content: Markdown text, tables, or linked tables. name: as links call it."""

    title: str
    content: Sequence[Any]
    name: str = ""


def page_name(page: Page) -> str:
    """How links call a page."""
    return page.name or "appendix/" + page.title.lower().replace(" ", "_")


def read_page(page: Page, strict_alt: bool = True) -> Report:
    """The page as a report of one cell per piece of content. Raises ExportError."""
    reading = Reading(strict_alt=strict_alt)
    cells = []
    for number, content in enumerate(page.content, start=1):
        reading.cell = number
        blocks = reading.attempt(partial(_content, content, reading))
        cells.append(ReportCell(number, blocks, f"cell-{number}"))
    report = Report(page_name(page), [Text(page.title)], "", cells)
    collect_anchors(report, reading)
    settle_links(report, reading)
    if reading.problems:
        raise ExportError(report.name, reading.problems)
    return report


def export_page(page: Page, place: str = "", around: Around | None = None, tools: Tools | None = None) -> str:
    """The page as HTML; a link to a notebook leads to its HTML report. place: what stands above the title.

    around: the ways to other pages. tools: of this page alone. Raises ExportError.
    """
    from notebook_reports.export.exporters.html import HtmlExporter

    report = read_page(page)
    report.chapter = place
    level_headings(report.cells)
    number_blocks(report.cells)
    return HtmlExporter().render(report, around, tools=tools)


def _content(content: Any, reading: Reading) -> list[Block]:
    if isinstance(content, str):
        return read_markdown(content, reading)
    linked = content if isinstance(content, LinkedTable) else LinkedTable(content)
    grid = from_data(linked.table if isinstance(linked.table, dict) else linked.table.data())
    _link_cells(grid, linked)
    return [grid]


def _link_cells(grid: Grid, linked: LinkedTable) -> None:
    cells = {(cell.y - 1, cell.x): cell for cell in grid.cells}
    for place, url in linked.links.items():
        cell = cells[place]
        if place in linked.pages:
            cell.children = [PageNumber(url.removeprefix("notebook:"))]
        else:
            cell.children = [Link(url, cell.children)]
