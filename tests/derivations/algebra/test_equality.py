"""Equalities as they stand against SymPy's own."""

from sympy import Eq, Integral, symbols

from derivations.algebra.equality import both_sides, equality

x, y, t = symbols("x y t")


def test_the_same_equality_as_sympys():
    assert equality(x, y + 1) == Eq(x, y + 1)
    assert hash(equality(x, y)) == hash(Eq(x, y))


def test_true_and_false_stay_equalities():
    """Eq(x, x) is True and Eq(1, 2) False, which have no sides."""
    assert equality(x, x).args == (x, x)
    assert equality(1, 2).args == (1, 2)
    assert both_sides(lambda side: side.subs(x, y), equality(x, y)).args == (y, y)


def test_a_change_of_both_sides_is_the_change_of_the_equality():
    law = equality(x**2 - y, Integral(y * t, (t, 0, x)))
    assert both_sides(lambda side: side.subs(y, 3 * x).doit(), law) == law.subs(y, 3 * x).doit()
