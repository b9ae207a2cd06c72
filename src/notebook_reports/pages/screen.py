"""reports/index.html and reports/ledger.html: the map and the ledger for the screen, complete in themselves."""

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from notebook_reports.export.around import Around, Door, Tools
from notebook_reports.export.exporters.html import style_sheet
from notebook_reports.export.page import Page, export_page
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.export.scripts import policy
from notebook_reports.export.write.html import HtmlWriter
from notebook_reports.export.write.mathematics_font import font_face
from notebook_reports.ledger.captions import verb_of
from notebook_reports.ledger.coverage import VERDICTS, Count, by_document, total
from notebook_reports.ledger.files import FILES
from notebook_reports.ledger.row import TABLES, LedgerRow
from notebook_reports.ledger.verdicts import MARKS
from notebook_reports.pages.errata import errata
from notebook_reports.pages.front import finds, front_picture, opening
from notebook_reports.pages.ledger_page import NAMES
from notebook_reports.pages.medium import as_sections
from notebook_reports.pages.offered import OfferedPage
from notebook_reports.project.outline import Outline

TEMPLATES = Path(__file__).parent / "templates"
ONE = {"values": "value", "statements": "statement", "misprints": "misprint"}


def ledger_page(pages: Sequence[Page], title: str) -> bytes:
    """The pages of the ledger as one, with a box that filters its rows. Raises ExportError."""
    around = Around(Door("index.html", title), files=(Door("loopbook.pdf", "PDF"),))
    tools = Tools((TEMPLATES / "filter.html").read_text("utf-8"), (TEMPLATES / "filter.js").read_text("utf-8"))
    return export_page(Page("The ledger", as_sections(pages), "ledger"), title, around, tools).encode()


def index_page(
    outline: Outline,
    counts: Sequence[Count],
    found: Sequence[LedgerRow],
    executed: Mapping[str, Mapping[str, Any]],
    sections: Sequence[str],
    versions: Mapping[str, str],
    sizes: Mapping[str, int],
    pages: Sequence[OfferedPage] = (),
) -> bytes:
    """The front page: a picture, what was found in words, the book, the ledger, each notebook with its reports.

    executed: the notebooks by id. sections: titles of the ledger's sections. sizes: of the files below ``reports/``, in
    bytes, by name; the ledger's tables are listed where they are among them. pages: of other packages. Raises
    UsageError where the outline names a figure or an entry that is not there.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    told: dict[str, Any] = {
        "outline": outline,
        "style": style_sheet(),
        "picture": front_picture(outline, executed[outline.picture[0]]) if outline.picture else "",
        "finds": {part.folder: finds(part, found) for part in outline.parts},
        "opening": lambda id: opening(executed[id]),
        "whole": headline(counts, found),
        "policy": policy(),
        "bars": {"": bars(total(counts)), **{d.document.replace("-", "_"): bars(d) for d in by_document(counts)}},
        "sections": [(title, title.replace(" ", "-")) for title in sections],
        "versions": versions,
        "size": lambda name: size(sizes[name]),
        "tables": [name for name in FILES.values() if name in sizes],
        "chips": chips,
        "pages": pages,
        "inline": lambda text: HtmlWriter().inline(read_inline(text)),
        "escape": escape,
    }
    text = environment.get_template("index.html.j2").render(**told)
    return (text.replace("<style>\n", f"<style>\n{face}\n", 1) if (face := font_face(text)) else text).encode()


def headline(counts: Sequence[Count], found: Sequence[LedgerRow]) -> list[tuple[str, str]]:
    """The largest numbers of all, each with what it counts."""
    whole = total(counts)
    counted = (
        (whole.printed["value"], "printed number", "computed again"),
        (whole.printed["claim"], "statement", "put to the test"),
        (len(errata(found)), "error", "found in the documents"),
    )
    return [(str(n), f"{what}{'s' if n > 1 else ''} {done}") for n, what, done in counted if n]


def chips(verdicts: Mapping[str, Mapping[str, int]]) -> list[tuple[str, list[tuple[str, str]]]]:
    """The verdicts of one notebook: ("54 values", [("good", "32 reproduced"), …]) for each table that it has."""
    rows = []
    for table in TABLES:
        given = verdicts.get(table, {})
        number = sum(given.values())
        if number:
            name = ONE[NAMES[table]] if number == 1 else NAMES[table]
            marks = [(MARKS[v], f"{given[v]} {verb_of(v, given[v])}") for v in VERDICTS[table] if given.get(v)]
            rows.append((f"{number} {name}", marks))
    return rows


def bars(count: Count) -> list[tuple[str, list[tuple[str, str, str]]]]:
    """For each table the verdicts as pieces of a bar: (mark, number and verdict, share in percent)."""
    rows = []
    for table in TABLES:
        given = count.of(table)
        number = sum(n for _, n in given)
        if number:
            pieces = [(MARKS[v], f"{n} {verb_of(v, n)}", f"{100 * n / number:.2f}") for v, n in given]
            rows.append((f"{number} {ONE[NAMES[table]] if number == 1 else NAMES[table]}", pieces))
    return rows


def size(number: int) -> str:
    """
    >>> size(999), size(45_600), size(1_234_567)
    ('1 kB', '46 kB', '1.2 MB')
    """
    return f"{number / 1e6:.1f} MB" if number >= 1e6 else f"{max(1, round(number / 1e3))} kB"
