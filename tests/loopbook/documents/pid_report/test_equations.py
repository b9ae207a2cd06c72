"""Equations 4.1 to 4.20 of pid-report: each derived form against the printed one."""

import pytest
import sympy

from derivations.pid.pid_updates import saturated, saturated_by_cases
from loopbook.documents import open as documents
from loopbook.documents.equation_numbers import EquationError, agrees, comparisons, derived, eq, read
from loopbook.documents.labels import Labels
from loopbook.documents.pid_report.equations import EQUATIONS
from notebook_reports.formula.read import Symbols, UnknownName, read_formula

REPORT = documents.printed("pid-report")
WRONG = {"4.4", "4.17"}
LABELS = [f"4.{n}" for n in range(1, 21)]


def test_the_registry_holds_each_number_once():
    assert list(EQUATIONS) == LABELS
    assert {f"eq-{label}" for label in LABELS} <= set(REPORT.claims)


@pytest.mark.parametrize("label", LABELS)
def test_printed_equation(label):
    """Equal where the print is right; where it is wrong the derived form is the correction in the misprint row."""
    assert agrees("pid-report", label) == (label not in WRONG), f"eq. {label}: {derived('pid-report', label)}"


@pytest.mark.parametrize("label", sorted(WRONG))
def test_misprinted_equation(label):
    equation, item = derived("pid-report", label), REPORT.misprints[f"eq-{label}"]
    names = Symbols({s.name: s for s in equation.free_symbols})
    assert sympy.simplify(read_formula(item.corrected_expr, names) - equation.rhs) == 0, f"eq. {label}"
    wrong = read_formula(item.printed_expr, names)
    assert sympy.simplify(wrong - equation.rhs) != 0, f"eq. {label}"


def test_saturation_by_cases_is_min_and_max():
    """For v below, at, between, at and above the limits."""
    low, inside, beyond = sympy.Symbol("low", real=True), *sympy.symbols("inside beyond", positive=True)
    high = low + 2 * inside
    for value in (low - beyond, low, low + inside, high, high + beyond):
        assert saturated_by_cases(value, low, high) == saturated(value, low, high), "eq. 4.2"


def test_eq_shows_the_derived_form_under_its_number():
    shown = eq("pid-report", "4.9")
    assert (shown.label, shown.anchor) == ("4.9", "eq-pid-report-4.9")
    assert shown.latex.startswith(r"y_{f}{\left(t_{k} \right)} = ")


@pytest.mark.parametrize(
    ("document", "label", "message"),
    [
        ("pid-report", "4.21", "no derived equation '4.21'; did you mean"),
        ("pid-raport", "4.1", f"unknown document 'pid-raport'; one of {', '.join(documents.names())}"),
    ],
)
def test_unknown_numbers_fail(document, label, message):
    with pytest.raises(EquationError) as caught:
        eq(document, label)
    assert message in str(caught.value)


def test_a_label_stands_once():
    labels = Labels("pid-report")
    labels("4.1")(lambda: sympy.Eq(1, 1))
    with pytest.raises(ValueError, match=r"pid-report: equation 4\.1 is already registered"):
        labels("4.1")


def test_reading_a_printed_formula_refuses_what_the_derivation_has_not():
    with pytest.raises(UnknownName, match=r"character 31: the sample y\[k\+1\] is not known"):
        read("yf[k] = p1*yf[k-1] + (1 - p1)*y[k+1]", derived("pid-report", "4.9"))
    with pytest.raises(UnknownName, match='character 13: "q9" is not known'):
        read("p1 = 1/(1 + q9/Tf)", derived("pid-report", "4.8"))


def test_comparisons_give_claims_for_the_ledger():
    claims = comparisons("pid-report", "4.4", "4.13")
    assert claims["eq-4.4"] == (False, "derived: `p4 = h/Tt`")
    assert claims["eq-4.13"] == (True, "derived: `Df[k] = p24*y[k-1] + p3*Df[k-1] - p24*y[k]`")
