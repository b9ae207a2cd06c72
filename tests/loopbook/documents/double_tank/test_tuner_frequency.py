"""The crossover frequencies for which a printed parameter holds: inside it rounds to the print, outside it does not."""

from fractions import Fraction

import pytest
import sympy

from loopbook.documents.double_tank.tuner_frequency import crossover_range
from loopbook.process.transfer_function import Process
from loopbook.tuning.by_angles import parameters
from notebook_reports.ledger.verdicts import rounds_to

TANK = Process([1 / 8360], [35, 12, 1], 2)
ANGLES = (sympy.pi / 3, sympy.pi / 4, Fraction(7, 800))  # of the phase margin, the first zero and the pole


@pytest.mark.parametrize("digits", [4, 6])
def test_the_range_is_that_of_the_printed_digits(digits):
    w = 0.2
    P = float(parameters(TANK, Fraction(w), *ANGLES, digits=40)["P"])
    printed = f"{P:.{digits}g}"
    low, high = crossover_range(TANK, "P", printed, w, *ANGLES)
    assert low < high
    for inside in (low + (high - low) / 100, high - (high - low) / 100):
        assert rounds_to(parameters(TANK, inside, *ANGLES, digits=40)["P"], printed)
    for outside in (low - (high - low) / 100, high + (high - low) / 100):
        assert not rounds_to(parameters(TANK, outside, *ANGLES, digits=40)["P"], printed)
