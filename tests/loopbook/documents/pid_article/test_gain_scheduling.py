"""Scheduled settings on the square-root plant: settings, stability and responses."""

from fractions import Fraction

import numpy as np
import pytest

from loopbook.documents.pid_article.gain_scheduling import (
    Schedule,
    ScheduleError,
    closed_loop,
    crossing,
    local_model,
    open_loop,
    overshoots,
)

SETTINGS = [("2.88", "1.1", "0.275"), ("1.2988", "1.7", "0.425"), ("1.1114", "1.95", "0.4875")]
EXACT = [tuple(map(Fraction, row)) for row in SETTINGS]
STAIRS = [(0, 1.0), (15, 2.0), (30, 3.0)]
SETPOINTS = [(0, 1.0), (15, 4.0), (30, 9.0)]


def test_steady_states_are_squares_of_the_input():
    for level in (0.5, 1.0, 3.0):
        assert open_loop([(0, level)], 40 * (1 + level)).y[-1] == pytest.approx(level**2, rel=1e-6)


def test_negative_input_leaves_the_real_numbers_alone():
    run = open_loop([(0, 1.0), (10, -1.0)], 20)
    assert np.isfinite(run.y).all() and run.y[-1] < 0


@pytest.mark.parametrize(
    "part, after, low, high, printed",
    [(0.283, 0, 0, 1, "0.99"), (0.283, 15, 1, 4, "16.77"), (0.632, 15, 1, 4, "18.61"), (0.632, 30, 4, 9, "35.49")],
)
def test_crossings_are_the_printed_readings(part, after, low, high, printed):
    found = crossing(STAIRS, low + part * (high - low), after)
    assert f"{found:.2f}" == printed


def test_level_that_is_never_reached_is_named():
    with pytest.raises(ScheduleError, match="does not reach 12"):
        crossing(STAIRS, 12.0, 30)


def test_parabolas_pass_through_their_settings():
    schedule = Schedule.parabolas((1, 4, 9), EXACT)
    for output, row in zip((1, 4, 9), SETTINGS, strict=True):
        assert schedule.at(output) == pytest.approx(tuple(map(float, row)), rel=1e-12)


@pytest.mark.parametrize("outputs", [(1, 4), (1, 1, 4)])
def test_parabola_needs_three_different_outputs(outputs):
    with pytest.raises(ScheduleError, match="three different outputs"):
        Schedule.parabolas(outputs, EXACT)


def test_each_fixed_setting_is_stable_at_every_operating_point():
    for row in SETTINGS:
        fixed = Schedule.fixed(*map(float, row))
        assert all(fixed.is_stable(y) for y in np.geomspace(1e-6, 1e6, 25))


@pytest.mark.parametrize("structure", ["inside", "outside"])
def test_linear_poles_are_those_of_a_small_nonlinear_response(structure):
    """Samples of a sum of three modes obey a recursion whose roots are exp(pole * interval)."""
    schedule, interval = Schedule.parabolas((1, 4, 9), EXACT), 0.3
    run = closed_loop(schedule, [(0, 4.0), (60, 4.001)], 75, structure, "measurement", points=7500)
    e = run.between(60, 72).y[:: round(interval / 0.01)] - 4.001
    past = np.column_stack([e[2:-1], e[1:-2], e[:-3]])
    recursion = np.linalg.lstsq(past, e[3:], rcond=None)[0]
    found = np.log(np.roots([1, *-recursion]).astype(complex)) / interval
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(schedule.poles(4.0, structure)), rel=0.02)


def test_extrapolated_start_values_make_the_integral_time_negative_and_the_loop_diverge():
    schedule = Schedule.parabolas((0, 1, 4), EXACT)
    assert schedule.at(7.0)[1] < 0 < schedule.at(6.0)[1]
    assert not schedule.is_stable(7.0)
    run = closed_loop(schedule, SETPOINTS, 45)
    assert run.diverged and 30 < run.t[-1] < 45


def test_both_structures_are_one_for_fixed_settings():
    fixed = Schedule.fixed(2.88, 1.1, 0.275)
    a, b = (closed_loop(fixed, SETPOINTS, 45, structure, points=900) for structure in ("inside", "outside"))
    assert np.abs(a.y - b.y).max() < 1e-6


def test_derivative_on_the_error_kicks_the_rate_at_the_step():
    fixed = Schedule.fixed(2.0, 4.0, 0.5)
    kicked, smooth = (closed_loop(fixed, [(0, 1.0)], 5, derivative=d).v[0] for d in ("error", "measurement"))
    assert (kicked, smooth) == (1.0, 0.0)


def test_final_value_is_the_set_point():
    run = closed_loop(Schedule.fixed(1.2988, 1.7, 0.425), [(0, 4.0)], 80)
    assert run.y[-1] == pytest.approx(4.0, abs=1e-3)
    assert run.u[-1] == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize(
    "arguments, words",
    [
        ({"structure": "between"}, "one of inside, outside"),
        ({"derivative": "noise"}, "one of error, measurement"),
        ({"steps": [(1, 1.0)]}, "increasing times from 0"),
        ({"steps": [(0, 1.0), (50, 2.0)]}, "must lie after the last step"),
    ],
)
def test_wrong_questions_are_named(arguments, words):
    call = {"steps": SETPOINTS, "horizon": 45} | arguments
    with pytest.raises(ScheduleError, match=words):
        closed_loop(Schedule.fixed(1, 1, 0), **call)


def test_local_model_of_the_second_step_is_close_to_the_printed_one():
    model = local_model(1.0, 2.0)
    assert (model.Kp, model.T, model.L) == pytest.approx((3.0, 2.76, 0.85), abs=0.01)
    with pytest.raises(ScheduleError, match="must rise and start at 0"):
        local_model(2.0, 1.0)


def test_overshoots_are_per_step_and_infinite_where_the_run_is_lost():
    calm = closed_loop(Schedule.fixed(1.1114, 1.95, 0.4875), SETPOINTS, 45)
    first, second, third = overshoots(calm, SETPOINTS)
    assert first == pytest.approx(0.0, abs=0.1) and 10 < second < 20 and 20 < third < 30
    lost = closed_loop(Schedule.parabolas((0, 1, 4), EXACT), SETPOINTS, 45)
    assert overshoots(lost, SETPOINTS)[2] == np.inf and np.isfinite(overshoots(lost, SETPOINTS)[:2]).all()
