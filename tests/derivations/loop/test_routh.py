"""Routh's array against the roots, and the ultimate point against the frequency response."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derivations.loop import routh
from derivations.loop.routh import NoUltimateGain, s

THIRD = 2 * s**3 + 5 * s**2 + 2 * s + 1


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-9, 9), min_size=2, max_size=6), st.integers(1, 9))
def test_the_array_agrees_with_the_roots(coefficients, leading):
    roots = np.roots([leading, *coefficients])
    if abs(roots.real).min() < 1e-6:
        return
    polynomial = sp.Poly([leading, *coefficients], s).as_expr()
    assert routh.is_stable(polynomial) == bool((roots.real < 0).all())


def test_a_zero_in_the_first_column_is_named():
    with pytest.raises(ZeroDivisionError, match=r"zero above the row of s\*\*1"):
        routh.array(s**3 + s)
    assert not routh.is_stable(s**3 + s)


def test_condition_of_the_third_order_plant_is_four_thirds():
    column = routh.first_column(routh.closed_loop(sp.Integer(3), THIRD))
    limits = [sp.solve(e, routh.K) for e in column if routh.K in e.free_symbols]
    assert [x for found in limits for x in found if x > 0] == [sp.Rational(4, 3)]


@pytest.mark.parametrize(
    "numerator, denominator",
    [
        (sp.Integer(3), THIRD),
        (sp.Integer(1), (s + 1) ** 3),
        (1 - s, sp.expand((s + 1) ** 3)),
        (sp.Integer(1), (s + 1) ** 4),
    ],
)
def test_the_ultimate_point_lies_where_the_frequency_response_is_minus_one_over_the_gain(numerator, denominator):
    found = routh.ultimate(numerator, sp.expand(denominator))
    value = (found.gain * numerator / denominator).subs(s, sp.I * found.frequency)
    assert sp.simplify(value) == -1
    assert sp.simplify(found.period * found.frequency - 2 * sp.pi) == 0
    characteristic = routh.closed_loop(numerator, sp.expand(denominator))
    below, above = (characteristic.subs(routh.K, found.gain * x) for x in (sp.Rational(99, 100), sp.Rational(101, 100)))
    assert routh.is_stable(below) and not routh.is_stable(above)


def test_two_lags_have_no_ultimate_gain():
    with pytest.raises(NoUltimateGain, match="no positive gain"):
        routh.ultimate(sp.Integer(3), 4 * s**2 + 4 * s + 1)
