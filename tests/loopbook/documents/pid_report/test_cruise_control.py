"""The report's car: where it rests, how it swings, and that its runs are what their names say."""

import math

import numpy as np
import pytest

from loopbook.documents.pid_report import cruise_control as cruise
from loopbook.documents.pid_report.looking_ahead import noise_gain, predict, swing


def test_a_hill_slows_a_fixed_throttle_and_not_a_controlled_one():
    """0.8 V less at 10 km/h per volt: 82 km/h; feedback returns to 90."""
    assert abs(cruise.uphill(10.0, 0.1, True).y[-1] - (82 + 8 * math.exp(-6.0))) < 0.01
    assert abs(cruise.uphill(10.0, 0.1, False).y[-1] - 90) < 0.05


def test_on_off_swings_by_its_dead_time():
    """With the dead time L the top is 200 - 150 exp(-L/T), the bottom 50 exp(-L/T), up to one sample."""
    top, bottom = 200 - 150 * math.exp(-0.1), 50 * math.exp(-0.1)
    s = cruise.on_off(10.0, 0.01, 1.0)
    assert abs(s.highest - top) < 0.2
    assert abs(s.lowest - bottom) < 0.2


def test_settling_is_the_last_time_outside():
    run = cruise.set_point_and_hill(10.0, 0.1, 10.0)
    end = cruise.settling(run, 90.0)
    assert abs(run.y[run.t >= end] - 90).max() <= 1.0
    assert abs(run.y[run.t < end][-1] - 90) > 1.0


def test_weighted_runs_start_at_rest():
    for b in (0.0, 0.5, 1.0):
        run = cruise.weighted(10.0, 0.1, b)
        assert np.allclose(run.y[:100], 50.0)
        assert abs(run.y[-1] - 60.0) < 0.05


@pytest.mark.parametrize("Td", [0.0, 0.3])
def test_scaling_all_times_changes_nothing(Td):
    assert np.allclose(cruise.scaled(0.1, 1.0, Td), cruise.scaled(0.1, 7.0, Td), atol=1e-12)


def test_prediction_of_a_clean_signal_is_the_tangent():
    p = predict(0.5, h=0.001)
    slope = -(swing(p.t) / 4) - np.exp(-p.t / 4) * np.sin(p.t)
    assert np.allclose(p.predicted, swing(p.t) + 0.5 * slope, atol=1e-3)


def test_noise_gain_is_what_noise_does():
    quiet, loud = (predict(1.0, noise=s, end=2000.0).predicted for s in (0.0, 0.02))
    assert abs(np.std(loud - quiet) / 0.02 / noise_gain(1.0, 0.05) - 1) < 0.02
