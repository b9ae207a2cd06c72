"""What needs attention stands first; the page needs nothing and text stays text."""

import csv
import io
import re

import pytest

from loopbook.design.plant.attention import ORDER, LoopRow, ranked
from loopbook.design.plant.summary import summary_csv, summary_page

ROWS = [
    LoopRow("fine", Ms=1.4, fit=99.0, at_limit=0.0),
    LoopRow("mind", Ms=1.4, fit=99.0, mind=("An outlier was left out.",)),
    LoopRow("poor", Ms=1.4, fit=70.0),
    LoopRow("poorer", Ms=1.4, fit=40.0),
    LoopRow("limited", Ms=1.4, fit=99.0, at_limit=0.3),
    LoopRow("fragile", Ms=2.2, fit=99.0),
    LoopRow("more fragile", Ms=2.9, fit=99.0),
    LoopRow("lacks", Ms=1.4, fit=99.0, lacks=True, mind=("Mind: it shakes.",)),
    LoopRow("refused", refused="no step found"),
    LoopRow("failed", failed="TimeoutError: not done within 600 s"),
]


def test_the_worst_first():
    names = ["failed", "refused", "lacks", "more fragile", "fragile", "limited", "poorer", "poor", "mind", "fine"]
    assert [row.name for row in ranked(ROWS)] == names
    assert {row.state for row in ROWS} == set(ORDER)
    assert all(row.why for row in ROWS if row.name != "fine")


@pytest.mark.parametrize("text", ["=1+1", "<script>alert(1)</script>", "a\nb", '"><img src=x>', "+SUM(A1)", "\x1b[31m"])
def test_what_comes_from_data_is_text(text):
    rows = [LoopRow(text, refused=text)]
    page = summary_page(rows, {text: {"pdf": f"{text}-design.pdf"}}).decode()
    assert page.count("<script>") == 1 and "<img" not in page and "\x1b" not in page
    (line,) = csv.DictReader(io.StringIO(summary_csv(rows).decode()))
    assert not line["loop"].startswith(("=", "+")) and "\n" not in line["loop"]


def test_the_page_needs_nothing_and_its_policy_allows_no_more():
    page = summary_page(ranked(ROWS), {"fine": {"pdf": "fine-design.pdf"}}).decode()
    assert "default-src 'none'" in page and not re.search(r"https?://|url\(|@import", page)
    assert page.count("<tr data-state") == len(ROWS) and 'href="fine-design.pdf"' in page
    assert summary_page(ranked(ROWS[::-1]), {}) == summary_page(ranked(ROWS), {})
