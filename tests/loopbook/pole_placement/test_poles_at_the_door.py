"""Wanted poles of every type that people have, and what is no pole, for every placement."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import sympy

from loopbook.controllers.rst import PlacementError
from loopbook.pole_placement.place import place
from loopbook.pole_placement.state_feedback import observer, state_feedback
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process

SAMPLED, LAG = sample(Process([1], [5, 1]), 1.0), Process([2], [1, 3, 0])
HALVES = [0.5, np.float32(0.5), Fraction(1, 2), Decimal("0.5"), sympy.Rational(1, 2), np.array(0.5), 0.5 + 0j]


@pytest.mark.parametrize("half", HALVES, ids=lambda half: type(half).__name__)
def test_poles_of_every_type(half):
    assert place(SAMPLED, half).regulator == place(SAMPLED, 0.5).regulator
    assert place(SAMPLED, np.array([half, 0.25], dtype=object)).regulator == place(SAMPLED, [0.5, 0.25]).regulator
    assert (
        place(SAMPLED, [half, 0.25], observer=half).regulator == place(SAMPLED, [0.5, 0.25], observer=[0.5]).regulator
    )
    assert place(LAG, [-half, -2, -3, -3]).regulator == place(LAG, [-0.5, -2, -3, -3]).regulator
    found = state_feedback([[0, 1], [3, 2]], [0, 1], [-half, -1])
    assert np.ravel(np.asarray(found, dtype=float)).tolist() == [3.5, 3.5]


@pytest.mark.parametrize("bad", ["0.5", None, np.nan, 1j, [0.5], object()], ids=lambda bad: type(bad).__name__)
def test_what_is_no_pole_is_refused(bad):
    doors = (
        lambda: place(SAMPLED, [bad, 0.5]),
        lambda: place(SAMPLED, [0.5, 0.5], observer=[bad]),
        lambda: place(LAG, [bad, -1, -1, -1]),
        lambda: state_feedback([[0, 1], [3, 2]], [0, 1], [bad, -1]),
        lambda: observer([[0, 1], [3, 2]], [1, 0], [bad, -1]),
    )
    for door in doors:
        with pytest.raises(PlacementError) as caught:
            door()
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 260


def test_a_pole_without_its_conjugate():
    for door in (lambda: place(SAMPLED, [0.5 + 0.1j, 0.5]), lambda: place(LAG, [-1 + 1j, -1, -1, -1])):
        with pytest.raises(PlacementError, match="conjugate pairs"):
            door()
    pair = [sympy.Rational(-1) + sympy.I, -1 - sympy.I]
    assert state_feedback([[0, 1], [3, 2]], [0, 1], pair) == (5, 4)
    assert state_feedback([[0, 1], [3, 2]], [0, 1], [-1 + 1j, -1 - 1j]) == pytest.approx(np.array([[5.0, 4.0]]))


@pytest.mark.parametrize("one", [1, np.int64(1), np.uint8(1), sympy.Integer(1), Fraction(1)])
def test_integrators_are_counted_by_any_whole_number(one):
    assert place(SAMPLED, 0.5, integrators=one).regulator == place(SAMPLED, 0.5).regulator
    for bad in (-1, 0.5, "1", True, None):
        with pytest.raises(PlacementError, match="integrators = "):
            place(SAMPLED, 0.5, integrators=bad)
