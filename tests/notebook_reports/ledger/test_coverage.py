"""What is printed against what was checked, in numbers."""

import pytest

from notebook_reports.ledger.coverage import by_document, coverage, total
from notebook_reports.ledger.printed_data import Claim, Misprint, PrintedDocument, Value
from notebook_reports.ledger.row import LedgerRow


def value(id, place="Table 5"):
    return Value("double-tank", place, id, "rise", "1.0")


@pytest.fixture
def document():
    values = {"a": value("a"), "b": value("b"), "c": value("c", "Table 10")}
    claims = {"a": Claim("double-tank", "Table 10", "a", "It settles.")}
    misprints = {"m": Misprint("double-tank", "Table 2", "m", "label", "x", "y", "note", False)}
    return PrintedDocument("double-tank", values, claims, misprints)


def record(table, id, verdict, place="Table 5", document="double-tank"):
    return LedgerRow(table, document, place, id, verdict, {})


def test_entries_verdicts_and_what_is_open_at_each_place(document):
    records = [
        record("value", "a", "reproduced"),
        record("value", "c", "differs", "Table 10"),
        record("claim", "a", "holds", "Table 10"),
    ]
    second, fifth, tenth = coverage([document], records)
    assert [c.place for c in (second, fifth, tenth)] == ["Table 2", "Table 5", "Table 10"]
    assert (fifth.printed["value"], fifth.of("value"), fifth.unchecked) == (2, [("reproduced", 1)], (("value", "b"),))
    assert second.unchecked == (("misprint", "m"),) and not second.of("misprint")
    assert (tenth.of("value"), tenth.of("claim"), tenth.unchecked) == ([("differs", 1)], [("holds", 1)], ())


def test_the_parts_add_up(document):
    counts = coverage([document], [record("value", "a", "reproduced"), record("value", "x", "given", "p", "other")])
    whole = total(counts)
    assert (whole.printed["value"], whole.printed["claim"], whole.printed["misprint"]) == (3, 1, 1)
    assert sum(whole.verdicts.values()) == 2 and len(whole.unchecked) == 4
    assert [d.document for d in by_document(counts)] == ["double-tank", "other"]
    assert total(counts, "other").of("value") == [("given", 1)]


def test_the_same_id_in_two_tables_is_two_entries(document):
    counts = coverage([document], [record("claim", "a", "fails", "Table 10")])
    assert ("value", "a") in total(counts).unchecked and ("claim", "a") not in total(counts).unchecked
