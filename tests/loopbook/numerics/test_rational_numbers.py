"""Decimals as written, fractions that stay fractions."""

from fractions import Fraction as F

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from loopbook.numerics.rational_numbers import decimal, function, rational

x, y = sp.symbols("x y")


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_decimal_reads_back(value):
    assert float(decimal(value)) == value


def test_decimal_is_what_was_written_not_what_is_stored():
    assert decimal(0.1) == F(1, 10) != F(0.1)


def test_rational_of_an_irrational_number_to_the_digits_asked():
    assert abs(rational(sp.pi, 50) - rational(sp.pi, 60)) < F(1, 10**48)
    assert rational(sp.Rational(2, 7)) == F(2, 7)


@given(st.fractions(max_denominator=99), st.fractions(min_value=F(1, 9), max_denominator=99))
def test_function_is_exact(p, q):
    expression = (x**2 / 3 - sp.Rational(1, 7) * y) / y**2 + x / y + 5
    got = function([x, y], expression)(p, q)
    assert isinstance(got, F)
    assert got == (p * p / 3 - q / 7) / q**2 + p / q + 5


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: decimal(float("nan")), "not a finite number"),
        (lambda: rational(x + 1), r"has no value before \['x'\]"),
        (lambda: rational(sp.I), "not a finite real number"),
    ],
)
def test_refusals(call, text):
    with pytest.raises(ValueError, match=text):
        call()
