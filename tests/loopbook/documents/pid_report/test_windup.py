"""Saturation studies: what each method of anti-windup, transfer and change does to a loop."""

import numpy as np
import pytest

from loopbook.documents.pid_report import windup


def test_without_anti_windup_the_integral_runs_away_and_recovery_takes_long():
    (bare, I), (tracked, J) = windup.unreachable("none"), windup.unreachable("tracking")
    assert I[149] > 10 * J[149]
    assert windup.recovery(bare) > 2 * windup.recovery(tracked)


@pytest.mark.parametrize("rule", ["tracking", "conditional", "conditional-safe", "clamping"])
def test_every_method_prevents_it(rule):
    run, I = windup.unreachable(rule)
    assert abs(I[149]) <= 2.0
    assert windup.recovery(run) < 7
    assert windup.integrating(rule).y.max() < 10.6 < windup.integrating("none").y.max()


def test_one_false_sample_throws_the_integral_by_h_over_tt():
    """The change of I is h/Tt (u - v); what e adds is K h/Ti times the false error."""
    for Tt in (0.1, 0.3, 2.0):
        _, I = windup.spike("tracking", Tt=Tt)
        s = windup.settings()
        p2 = s.K + s.K * s.Td / (s.Tf + s.h)
        v = 1.0 - p2 * 1.0
        expected = I[9] - s.K * s.h / s.Ti + s.h / Tt * (0.0 - v)
        assert np.isclose(I[10], expected)
    _, I = windup.spike("conditional")
    assert I[10] == I[9]


def test_figure_4_7_locks_up_after_a_plain_step():
    printed, integral = windup.locked("4.7")
    assert printed.u[-200:].min() == 1.0
    assert printed.y[-1] > 0.99  # the set-point is 0.8
    assert np.ptp(integral[-200:]) == 0
    assert abs(windup.locked("conditional-safe")[0].y[-1] - 0.8) < 1e-5


def test_transfer():
    s = windup.settings()
    assert windup.transfer("exact", 0.5) == 0
    assert np.isclose(windup.transfer("tracking", 0.5), s.K * s.Tt / s.Ti * 0.5)


@pytest.mark.parametrize("new", [{"K": 5.0}, {"Td": 0.8}, {"Tf": 0.3}, {"b": 0.5}, {"Ti": 1.0}])
def test_changes_in_a_steady_loop(new):
    exact, _ = windup.change("exact", new)
    assert abs(exact.y - 1).max() < 1e-9
    printed, _ = windup.change("integral", new)
    s, after = windup.settings(), windup.settings(**new)
    jump = (s.K * s.Td / (s.Tf + s.h) - after.K * after.Td / (after.Tf + after.h)) * 1.0
    assert np.isclose(printed.u[10] - printed.u[9], jump)


def test_tracking_time_of_a_pi_controller():
    """0.5 Ti = 1 s recovers nearly as fast as the best; from Ti on the integral is still full when it matters."""
    recovery = {Tt: windup.recovery_of_pi(Tt) for Tt in np.linspace(0.1, 4, 40).round(1)}
    assert min(recovery.values()) <= recovery[1.0] <= 1.15 * min(recovery.values())
    assert min(recovery[Tt] for Tt in recovery if Tt >= 2) > 1.3 * recovery[1.0]
    later = [recovery[Tt] for Tt in recovery if Tt >= 2]
    assert later == sorted(later)
