"""The same measures for a continuous and a sampled loop."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidParallel
from loopbook.controllers.rst import Rst, with_zeros
from loopbook.documents.double_tank.tank_load import tank_disturbance
from loopbook.loop.comparison import ComparedLoop, turns
from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.pole_placement.numeric import place_numerically
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process

TANK = Process([1 / 8360], [35, 12, 1], 2)


def placed(q, process=TANK, h=1.0):
    B, A = sample(process, h).polynomials
    return SampledLoop(process, place_numerically(B, A, with_zeros([q] * 3), h).regulator)


def test_a_fast_sampled_loop_measures_like_the_continuous_one():
    process = Process.fopdt(1, 5, 1)
    pid = PidParallel(1.5, 0.3)
    h = 0.05
    sampled = Rst((1, -1), (1.5 + 0.3 * h, -1.5), (1.5 + 0.3 * h, -1.5), h)
    slow, fast = ComparedLoop("c", Loop(process, pid), 40.0), ComparedLoop("s", SampledLoop(process, sampled), 40.0)
    assert fast.step.rise == pytest.approx(slow.step.rise, rel=0.05)
    assert fast.disturbance_peak == pytest.approx(slow.disturbance_peak, rel=0.05)
    assert fast.disturbance_iae == pytest.approx(slow.disturbance_iae, rel=0.05)
    assert fast.margins.Ms.value == pytest.approx(slow.margins.Ms.value, rel=0.05)
    assert fast.back_within(0.02) == pytest.approx(slow.back_within(0.02), rel=0.05)


def test_metrics_between_the_samples_of_pole_placement():
    """q = 0.5: dead beat in nothing but without overshoot, the input a staircase that starts with K_r."""
    one = ComparedLoop("q", placed(0.5), 80.0, tank_disturbance(TANK))
    t = np.linspace(0, 80, 8001)
    y = one.reference[0](t)
    assert one.step.rise == pytest.approx(t[y > 0.9][0] - t[y > 0.1][0], abs=0.02)
    assert one.step.overshoot < 1e-9
    assert one.peak_input == pytest.approx(one.loop.regulator.T[0])
    assert one.load == pytest.approx(8360)
    assert one.disturbance[1](79.0) == pytest.approx(-8360, rel=1e-6)


def test_one_sample_more_of_dead_time():
    """The two faster designs do not bear it."""
    assert [ComparedLoop("q", placed(q), 80.0).survives(1.0) for q in (0.3, 0.5, 0.7)] == [False, False, True]
    assert [ComparedLoop("q", placed(q), 80.0).regulator_is_stable for q in (0.3, 0.5, 0.7)] == [False, False, True]


def test_turns_of_a_staircase():
    assert turns(np.array([1.0, 2.0, 3.0])) == 0
    assert turns(np.array([1.0, 3.0, 2.0, 2.5])) == 2
    assert turns(np.array([1.0, 3.0, 2.99, 4.0]), threshold=0.1) == 0
