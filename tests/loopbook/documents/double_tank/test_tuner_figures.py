"""What a tuning tool shows: double-tank's Table 3, and how many of its cells a structure gives."""

import math

import pytest

from loopbook.controllers.pid_forms import PidParallel
from loopbook.documents.double_tank.tuner_figures import SHOWN, agreeing, displayed, reached, structures
from loopbook.documents.open import printed as load
from loopbook.experiments.data import FrequencyData
from loopbook.loop.continuous import Loop
from loopbook.loop.margins import phase_crossovers
from loopbook.process.transfer_function import Process
from loopbook.tuning import tune
from notebook_reports.ledger.verdicts import rounds_to

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


@pytest.mark.long
def test_no_structure_with_the_four_good_cells_of_ziegler_and_nichols_gives_the_other_two():
    """What the ledger says of the two cells that differ, and by how much."""
    values, given = load("double-tank").values, printed("zn")
    gain, w = 10 ** (float(values["gain-margin-of-plant"].printed) / 20), float(values["crossover-of-plant"].printed)
    point = phase_crossovers(Loop(TANK, 1.0).transfer)[0]
    settings = [
        tune(FrequencyData.from_ultimate(*data), "zn-ultimate-pid").pid
        for data in ((gain, 2 * math.pi / w), (point.gain, 2 * math.pi / point.w))
    ]
    poles = float(values["zn-filter"].printed), float(values["tuned-N"].printed)
    tried = {name: displayed(Loop(TANK, pid)) for name, pid in structures(*settings, *poles).items()}
    odd = {name: given[name] for name in ("settling", "overshoot")}
    good = {name: digits for name, digits in given.items() if name not in odd}
    fitting = [found for found in tried.values() if agreeing(found, good) == len(good) == 4]
    assert len(tried) == 7 and fitting and all(agreeing(found, odd) == 0 for found in fitting)
    first = next(iter(tried.values()))
    assert first in fitting
    assert round(first["settling"] - float(odd["settling"]), 2) == 0.06
    assert round(first["overshoot"] - float(odd["overshoot"]), 2) == -0.08


@pytest.mark.long
def test_readings_that_round_to_the_printed_ones_reach_the_print_and_not_the_next_digit():
    for overshoot, comes in (("39.6", True), ("39.7", False), ("39.3", False)):
        found = reached(TANK, 10 ** (95 / 20), "0.402", 100.0, printed("zn") | {"overshoot": overshoot})
        assert rounds_to(found["overshoot"], overshoot) == comes
