"""The ledger to be read: coverage, errata, what is not reproduced and why, what is, glossary, index of places.

Every record stands in exactly one of the three reports, in a row that leads to the notebook and section that shows it.
They are made here and not in a notebook, because a notebook does not read another one.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from notebook_reports.display import Table
from notebook_reports.export.page import LinkedTable, Page
from notebook_reports.ledger.captions import verb_of
from notebook_reports.ledger.coverage import VERDICTS, Count, by_document, total
from notebook_reports.ledger.files import NUMBERS, natural
from notebook_reports.ledger.glossary import Term
from notebook_reports.ledger.row import TABLES, LedgerRow
from notebook_reports.ledger.verdicts import (
    FAILS,
    GIVEN,
    HOLDS,
    MARKS,
    MISPRINT,
    QUOTED,
    READ,
    REPEATED,
    REPRODUCED,
    ROUNDED,
)
from notebook_reports.pages.errata import FALSE, HARMLESS, MISLEADS, Erratum, errata
from notebook_reports.pages.medium import Medium, To, as_code, beside, place_of, plain_words, short

GOOD = {GIVEN, REPEATED, REPRODUCED, ROUNDED, QUOTED, READ, HOLDS}
NAMES = {"value": "values", "claim": "statements", "misprint": "misprints"}
COVERAGE, ERRATA, OPEN, REPRODUCED_PAGE, GLOSSARY, INDEX = (
    "Coverage",
    "Errata",
    "What is not reproduced, and why",
    "What is reproduced",
    "Glossary",
    "Index of printed tables and places",
)
PLAIN_KINDS = {"text", "label", "cross-reference"}
Content = list[Any]


def pages(
    medium: Medium,
    counts: Sequence[Count],
    found: Sequence[LedgerRow],
    terms: Sequence[Term],
    chapters: Mapping[str, str],
) -> list[Page]:
    """All pages, in the order of the book. terms: of the glossary, none where there is none. chapters: what the index
    calls each notebook."""
    made = [
        Page(ERRATA, errata_page(medium, found), "errata"),
        Page(COVERAGE, coverage_page(medium, counts), "coverage"),
        Page(OPEN, open_page(medium, found), "open"),
        Page(REPRODUCED_PAGE, reproduced_page(medium, found), "reproduced"),
        Page(GLOSSARY, glossary_page(terms), "glossary"),
        Page(INDEX, index_page(medium, found, chapters), "index"),
    ]
    return [page for page in made if page.content]


def sentences(counts: Sequence[Count]) -> list[str]:
    """The coverage in three sentences, for a cover."""
    whole = total(counts)
    lines = []
    for table in TABLES:
        if not whole.printed[table]:
            continue
        verdicts = ", ".join(f"{n} {verb_of(verdict, n)}" for verdict, n in whole.of(table))
        word = {"value": "printed values", "claim": "statements tested", "misprint": "misprints found"}[table]
        lines.append(f"{whole.printed[table]} {word}: {verdicts or 'none checked'}")
    if whole.unchecked:
        lines.append(f"{len(whole.unchecked)} printed entries that no notebook checks")
    return lines


def coverage_page(medium: Medium, counts: Sequence[Count]) -> Content:
    """How many entries each document and each place has, and with which verdicts."""
    if not counts:
        return []
    documents = by_document(counts)
    heads = ["entry", "verdict", *(d.document for d in documents), "all"]
    rows, whole = [], total(counts)
    for table, verdicts in VERDICTS.items():
        for verdict in verdicts:
            numbers = [d.verdicts.get((table, verdict), 0) for d in (*documents, whole)]
            if any(numbers):
                rows.append([NAMES[table], verdict, *map(str, numbers)])
    align = ["left", "left", *["right"] * (len(documents) + 1)]
    content: Content = [
        "Every number, statement and misprint of the documents that can be checked, with the verdict it got.",
        Table(heads, rows, "Verdicts by document", align),
    ]
    missing = [c for c in counts if c.unchecked]
    if missing:
        lines = [f"- {c.document}, {plain_words(c.place)}: {', '.join(id for _, id in c.unchecked)}" for c in missing]
        content.append("No notebook checks these entries:\n\n" + "\n".join(lines))
    for document in documents:
        here = [c for c in counts if c.document == document.document]
        rows = [_coverage_row(c) for c in here]
        sums = [str(document.printed[t]) if t != "misprint" else _number(document.printed[t]) for t in TABLES]
        rows.append([f"all {len(here)} places", sums[0], "", sums[1], "", sums[2]])
        heads = ["place", "values", "their verdicts", "statements", "their verdicts", "misprints"]
        align = ["left", "right", "left", "right", "left", "right"]
        content += [
            f"## {medium.name(document.document)}",
            Table(heads, rows, f"{medium.name(document.document)}, place by place", align),
        ]
    return content


def _coverage_row(count: Count) -> list[str]:
    values, claims, misprints = (_number(count.printed[t]) for t in TABLES)
    verdicts = [", ".join(f"{n} {verb_of(v, n)}" for v, n in count.of(t)) for t in TABLES]
    return [plain_words(count.place), values, verdicts[0], claims, verdicts[1], misprints]


def _number(number: int) -> str:
    return str(number) if number else ""


def errors(found: Iterable[LedgerRow]) -> str:
    """The number of errata in words."""
    wrong = errata(found)
    misleads, false = (sum(e.group == group for e in wrong) for group in (MISLEADS, FALSE))
    return (
        f"{len(wrong)} errors in the documents: {misleads} would mislead someone who uses what is printed, {false} "
        f"statements do not hold, {len(wrong) - misleads - false} mislead nobody"
    )


def errata_page(medium: Medium, found: Sequence[LedgerRow]) -> Content:
    """What is wrong in the documents; what misleads first."""
    wrong = errata(found)
    if not wrong:
        return ["The notebooks found nothing wrong."]
    heads = {
        MISLEADS: "What would mislead someone who uses it",
        FALSE: "Statements that do not hold",
        HARMLESS: "What is only written wrongly",
    }
    shows = f"the {'page' if medium.paper else 'section'} named in its row shows how"
    content: Content = [
        f"{errors(found)}. Each was found by computation or by comparison within the document, and {shows}."
    ]
    for group, title in heads.items():
        chosen = [e for e in wrong if e.group == group]
        if chosen:
            content.append(f"## {title}")
        for document in dict.fromkeys(e.found.document for e in chosen):
            rows = [e for e in chosen if e.found.document == document]
            content.append(_errata_table(medium, document, group, rows))
    return content


def _errata_table(medium: Medium, document: str, group: str, rows: Sequence[Erratum]) -> LinkedTable:
    if group == FALSE:
        columns = ["place", "the document says", "computed", medium.where]
        made = [[plain_words(e.found.place), e.printed, e.note, place_of(e.found)] for e in rows]
        return medium.table(columns, made, f"{medium.name(document)}: statements that do not hold")
    columns = ["place", "printed", "correct", "what is wrong", medium.where]
    made = [[plain_words(e.found.place), *_forms(e), e.note, place_of(e.found)] for e in rows]
    caption = {MISLEADS: "errors that mislead", HARMLESS: "slips that mislead nobody"}[group]
    return medium.table(columns, made, f"{medium.name(document)}: {caption}")


def _forms(wrong: Erratum) -> tuple[str, str]:
    if wrong.kind == "number":
        unit = wrong.found.fields["unit"]
        return f"{short(wrong.printed)} {unit}".strip(), f"{beside(wrong.corrected, wrong.printed)} {unit}".strip()
    show = plain_words if wrong.kind in PLAIN_KINDS else as_code
    return show(wrong.printed), show(wrong.corrected)


def open_page(medium: Medium, found: Sequence[LedgerRow]) -> Content:
    """What neither holds nor is wrong: values that differ for a reason, statements that hold in part."""
    chosen = [r for r in found if r.table != "misprint" and r.verdict not in {*GOOD, MISPRINT, FAILS}]
    chosen += [r for r in found if r.table == "misprint" and r.fails]
    link = medium.page("errata", ERRATA)
    content: Content = [
        f"What is wrong in the documents stands in the [errata]({link}). Here is the rest that is not simply "
        "reproduced: values that differ for a reason that is given, and statements that hold in part, with the part "
        "that does not."
    ]
    if not chosen:
        content.append("There is none.")
    values = [r for r in _sorted(chosen) if r.table == "value"]
    if values:
        columns = ["place", "quantity", "printed", "exact", "why", medium.where, "verdict"]
        rows = [[_place(medium, r), *_value(r)[:3], r.fields["reason"], place_of(r), r.verdict] for r in values]
        content += ["## Values", medium.table(columns, rows, "Values that are not reproduced", (), _marks(values))]
    claims = [r for r in _sorted(chosen) if r.table == "claim"]
    if claims:
        content.append("## Statements")
    for document in dict.fromkeys(r.document for r in claims):
        here = [r for r in claims if r.document == document]
        content.append(_claims(medium, here, f"{medium.name(document)}: statements that hold in part"))
    failed = [r for r in chosen if r.table == "misprint"]
    if failed:
        rows = [[_place(medium, r), as_code(r.fields["printed"]), place_of(r), r.verdict] for r in failed]
        columns = ["place", "printed", medium.where, "verdict"]
        content.append(medium.table(columns, rows, "Misprints that are not confirmed", (), _marks(failed)))
    return content


def reproduced_page(medium: Medium, found: Iterable[LedgerRow]) -> Content:
    """Every value that the computation gives, every input, every statement that holds."""
    good = [r for r in found if r.verdict in GOOD]
    content: Content = []
    if good:
        content.append(
            "*exact* is computed from first principles at full precision; *from rounded inputs* by the document's own "
            "chain of arithmetic, from its own rounded numbers, where only that gives the printed digits; *elsewhere* "
            "is the number of the named source, or of the first print."
        )
    for document in dict.fromkeys(r.document for r in _sorted(good)):
        here = [r for r in _sorted(good) if r.document == document]
        content.append(f"## {medium.name(document)}")
        values = [r for r in here if r.table == "value"]
        if values:
            columns = [
                "place",
                "quantity",
                "printed",
                "exact",
                "from rounded inputs",
                "elsewhere",
                medium.where,
                "verdict",
            ]
            rows = [[plain_words(r.place), *_value(r), place_of(r), r.verdict] for r in values]
            align = ["left", "left", *["right"] * 4, "right" if medium.paper else "left", "left"]
            content.append(medium.table(columns, rows, f"{medium.name(document)}: values", align, _marks(values)))
        claims = [r for r in here if r.table == "claim"]
        if claims:
            content.append(_claims(medium, claims, f"{medium.name(document)}: statements that hold"))
    return content


def _claims(medium: Medium, claims: Sequence[LedgerRow], caption: str) -> LinkedTable:
    columns = ["place", "the document says", "computed", medium.where, "verdict"]
    rows = [[plain_words(r.place), r.fields["says"], r.fields["evidence"], place_of(r), r.verdict] for r in claims]
    return medium.table(columns, rows, caption, (), _marks(claims))


def _value(found: LedgerRow) -> tuple[str, str, str, str, str]:
    fields = found.fields
    digits = fields["printed"]
    exact, from_inputs, quoted, first = (beside(fields.get(key, ""), digits) for key in NUMBERS)
    return fields["quantity"], f"{short(digits)} {fields['unit']}".strip(), exact, from_inputs, quoted or first


def _place(medium: Medium, found: LedgerRow) -> str:
    return f"{medium.name(found.document)}, {plain_words(found.place)}"


def _marks(found: Iterable[LedgerRow]) -> list[str]:
    return [MARKS[r.verdict] for r in found]


def _sorted(found: Iterable[LedgerRow]) -> list[LedgerRow]:
    """By document as they come, then by place as a person counts."""
    found = list(found)
    documents = list(dict.fromkeys(r.document for r in found))
    return sorted(found, key=lambda r: (documents.index(r.document), natural(r.place), r.table != "value"))


def glossary_page(terms: Sequence[Term]) -> Content:
    """The documents' own terms beside ours, by the English word."""
    if not terms:
        return []
    rows = [[t.en, t.sv, t.pl, t.symbol, t.unit] for t in sorted(terms, key=lambda t: t.en.casefold())]
    heads = ["English", "Swedish", "Polish", "symbol", "unit"]
    return [Table(heads, rows, "Terms of the three documents", ["left"] * 5)]


def index_page(medium: Medium, found: Iterable[LedgerRow], chapters: Mapping[str, str]) -> Content:
    """From a printed table, figure, equation or section to where the chapters take it up."""
    content: Content = []
    records = _sorted(found)
    for document in dict.fromkeys(r.document for r in records):
        met: dict[tuple[str, str, str], LedgerRow] = {}
        for record in records:
            if record.document == document:
                key = (record.place, record.notebook, record.section)
                met[key] = min(record, met.get(key, record), key=lambda r: r.cell)
        ordered = sorted(met.values(), key=lambda r: (natural(r.place), r.notebook, r.cell))
        rows = []
        for r in ordered:
            chapter = To(chapters.get(r.notebook, r.notebook), r.notebook)
            rows.append([plain_words(r.place), chapter, *_section(medium, r), place_of(r)])
        columns = ["place", "chapter", *(["section"] if medium.paper else []), medium.where]
        align = ["left", "left", "left", "right"] if medium.paper else ["left"] * 3
        content += [
            f"## {medium.name(document)}",
            medium.table(columns, rows, f"{medium.name(document)}: places", align),
        ]
    return content


def _section(medium: Medium, found: LedgerRow) -> list[str]:
    return [place_of(found).section] if medium.paper else []
