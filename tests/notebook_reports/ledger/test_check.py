"""The ledger as text and as data: what fails is shown, forms hold the same rows, a place is found by its name."""

import csv
import json

import pytest

from notebook_reports.ledger import check
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.project.project import UsageError

VALUE = {"quantity": "rise | time", "printed": "3.66", "unit": "s", "kind": "computed", "exact": "3.6634812"}
LEDGER = check.Ledger(
    [
        LedgerRow("value", "tank", "Table 5", "rise", "reproduced", VALUE),
        LedgerRow("value", "tank", "Table 5", "settling", "unexplained", {**VALUE, "reason": "none"}),
        LedgerRow(
            "claim", "report", "section 4", "stable", "fails", {"says": "It is stable.", "evidence": "pole 1.02"}
        ),
    ]
)


def test_the_text_counts_all_and_shows_what_does_not_hold():
    text = check.as_text(LEDGER, whole=False)
    assert "reproduced" in text and "computed 3.66348" in text and "It is stable.: pole 1.02" in text
    assert text.count("rise | time") == 1, "the reproduced row is not listed"
    assert "rise | time" in check.as_text(LEDGER.of("tank"), whole=True)
    assert [row.id for row in LEDGER.failing] == ["settling"]


def test_the_forms_hold_the_same_rows():
    rows = json.loads(check.as_json(LEDGER))
    assert [row["table"] for row in rows] == ["value", "value", "claim"] and rows[0]["exact"] == "3.6634812"
    read = list(csv.DictReader(check.as_csv(LEDGER).splitlines()))
    assert [{k: v for k, v in row.items() if v} for row in read] == [{k: v for k, v in r.items() if v} for r in rows]
    assert "rise \\| time" in check.as_markdown(LEDGER)


def test_a_place_is_found_and_a_wrong_name_answered():
    assert len(LEDGER.of("Tank", "table 5").rows) == 2
    with pytest.raises(UsageError, match="the ledger has no place 'Table 6'; there is Table 5"):
        LEDGER.of("tank", "Table 6")
