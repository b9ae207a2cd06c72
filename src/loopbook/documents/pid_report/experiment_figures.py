"""Figures 5.1 to 5.7 of pid-report, drawn from the experiments that they describe: input, output and what is read."""

from typing import TYPE_CHECKING

import numpy as np

from loopbook.experiments.plant import Estimate
from loopbook.experiments.self_oscillation import turning_points
from loopbook.plots.curves import curves

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _figure(estimate: Estimate, title: str, more: dict, since: float = 0.0) -> "Figure":
    r = estimate.record
    keep = r.time >= since
    panels = {
        "input $u$": {"u": (r.time[keep], r.u[keep])},
        "output $y$": {"y": (r.time[keep], r.y[keep]), **more},
    }
    return curves(panels, title)


def step_figure(estimate: Estimate, title: str) -> "Figure":
    """A step with its steepest tangent and the 63 % point."""
    m = estimate.marks
    start, rise = m["t0"] + estimate.data.L, (m["after"] - m["before"]) / m["slope"]
    tangent = ([start, start + rise], [m["before"], m["after"]])
    point = ([m["t63"]], [m["before"] + (1 - np.exp(-1)) * (m["after"] - m["before"])])
    return _figure(estimate, title, {"steepest tangent": tangent, "o 63 %": point})


def integrating_figure(estimate: Estimate, title: str) -> "Figure":
    """A step on an integrating process with the final tangent, drawn back to the instant of the step."""
    m, end = estimate.marks, float(estimate.record.time[-1])
    line = ([m["t0"], end], [m["before"] - m["dy"], m["before"] + m["slope"] * (end - m["crossing"])])
    return _figure(estimate, title, {"final tangent": line, "o crossing": ([m["crossing"]], [m["before"]])})


def double_pulse_figure(estimate: Estimate, title: str) -> "Figure":
    """A double pulse with the two extremes."""
    m = estimate.marks
    read = ([m["t0"] + m["t_max"], m["t0"] + m["t_min"]], [m["y_max"], m["y_min"]])
    return _figure(estimate, title, {"o extremes": read})


def oscillation_figure(estimate: Estimate, title: str) -> "Figure":
    """A self-oscillation with the turning points that give its period."""
    times, values = turning_points(estimate.record)
    return _figure(estimate, title, {"o turning points": (times, values)})


def sine_figure(estimate: Estimate, title: str, periods: float = 6.0) -> "Figure":
    """The last periods of a sine experiment."""
    since = float(estimate.record.time[-1]) - periods * 2 * np.pi / estimate.marks["w"]
    return _figure(estimate, title, {}, max(since, 0.0))


def relay_figure(estimate: Estimate, title: str) -> "Figure":
    """A relay experiment with its amplitude."""
    m = estimate.marks
    span = [m["start"], m["end"]]
    middle = float(np.mean(estimate.record.y[estimate.record.time >= m["start"]]))
    lines = {"amplitude": (span, [middle + m["y_a"]] * 2), "_": (span, [middle - m["y_a"]] * 2)}
    return _figure(estimate, title, lines)
