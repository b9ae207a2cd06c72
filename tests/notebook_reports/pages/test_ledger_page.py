"""The three reports: each record in one of them, the errata in the order of the harm they do."""

import pytest

from notebook_reports.ledger.coverage import coverage
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.verdicts import CLAIM_VERDICTS, MISPRINT_VERDICTS, VALUE_VERDICTS
from notebook_reports.pages import ledger_page as ledger
from notebook_reports.pages.errata import errata
from notebook_reports.pages.medium import PAPER, SCREEN, At, beside

FIELDS = {
    "value": {
        "quantity": "rise",
        "printed": "3.66",
        "unit": "s",
        "kind": "computed",
        "exact": "3.6634812",
        "from_inputs": "",
        "reason": "rounded",
    },
    "claim": {"says": "It settles.", "evidence": "within 4 s"},
    "misprint": {"kind": "formula", "printed": "h/Ti", "corrected": "K*h/Ti", "misleads": "yes", "note": "K lost"},
}


def found(id, table, verdict, document="double-tank", place="Table 5", cell=7, **fields):
    told = FIELDS[table] | fields
    return LedgerRow(table, document, place, id, verdict, told, "double_tank/01", cell, "c", "Results")


def everything():
    verdicts = {"value": VALUE_VERDICTS, "claim": CLAIM_VERDICTS, "misprint": MISPRINT_VERDICTS}
    return [found(f"{t}-{v}", t, v, cell=n) for t, vs in verdicts.items() for n, v in enumerate(vs, 1)]


def urls(page):
    return [url for table in page.content if hasattr(table, "links") for url in table.links.values()]


@pytest.mark.parametrize("medium", [PAPER, SCREEN], ids=["paper", "screen"])
def test_every_record_stands_in_exactly_one_report(medium):
    for record in everything():
        made = {p.name: p for p in ledger.pages(medium, coverage([], [record]), [record], [], {})}
        rows = [name for name in ("errata", "open", "reproduced") if name in made and urls(made[name])]
        assert len(rows) == 1, record
        assert urls(made[rows[0]]) == [f"notebook:double_tank/01#cell-{record.cell}"]


def test_errata_begin_with_what_misleads():
    records = [
        found("word", "misprint", "proved", kind="text", misleads="no"),
        found("false", "claim", "fails"),
        found("code", "misprint", "proved", kind="code"),
        found("late", "misprint", "proved", place="Table 10"),
        found("formula", "misprint", "proved"),
        found("number", "value", "misprint"),
        found("first", "misprint", "proved", "pid-report", kind="unit"),
        found("right", "value", "reproduced"),
        found("true", "claim", "holds"),
    ]
    wanted = ["number", "formula", "late", "code", "first", "false", "word"]
    assert [e.found.id for e in errata(records)] == wanted == [e.found.id for e in errata(records[::-1])]


def test_paper_names_the_page_and_the_screen_the_section():
    rows = [["here", At("a/b", 3, "Results")], ["here", At("a/b", 5, "More")]]
    paper = PAPER.table(["place", PAPER.where], rows, "c")
    screen = SCREEN.table(["place", SCREEN.where], rows, "c")
    assert paper.pages == {(0, 1), (1, 1)} and not screen.pages
    assert paper.links == screen.links == {(0, 1): "notebook:a/b#cell-3", (1, 1): "notebook:a/b#cell-5"}
    assert screen.table.rows == [["here", "Results"], ["here", "More"]]
    assert not screen.table.repeats(0, 0) and screen.table.repeats(1, 0) and not screen.table.repeats(1, 1)


def test_the_index_leads_from_a_place_to_the_first_cell_of_each_section():
    records = [found(str(c), "value", "given", place="Table 10", cell=c) for c in (9, 7)]
    records += [found("x", "claim", "holds", place="Table 2", cell=8)]
    _, table = ledger.index_page(PAPER, records, {"double_tank/01": "4  A chapter"})
    assert [row[0] for row in table.table.rows] == ["Table 2", "Table 10"]
    assert [row[1:3] for row in table.table.rows] == [["4  A chapter", "Results"]] * 2
    assert {table.links[0, 1], table.links[1, 1]} == {"notebook:double_tank/01"}
    assert [table.links[y, 3] for y in (0, 1)] == ["notebook:double_tank/01#cell-8", "notebook:double_tank/01#cell-7"]


def test_the_cover_counts_what_is_printed_and_what_was_found():
    records = [found("a", "value", "reproduced"), found("b", "claim", "fails"), found("c", "claim", "fails")]
    from notebook_reports.ledger.printed_data import Claim, PrintedDocument, Value

    values = {"a": Value("double-tank", "Table 5", "a", "q", "1"), "z": Value("double-tank", "Table 5", "z", "q", "1")}
    claims = {id: Claim("double-tank", "Table 5", id, "says") for id in "bc"}
    counts = coverage([PrintedDocument("double-tank", values, claims, {})], records)
    assert ledger.sentences(counts) == [
        "2 printed values: 1 reproduced",
        "2 statements tested: 2 fail",
        "1 printed entries that no notebook checks",
    ]


@pytest.mark.parametrize(
    ("computed", "printed", "shown"),
    [
        ("0.65", "0.65", "0.65"),
        ("-1079731.25", "-1.0809e+06", "−1079731"),
        ("-2.6147855538443261e+60", "-" + 60 * "26", "−2.614785554e60"),
        ("12345678901234567890", "1", "123456…7890 (20 digits)"),
    ],
)
def test_a_computed_number_has_two_digits_more_than_the_print(computed, printed, shown):
    assert beside(computed, printed) == shown
