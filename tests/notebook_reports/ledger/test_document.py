"""The verdicts: each is reached by the values that deserve it, and only by those."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from notebook_reports.ledger import document as ledger
from notebook_reports.ledger.document import Document, LedgerError
from notebook_reports.ledger.printed_data import Claim, Misprint, PrintedDocument, Value
from notebook_reports.ledger.verdicts import Computed, rounds_to, value_verdict


def value(printed="6.44", **more):
    return Value("pid-report", "Table 5.2", "K", "gain $K$", printed, **more)


@pytest.mark.parametrize(
    ("computed", "digits", "expected"),
    [
        (6.44, "6.44", True),
        (6.4449, "6.44", True),
        (6.4451, "6.44", False),
        (Fraction(1, 8), "0.12", True),  # a tie goes either way
        (Fraction(1, 8), "0.13", True),
        (-1080900, "-1.0809e+06", True),
        (-1080949, "-1.0809e+06", True),
        (-1080951, "-1.0809e+06", False),
        (np.float64(0.3), "0.30", True),
        (sympy.Rational(1, 3), "0.333", True),
        (float("nan"), "0", False),
        (float("inf"), "9e99", False),
        (None, "0", False),
    ],
)
def test_rounds_to_the_printed_digits(computed, digits, expected):
    assert rounds_to(computed, digits) is expected


@given(st.integers(-(10**9), 10**9), st.integers(0, 6))
def test_every_number_rounds_to_its_own_decimals_and_not_to_the_neighbour(n, places):
    digits = f"{Decimal(n).scaleb(-places):.{places}f}"
    neighbour = f"{Decimal(n + 1).scaleb(-places):.{places}f}"
    assert rounds_to(Fraction(n, 10**places), digits)
    assert not rounds_to(Fraction(n, 10**places), neighbour)


@pytest.mark.parametrize(
    ("item", "found", "expected"),
    [
        (value(), {"exact": 6.441}, "reproduced"),
        (value(), {"exact": 6.43, "from_inputs": 6.44}, "from rounded inputs"),
        (value(), {"exact": 6.441, "from_inputs": 6.3}, "reproduced"),
        (value(kind="given"), {}, "given"),
        (value(kind="given"), {"exact": 6.0}, "unexplained"),
        (value(source="a book"), {"quoted": Fraction("6.44")}, "quoted"),
        (value(source="a book"), {"quoted": Fraction("6.441")}, "unexplained"),
        (value("3", source="a book"), {"quoted": Fraction(10, 3)}, "unexplained"),
        (value(kind="given"), {"first": Fraction("6.44")}, "repeated"),
        (value(kind="given"), {"first": Fraction("6.45")}, "unexplained"),
        (value("6.4", kind="given"), {"first": Fraction("6.44")}, "repeated"),
        (value(reading="0.1", reason="off a graph"), {"exact": 6.5}, "read"),
        (value(reading="0.05", reason="off a graph"), {"exact": 6.5}, "unexplained"),
        (value(reading="0.05", reason="off a graph", between=("6", "7")), {"exact": 6.5}, "unexplained"),
        (value(corrected="6.54", reason="digit"), {"exact": 6.541}, "misprint"),
        (value(corrected="6.54", reason="digit"), {"exact": 6.641}, "unexplained"),
        (value(reason="a truncated input"), {"exact": 6.5}, "unexplained"),
        (value(reason="a truncated input"), {"exact": 1e9}, "unexplained"),
        (value(reason="a truncated input"), {"exact": 6.5, "explained": 6.438}, "differs"),
        (value(reason="a truncated input"), {"exact": 6.5, "explained": 6.5}, "unexplained"),
        (value(reason="a closed tool", between=("6.49", "6.51")), {"exact": 6.5}, "differs"),
        (value(reason="a closed tool", between=("6.49", "6.51")), {"exact": 6.52}, "unexplained"),
        (value(), {"exact": 6.5, "from_inputs": 6.5}, "unexplained"),
        (value(), {"exact": float("nan")}, "unexplained"),
    ],
)
def test_verdict(item, found, expected):
    assert value_verdict(item, Computed(**found)) == expected


@given(st.decimals(-(10**6), 10**6, places=3), st.integers(1, 10**6))
def test_no_row_with_a_reason_accepts_any_number(printed, off):
    """Without a number that follows from the reason, or an interval, nothing off the print is explained."""
    item = value(str(printed), reason="because")
    assert value_verdict(item, Computed(exact=Fraction(printed) + off)) == "unexplained"


@pytest.fixture
def book():
    values = {
        "K": value(),
        "Ti": Value("pid-report", "Table 5.2", "Ti", "$T_i$", "0.361", "s"),
        "L": Value("pid-report", "section 5.4", "L", "$L$", "0.075", "s", "given"),
    }
    claims = {"stable": Claim("pid-report", "section 5.4", "stable", "The loop is stable.")}
    misprints = {
        "eq-4.17": Misprint(
            *("pid-report", "eq. 4.17", "eq-4.17", "formula", "p4 = a/b*c", "p4 = a/(b*c)", "parentheses", True),
            proof="derivation",
            printed_expr="a/b*c",
            corrected_expr="a/(b*c)",
        ),
        "label": Misprint("pid-report", "Table 4", "label", "label", "Table 4", "Table 5", "named twice", False),
        "run": Misprint("pid-report", "Table 4", "run", "code", "u = K p", "u = Kp", "a break", True, "run"),
    }
    return Document(PrintedDocument("pid-report", values, claims, misprints))


def test_a_check_carries_records_and_shows_a_table(book):
    checked = book.check("Table 5.2", exact={"K": 6.44, "Ti": 0.36122})
    assert checked.ok and checked.verdicts() == {"K": "reproduced", "Ti": "reproduced"}
    bundle = checked._repr_mimebundle_()
    first = bundle[ledger.CHECKS_MIME][0]
    assert (first["document"], first["place"], first["id"]) == ("pid-report", "Table 5.2", "K")
    assert first["fields"]["exact"] == "6.44" and first["fields"]["printed"] == "6.44"
    assert "reproduced" in bundle["text/html"]


def test_a_wrong_number_fails_and_says_so(book):
    checked = book.check("Table 5.2", exact={"K": 6.45, "Ti": 0.36122})
    assert not checked.ok and checked.verdicts()["K"] == "unexplained"
    assert "bad" in checked.view.marks


def test_every_number_of_a_place_needs_a_value(book):
    with pytest.raises(LedgerError, match=r"pid-report, Table 5\.2: nothing computed for Ti"):
        book.check("Table 5.2", exact={"K": 6.44})
    assert book.check("Table 5.2", exact={"K": 6.44}, only=("K",)).ok


def test_names_that_do_not_exist_are_refused_with_the_nearest(book):
    with pytest.raises(LedgerError, match=r"did you mean Table 5\.2\?"):
        book.check("Table 5.3", exact={})
    with pytest.raises(LedgerError, match="no printed value 'Tj'; did you mean Ti"):
        book.check("Table 5.2", exact={"Tj": 1})
    with pytest.raises(LedgerError, match="no claim 'stabel'; did you mean stable"):
        book.claim("stabel", True, "poles at -1")
    with pytest.raises(LedgerError, match="as evidence"):
        book.claim("stable", True, " ")


@pytest.mark.parametrize(
    ("parts", "expected"),
    [({"a": True, "b": True}, "holds"), ({"a": True, "b": False}, "holds partly"), (False, "fails")],
)
def test_claims(book, parts, expected):
    checked = book.claim("stable", parts, "largest pole -0.3")
    assert checked.verdicts() == {"stable": expected}
    assert ("Not for: b." in checked.records[0].fields["evidence"]) is (expected == "holds partly")


def test_a_misprint_is_proven_by_the_derived_formula(book):
    a, b, c = sympy.symbols("a b c", positive=True)
    assert book.misprint("eq-4.17", a / (b * c)).verdicts() == {"eq-4.17": "proved"}
    assert not book.misprint("eq-4.17", a * c / b).ok  # the derivation gives the print: no misprint
    assert not book.misprint("eq-4.17", a / (b + c)).ok  # it gives neither: the correction is wrong


@pytest.mark.parametrize(("outcome", "ok"), [((False, True), True), ((True, True), False), ((False, False), False)])
def test_a_run_proves_that_the_print_fails_and_the_correction_holds(book, outcome, ok):
    checked = book.misprint("run", outcome)
    assert checked.ok is ok and checked.records[0].fields["proof"] == "run"


def test_a_slip_is_noted_and_cannot_be_called_proved(book):
    assert book.noted("label").verdicts() == {"label": "noted"}
    with pytest.raises(LedgerError, match=r"misprint label: the data names no proof; use noted\(\)"):
        book.misprint("label", True)
    with pytest.raises(LedgerError, match="misprint run: the data says it is proved"):
        book.noted("run")


def test_a_repeated_print_is_checked_against_the_first(book):
    values = book.printed.values | {
        "L2": Value("pid-report", "Figure 1", "L2", "$L$", "0.075", "s", "given", same_as="L")
    }
    again = Document(PrintedDocument("pid-report", values, {}, {})).check("Figure 1")
    assert again.verdicts() == {"L2": "repeated"} and again.records[0].fields["first"] == "0.075"
    assert again.records[0].fields["reason"] == "as at section 5.4, $L$"


def test_a_quoted_constant_needs_its_source(book):
    with pytest.raises(LedgerError, match=r"no source in the data for K"):
        book.check("Table 5.2", quoted={"K": Fraction("6.44")}, only=("K",))


def test_other_parameters_are_shown_without_a_verdict(book):
    free = Document(book.printed, compare=False)
    checked = free.check("Table 5.2", exact={"K": 7.0})
    assert checked.records == () and "verdict" not in checked.view.columns
    assert ledger.CHECKS_MIME not in checked._repr_mimebundle_()
    assert "none" in free.summary().rows[0][0]


def test_the_summary_counts_what_was_checked(book):
    book.check("Table 5.2", exact={"K": 6.44, "Ti": 0.5})
    book.claim("stable", True, "poles at -1")
    assert book.summary().rows == [
        ["value", "reproduced", "1"],
        ["value", "unexplained", "1"],
        ["claim", "holds", "1"],
    ]


def test_given_numbers_are_exact(book):
    assert book.given("section 5.4") == {"L": Fraction(3, 40)}
    assert book.value("Ti") == Fraction(361, 1000)
