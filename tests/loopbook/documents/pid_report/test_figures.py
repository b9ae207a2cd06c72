"""The figures and listings of pid-report show what was computed: their curves and rows against it."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from derivations.programs.pid_code import programs
from loopbook.documents.pid_report.batch.figures import joint_circle_figure
from loopbook.documents.pid_report.experiment_figures import double_pulse_figure, relay_figure, step_figure
from loopbook.documents.pid_report.program_listing import listing
from loopbook.documents.pid_report.saturated_sine import saturated_sine
from loopbook.experiments import double_pulse, relay, step
from loopbook.experiments.plant import Plant
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.tuning import migo

PROCESS = Process.fopdt(2, 5, 1)


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def lines(figure, panel=-1):
    return {line.get_label(): line.get_xydata() for line in figure.axes[panel].get_lines()}


def test_the_tangent_of_a_step_has_its_slope_and_meets_the_levels():
    found = step.estimate(step.apply_step(Plant(PROCESS)))
    drawn = lines(step_figure(found, "a step"))
    (t0, y0), (t1, y1) = drawn["steepest tangent"]
    assert (y1 - y0) / (t1 - t0) == pytest.approx(found.marks["slope"])
    assert (y0, y1) == (found.marks["before"], found.marks["after"])
    assert drawn["63 %"][0, 1] == pytest.approx(y0 + (1 - np.exp(-1)) * (y1 - y0))


def test_the_marks_of_a_double_pulse_lie_on_its_record():
    found = double_pulse.estimate(double_pulse.apply_double_pulse(Plant(PROCESS), 5.0))
    extremes = lines(double_pulse_figure(found, "a double pulse"))["extremes"]
    on_record = np.interp(extremes[:, 0], found.record.time, found.record.y)
    assert extremes[:, 1] == pytest.approx(on_record, abs=1e-3)


def test_the_amplitude_of_a_relay_bounds_its_oscillation():
    found = relay.estimate(relay.apply_relay(Plant(PROCESS)))
    drawn = lines(relay_figure(found, "a relay"))
    top, bottom = drawn["amplitude"][0, 1], drawn["_"][0, 1]
    late = found.record.y[found.record.time >= found.marks["start"]]
    assert (bottom, top) == (pytest.approx(late.min(), rel=0.08), pytest.approx(late.max(), rel=0.08))


def test_optimal_loops_touch_the_joint_circle():
    optimum = migo.pi(PROCESS, 1.4)
    figure = joint_circle_figure(PROCESS, {"PI": optimum.pid}, 1.4, "touches")
    circle = figure.axes[0].patches[0]
    curve = lines(figure, 0)["PI"]
    distance = np.hypot(curve[:, 0] - circle.center[0], curve[:, 1] - circle.center[1])
    assert distance.min() == pytest.approx(circle.radius, rel=1e-4)
    assert Loop(PROCESS, optimum.pid).margins().Ms.value <= 1.4 + 1e-6


def test_a_listing_has_every_assignment_once_in_the_order_it_runs():
    program = programs()["4.13"]
    rows = listing(program).rows
    assert len(rows) == len(program.gains) + len(program.before) + len(program.after)
    assert [r[0] for r in rows] == sorted((r[0] for r in rows), key=[*dict.fromkeys(r[0] for r in rows)].index)


def test_the_saturated_controller_keeps_its_limits_and_equals_the_free_output_between_them():
    t, v, u = saturated_sine(0.05)
    assert t[1] - t[0] == pytest.approx(0.05) and abs(u).max() == 1.0 and abs(v).max() > 1.0
    assert np.array_equal(u, np.clip(v, -1, 1))
