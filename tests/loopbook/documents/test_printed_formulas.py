"""Formulas of the printed data: read as mathematics, wrong ones refused by file and claim."""

import pytest
import sympy as sp

from loopbook.documents.open import names, printed
from loopbook.documents.printed_formulas import formulas
from notebook_reports.formula.read import FormulaError, Symbols, read_formula
from notebook_reports.ledger.printed_data import Claim, PrintedDataError


def claim(says):
    return Claim("double-tank", "here", "some-id", says, file="table_5.toml")


def test_signals_symbols_and_the_sample_number():
    ((left, right),) = formulas(claim("It is `y(k) = a_1*y(k-1) + r(k)`."))
    k = sp.Symbol("k", integer=True)
    y, r = sp.Function("y"), sp.Function("r")
    assert (left, right) == (y(k), sp.Symbol("a_1") * y(k - 1) + r(k))


def test_lists_become_matrices_and_several_equations_are_read():
    (one, two) = formulas(claim("`A = [[1, q], [0, 1]]; b = [q, 1/2]`"))
    assert one[1] == sp.Matrix([[1, sp.Symbol("q")], [0, 1]])
    assert two[1] == sp.Matrix([sp.Symbol("q"), sp.Rational(1, 2)])


def test_no_formula_is_refused():
    with pytest.raises(PrintedDataError, match=r"table_5\.toml, claim some-id: no formula between backticks in 'none'"):
        formulas(claim("none"))


def test_a_wrong_formula_is_refused_with_its_place():
    with pytest.raises(
        FormulaError, match=r"table_5\.toml, claim some-id, character 4: a number, a name .* not \"\*\""
    ):
        formulas(claim("`a +* b`"))


def test_every_printed_formula_can_be_read():
    documents = [printed(name) for name in names()]
    claims = [
        c for d in documents for c in d.claims.values() if "`" in c.says and ("=" in c.formula or "*" in c.formula)
    ]
    misprints = [m for d in documents for m in d.misprints.values() if m.printed_expr]
    assert len(claims) >= 40 and len(misprints) > 25
    assert all(formulas(c) for c in claims)
    for item in misprints:
        one, other = (read_formula(text, Symbols()) for text in (item.printed_expr, item.corrected_expr))
        assert one != other, f"{item.where}: the correction is the print"
