"""Placed loops: the printed performance to the fourth decimal, poles of the loop and of the regulator itself."""

from fractions import Fraction as F

import numpy as np
import pytest

from loopbook.documents.double_tank.pole_tables import MEASURES, parameters, performance, printed_only
from loopbook.documents.open import printed as load
from loopbook.loop.sampled import SampledLoop
from loopbook.pole_placement.exact_placement import place_poles
from loopbook.pole_placement.sampled_plant import sample_two_lags
from loopbook.process.transfer_function import Process
from loopbook.response.step_metrics import sampled_metrics
from notebook_reports.ledger.verdicts import rounds_to

DOCUMENT = load("double-tank")
PLANT = sample_two_lags(5, 7, F(1, 8360), 2, 1)
PROCESS = Process.fopdt(1 / 8360, 5.0, 0.0) * Process.fopdt(1.0, 7.0, 2.0)
POLES = (0.3, 0.5, 0.7)
TIMES = range(1, 71)


@pytest.fixture(scope="module", params=["exact", "rounded"])
def loops(request):
    plant = PLANT if request.param == "exact" else PLANT.rounded()
    return {q: place_poles(plant, q) for q in POLES}


@pytest.mark.parametrize("q", POLES)
@pytest.mark.parametrize("measure", MEASURES)
def test_performance_table(loops, q, measure):
    """All twelve numbers, from the exact plant and from the rounded one."""
    found = performance({q: loops[q].step(70, exact=True)["y"]}, TIMES)[f"{measure}-q{q}"]
    assert rounds_to(found, DOCUMENT.values[f"{measure}-q{q}"].printed)


def test_a_changed_regulator_does_not_give_the_table():
    """One unit more in the fifth digit of d_1 is seen in the fourth decimal."""
    loop = place_poles(PLANT.rounded(), 0.5)
    loop.parameters["d_1"] += 100
    changed = sampled_metrics(loop.step(70)["y"], TIMES)
    assert not rounds_to(changed.settling, DOCUMENT.values["settling-q0.5"].printed)


def test_every_cell_of_the_two_tables_is_computed(loops):
    found = parameters(loops) | performance({q: [0, 1, 1] for q in POLES}, [1, 2, 3])
    places = ("Table 4 (regulator parameters)", "Table 5")
    assert set(found) == {i for i, v in DOCUMENT.values.items() if v.place in places}
    assert printed_only(found | {"other": 1}, DOCUMENT) == found


def test_floats_follow_the_fractions(loops):
    for loop in loops.values():
        fast, exact = loop.step(70)["u"], loop.step(70, exact=True)["u"]
        assert np.array(fast) == pytest.approx(np.array(exact, dtype=float), rel=1e-11)


def test_the_real_loop_has_the_poles_asked_for():
    for q in POLES:
        loop = SampledLoop(PROCESS, place_poles(PLANT, q).rst)
        characteristic = np.poly(loop.poles)[:4]
        assert characteristic == pytest.approx(np.poly([q] * 3), abs=1e-9)


def test_recursion_and_continuous_process_agree_at_the_samples():
    for q in POLES:
        loop = place_poles(PLANT, q)
        alone, real = loop.step(70), SampledLoop(PROCESS, loop.rst).step("reference", 69)
        assert real.y == pytest.approx(np.array(alone["y"]), abs=1e-10)
        assert real.u == pytest.approx(np.array(alone["u"]), rel=1e-8)


def test_power_at_the_end_with_rounded_and_with_exact_coefficients():
    rounded = place_poles(PLANT.rounded(), 0.5)
    assert rounded.step(70)["u"][-1] == pytest.approx(8209.2137, abs=1e-4)
    assert rounded.step(70, plant=PLANT)["u"][-1] == pytest.approx(8360, abs=1e-4)


def test_the_regulators_for_03_and_05_are_unstable_by_themselves():
    radius = {q: place_poles(PLANT, q) for q in POLES}
    assert [loop.regulator_radius > 1 for loop in radius.values()] == [True, True, False]
    assert [loop.rst.is_stable for loop in radius.values()] == [False, False, True]
    assert place_poles(PLANT, "0.5634").regulator_radius > 1 > place_poles(PLANT, "0.5635").regulator_radius


def test_margins_of_the_recommended_loop_by_a_second_route():
    """The loop is on the border where the added delay is the delay margin, and where the gain is a gain margin."""
    loop = SampledLoop(PROCESS, place_poles(PLANT, 0.5).rst)
    m = loop.margins()
    for border in (loop.with_delay(m.delay), loop.with_gain(m.gain), loop.with_gain(m.gain_low)):
        assert abs(border.poles).max() == pytest.approx(1, abs=1e-9)
    assert (m.delay, m.gain_low, m.gain) == pytest.approx((0.3629, 0.2760, 1.4374), abs=1e-4)
