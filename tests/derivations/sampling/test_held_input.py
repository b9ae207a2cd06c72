"""A held input by staircase and integral: each step follows from the one before, the end also from the general way."""

import sympy as sp

from derivations.algebra.delay_polynomials import coefficients
from derivations.algebra.differences import at, by_signals, h, t
from derivations.pid.pid_laws import u, y
from derivations.sampling import held_input, zero_order_hold
from derivations.sampling.held_input import K, T


def test_the_weighted_law_is_the_law():
    (product, slope), law = held_input.weighted(), held_input.law()
    gap = (product.rhs.diff(t) - slope.rhs) * T * sp.exp(-t / T) - (law.lhs - law.rhs)
    assert sp.simplify(gap) == 0


def test_the_recursion_solves_the_law_for_a_held_input():
    start, level = sp.symbols("start level")
    end = held_input.recursion().rhs.subs({at("y"): start, at("u"): level})
    moves = end.subs(h, t)  # where the output is a time t after the sample
    law = (held_input.law().lhs - held_input.law().rhs).subs({u(t): level}).subs(y(t), moves).doit()
    assert sp.simplify(law) == 0
    assert sp.simplify(moves.subs(t, 0) - start) == 0


def test_it_is_what_the_general_way_gives():
    sampled = zero_order_hold.zero_order_hold(K / (1 + T * zero_order_hold.S), h)
    gains = by_signals(held_input.recursion().rhs)
    assert sp.simplify(coefficients(sampled.A, "A")[1] + gains[at("y")]) == 0
    assert sp.simplify(coefficients(sampled.B, "B")[1] - gains[at("u")]) == 0


def test_the_forward_difference_has_the_first_terms_of_the_series():
    exact, forward = (by_signals(f().rhs) for f in (held_input.recursion, held_input.by_forward_difference))
    for sample, gain in forward.items():
        assert sp.expand(gain - exact[sample].series(h, 0, 2).removeO()) == 0
    assert held_input.kept(2) == 1 - h / T + h**2 / (2 * T**2)


def test_the_area_is_the_integral():
    area = held_input.area()
    assert sp.simplify(area.lhs.doit() - area.rhs) == 0
