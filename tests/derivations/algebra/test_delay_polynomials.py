"""Polynomials in z^-1: back and forth, forms kept as written, refusals."""

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derivations.algebra.delay_polynomials import (
    DelayPolynomialError,
    Z,
    coefficients,
    difference_equation,
    in_delays,
    polynomial,
)

a, b = sp.symbols("a b")
exact = st.fractions(max_denominator=50).map(lambda f: sp.Rational(f.numerator, f.denominator))


@given(st.lists(exact, max_size=6))
@pytest.mark.long
def test_there_and_back(values):
    found = coefficients(polynomial(values))
    assert found == values[: len(found)]
    assert all(v == 0 for v in values[len(found) :])


def test_coefficients_stay_as_written_and_symbolic_denominators_work():
    gain = (a - b) / (a + b)
    assert coefficients(1 + gain / Z**2) == [1, 0, gain]
    assert sp.cancel(coefficients((1 + 1 / (Z * (a + b))) * (1 - a / Z))[2] + a / (a + b)) == 0


def test_in_delays_of_the_document_s_transfer_function():
    A, B = in_delays((2 * Z + 3) / (Z**4 + a * Z**3 + b * Z**2))
    assert sp.expand(A - (1 + a / Z + b / Z**2)) == 0
    assert sp.expand(B - (2 / Z**3 + 3 / Z**4)) == 0


def test_difference_equation_needs_a_leading_one():
    with pytest.raises(DelayPolynomialError, match=r"must start with 1 to be solved for y\(k\), not 2"):
        difference_equation(("y", 2 + a / Z), {"u": b / Z})


@pytest.mark.parametrize(
    "expression, text", [(Z, "not in z"), (1 / (1 + Z), "polynomial"), (sp.sqrt(Z), "polynomial"), (0.1 / Z, "'0.1'")]
)
def test_refusals(expression, text):
    with pytest.raises(DelayPolynomialError, match=text):
        coefficients(expression)


def test_future_inputs_are_refused():
    with pytest.raises(DelayPolynomialError, match="needs future inputs"):
        in_delays(Z**2 / (Z + 1))
