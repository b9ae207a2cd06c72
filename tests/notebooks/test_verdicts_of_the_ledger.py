"""The table of verdicts in docs/verdicts.md, true of every row of the committed ledger."""

import csv
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest

from loopbook.documents.open import printed
from notebook_reports.ledger.printed_data import PROOFS
from notebook_reports.ledger.verdicts import CLAIM_VERDICTS, MISPRINT_VERDICTS, UNEXPLAINED, VALUE_VERDICTS, rounds_to

ROOT = Path(__file__).parents[2]
NUMBERS = ("exact", "from_inputs", "quoted", "first")


def rows(name):
    with (ROOT / "reports" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def number(row, name):
    return Fraction(row[name]) if row[name] else None


def rounds(row, name, digits=None):
    return row[name] != "" and rounds_to(number(row, name), digits or row["printed"])


def source(row):
    return printed(row["document"]).values[row["id"]]


def reproduced(row):
    return rounds(row, "exact")


def from_rounded_inputs(row):
    return rounds(row, "from_inputs") and not rounds(row, "exact")


def quoted(row):
    named = source(row).source
    return named and named in row["reason"] and number(row, "quoted") == Fraction(row["printed"])


def repeated(row):
    first = printed(row["document"]).values[source(row).same_as]
    return rounds(row, "first") and number(row, "first") == first.fraction and first.place in row["reason"]


def read(row):
    return source(row).reading and abs(number(row, "exact") - source(row).fraction) <= Fraction(source(row).reading)


def misprint(row):
    right = source(row).corrected
    wrong = not any(rounds(row, name) for name in NUMBERS)
    return wrong and row["reason"] and any(rounds(row, name, right) for name in NUMBERS)


def differs(row):
    known = number(row, "exact") if row["exact"] else number(row, "quoted")
    ends = [Fraction(x) for x in source(row).between]
    inside = not ends or ends[0] <= known <= ends[1]
    other = known != Fraction(row["printed"]) if row["quoted"] else not any(rounds(row, name) for name in NUMBERS)
    return row["reason"] and inside and other


def given(row):
    return row["kind"] == "given" and not any(row[name] for name in NUMBERS)


MEANS: dict[str, Callable] = {
    "reproduced": reproduced,
    "from rounded inputs": from_rounded_inputs,
    "quoted": quoted,
    "repeated": repeated,
    "read": read,
    "misprint": misprint,
    "differs": differs,
    "given": given,
}


def test_the_page_has_a_line_for_every_verdict_of_a_value():
    page = (ROOT / "docs/verdicts.md").read_text(encoding="utf-8")
    table = page.split("# The verdicts")[1].split("A value that is none of these")[0]
    assert set(re.findall(r"^\| ([a-z ]+) \|", table, re.MULTILINE)) - {"verdict"} == set(MEANS)
    assert set(MEANS) == set(VALUE_VERDICTS) - {UNEXPLAINED}


@pytest.mark.parametrize("verdict", MEANS)
def test_every_row_is_what_its_verdict_says(verdict):
    found = [row for row in rows("ledger.csv") if row["verdict"] == verdict]
    wrong = [f"{row['document']}, {row['id']}" for row in found if not MEANS[verdict](row)]
    assert found and not wrong, f"not {verdict}: {', '.join(wrong)}"


def test_no_row_has_another_verdict():
    assert {row["verdict"] for row in rows("ledger.csv")} <= set(MEANS)
    assert {row["verdict"] for row in rows("claims.csv")} == set(CLAIM_VERDICTS)
    assert {row["verdict"] for row in rows("misprints.csv")} == set(MISPRINT_VERDICTS[:2])


def test_statements_show_their_numbers_and_say_what_they_do_not_hold_for():
    for row in rows("claims.csv"):
        assert row["evidence"], row["id"]
        assert row["verdict"] != "holds partly" or "Not for: " in row["evidence"], row["id"]


def test_a_misprint_is_proved_in_a_named_way_or_only_noted():
    for row in rows("misprints.csv"):
        assert (row["verdict"] == "proved") == (row["proof"] in PROOFS), row["id"]
        assert row["proof"] in ("", *PROOFS), row["id"]
