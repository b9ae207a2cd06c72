"""Step metrics of everything that has a step response; MATLAB's printed example in both conventions."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.general import GeneralLoop
from loopbook.loop.smith import SmithLoop
from loopbook.loop.step_info import step_info
from loopbook.process.transfer_function import Process

MATLAB = Process([1, 5, 5], [1, 1.65, 5, 6.5, 2])


def test_the_example_of_matlab_s_page():
    """stepinfo: rise 3.8456, settling 27.9762, overshoot 7.4915, peak 2.6873 at the 92nd of its samples, 8.0530."""
    found = step_info(MATLAB, np.arange(400) * (8.0530 / 92), convention="sampled")
    printed = (3.8456, 27.9762, 7.4915, 2.6873, 8.0530)
    values = (found.rise, found.settling, found.overshoot, found.peak, found.peak_time)
    assert values == pytest.approx(printed, abs=5.1e-5) and found.final == pytest.approx(2.5)


def test_the_same_exactly():
    found = step_info(MATLAB)
    assert (found.rise, found.settling, found.overshoot) == pytest.approx((3.84342, 27.98009, 7.51299), abs=5.1e-6)


def test_loops_and_sums_of_every_kind():
    P, C = Process([2], [10, 1], 3), PidStandard(0.8, 10)
    loop = Loop(P, C)
    expected = step_info(loop)
    for other in (GeneralLoop(P, C), loop.closed(), loop.step()):
        found = step_info(other)
        for name in ("rise", "settling", "overshoot", "peak", "peak_time", "final"):
            assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-9), name
    right = step_info(SmithLoop(P, C))
    assert right.settling == pytest.approx(3 + np.log(50) / 0.16, rel=1e-9), "a lag of 1/0.16 s behind the dead time"
    two = step_info(Process([1], [10, 1], 3) + Process([1], [10, 1], 5))
    assert two.final == 2 and two.settling == pytest.approx(10 * np.log(25 * (np.exp(0.3) + np.exp(0.5))), rel=1e-9)
    with pytest.raises(ValueError, match="not on the left"):
        step_info(Process([1], [10, 0], 3) + 1)


def test_samples_see_the_rise_before_a_slow_creep():
    """At Ti = 1000 s and longer the loop overshoots within a second and creeps for hours; both conventions say so."""
    for Ti in (1e2, 1e3, 1e5, 1e7):
        loop = Loop(Process([25], [1, 2, 1]), PidStandard(1, Ti))
        exact, sampled = step_info(loop), step_info(loop, convention="sampled")
        assert exact.overshoot == pytest.approx(47.46, abs=0.3) and sampled.overshoot == pytest.approx(
            exact.overshoot, abs=0.05
        )
        assert sampled.rise == pytest.approx(exact.rise, rel=1e-3)
        assert sampled.settling == pytest.approx(exact.settling, rel=1e-5)


@pytest.mark.parametrize("num, den", [([3, 1], [2, 1]), ([1.3, 1], [1, 1]), ([1.9, 1], [1, 1])])
def test_samples_of_a_system_that_jumps_start_from_rest(num, den):
    exact, sampled = step_info(Process(num, den)), step_info(Process(num, den), convention="sampled")
    for name in ("rise", "settling", "overshoot", "undershoot", "peak"):
        assert getattr(sampled, name) == pytest.approx(getattr(exact, name), rel=1e-4, abs=1e-9), name


@pytest.mark.parametrize("delay", [0.0, 3.0])
def test_a_gain_alone_is_there_at_once(delay):
    found = step_info(Process([2], [1], delay))
    values = (found.rise, found.settling, found.overshoot, found.peak, found.peak_time)
    assert values == pytest.approx((0.0, delay, 0.0, 2.0, delay), rel=1e-12)
