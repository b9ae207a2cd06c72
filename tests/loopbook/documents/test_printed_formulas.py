"""Formulas held as text: read as mathematics, wrong ones refused."""

import pytest
import sympy as sp

from loopbook.documents.open import printed
from loopbook.documents.printed_formulas import FormulaError, formulas
from notebook_reports.ledger.printed_data import Claim


def claim(says):
    return Claim("double-tank", "here", "some-id", says)


def test_signals_symbols_and_the_sample_number():
    ((left, right),) = formulas(claim("It is `y(k) = a_1*y(k-1) + r(k)`."))
    k = sp.Symbol("k", integer=True)
    y, r = sp.Function("y"), sp.Function("r")
    assert (left, right) == (y(k), sp.Symbol("a_1") * y(k - 1) + r(k))


def test_lists_become_matrices_and_several_equations_are_read():
    (one, two) = formulas(claim("`A = [[1, q], [0, 1]]; b = [q, 1/2]`"))
    assert one[1] == sp.Matrix([[1, sp.Symbol("q")], [0, 1]])
    assert two[1] == sp.Matrix([sp.Symbol("q"), sp.Rational(1, 2)])


def test_numbers_are_exact():
    assert formulas(claim("`x = 0.1`"))[0][1] == sp.Rational(1, 10)


@pytest.mark.parametrize(
    "says, text",
    [("none", "no formula between backticks"), ("`a +* b`", "is no formula"), ("`y + 1`", "is no formula")],
)
def test_refusals(says, text):
    with pytest.raises(FormulaError, match=text):
        formulas(claim(says))


def test_every_formula_of_the_section_can_be_read():
    claims = [c for c in printed("double-tank").claims.values() if c.place.startswith(("Appendix", "Table 4 (diff"))]
    readable = [c for c in claims if "`" in c.says]
    assert len(readable) >= 11
    assert all(formulas(c) for c in readable)
