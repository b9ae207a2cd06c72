"""What a tuning tool shows: double-tank's Table 3, and how many of its cells a structure gives."""

import pytest

from loopbook.forms import PidParallel
from loopbook.loop import Loop
from loopbook.printed import load
from loopbook.process import Process
from loopbook.tuner_display import SHOWN, agreeing, displayed

TANK = Process([1 / 8360], [35, 12, 1], 2)


def printed(column):
    return {name: load("double-tank").values[f"{name}-{column}"].printed for name in SHOWN}


def tuned():
    return PidParallel(*(float(load("double-tank").values[f"tuned-{n}"].printed) for n in "PIDN"))


def test_all_six_cells_of_the_fine_tuned_column():
    found = displayed(Loop(TANK, tuned()))
    assert agreeing(found, printed("tuned")) == 6


@pytest.mark.parametrize("digit", range(3))
def test_an_altered_parameter_is_noticed(digit):
    """A tenth more of P, I or D and at least two of the six cells go."""
    values = [tuned().P, tuned().I, tuned().D]
    values[digit] *= 1.1
    assert agreeing(displayed(Loop(TANK, PidParallel(*values, tuned().N))), printed("tuned")) <= 4
