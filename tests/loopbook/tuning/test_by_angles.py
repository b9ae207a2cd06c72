"""PID by angles: the margin asked for is the margin of the loop, and the double tank's four numbers come out."""

from fractions import Fraction
from math import pi

import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from loopbook.documents.open import printed as load
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.tuning.by_angles import parameters, pid
from loopbook.tuning.result import RuleDoesNotApply
from notebook_reports.ledger.verdicts import rounds_to

TANK = Process([1 / 8360], [35, 12, 1], 2)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.05, 0.6), st.floats(0.4, 1.4), st.floats(0.3, 1.2), st.floats(0.005, 0.2))
def test_the_loop_has_the_margin_and_the_crossover_asked_for(w, margin, zero, pole):
    try:
        found = pid(TANK, w, margin, zero, pole)
    except RuleDoesNotApply:
        assume(False)
    loop = Loop(TANK, found)
    value = complex(loop.transfer(1j * w))
    assert abs(value) == pytest.approx(1, rel=1e-10)
    assert abs((value + complex(sympy.N(sympy.exp(sympy.I * margin)))).real) < 1e-9


@pytest.mark.parametrize("name", ["P", "I", "D", "N"])
def test_double_tank_table_4(name):
    """All 14 or 15 digits of the fine-tuned parameters from one free number."""
    found = parameters(TANK, Fraction("0.2504428317393442"), sympy.pi / 3, sympy.pi / 4, Fraction(7, 800))
    assert rounds_to(found[name], load("double-tank").values[f"tuned-{name}"].printed)


def test_what_one_zero_cannot_give_is_refused():
    with pytest.raises(RuleDoesNotApply, match=r"phase margin of 60 degrees at 1.2 rad/s asks for the angle"):
        pid(TANK, 1.2, pi / 3)
