"""A PID controller by its angles: the partial fractions are the controller, and its phase is the sum of the angles."""

import cmath

import pytest
import sympy as sp
from sympy import Rational

from derivations.tuning import pid_by_angles as by

POINT = {by.w: Rational(3, 10), by.k: 5, by.f: sp.pi / 4, by.b: sp.pi / 3, by.a: sp.pi / 12}


def test_partial_fractions_are_the_controller():
    P, I, D, N = (by.parallel()[name].subs(POINT) for name in "PIDN")
    difference = P + I / by.s + D * N * by.s / (by.s + N) - by.controller().subs(POINT)
    for point in (Rational(1, 7), 2 + sp.I, -3 * sp.I):
        assert abs(sp.N(difference.subs(by.s, point), 30)) < 1e-25


def test_magnitude_and_phase_at_the_crossover_frequency():
    value = complex(sp.N(by.controller().subs(POINT).subs(by.s, sp.I * POINT[by.w]), 30))
    assert abs(value) == pytest.approx(5, rel=1e-14)
    angle = POINT[by.f] + POINT[by.b] - POINT[by.a] - sp.pi / 2
    assert cmath.phase(value) == pytest.approx(float(angle), rel=1e-14)


def test_the_lead_that_a_phase_margin_asks_for():
    left = by.phase + by.f + by.lead() - by.a - sp.pi / 2
    assert sp.simplify(left + sp.pi - by.margin) == 0
