"""The page's picture for paper and for browsers without JavaScript: the loop as the page begins."""

import io
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.transfer import LoopError
from loopbook.plots.curves import COLOURS, STYLES
from loopbook.plots.stairs import stairs
from loopbook.pole_placement.place import place
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation, simulate
from loopbook.tuner_page.running import is_programmed, number_of_data, program_settings, rst_of, run_program

SIZE = (7.4, 3.5)
FEW = 700  # samples that are told apart


def process_of(data: Mapping[str, Any]) -> Process:
    """The process that the page's data stand for."""
    s = data["state"]
    if "process" in data:
        given = data["process"]
        return Process(tuple(s["K"] * c for c in given["num"]), tuple(given["den"]), s["L"])
    den = np.array([1.0, 0.0]) if s.get("integrating") else np.array([1.0])
    for T in (s.get("T1", 0.0), s.get("T2", 0.0), s.get("T3", 0.0)):
        den = np.polymul(den, [T, 1.0]) if T else den
    num = (s["K"] * s["Tz"], s["K"]) if s.get("Tz") else (s["K"],)
    return Process(num, tuple(den), s["L"])


def regulator_of(data: Mapping[str, Any]) -> PidStandard:
    """The PID regulator that the page's data stand for."""
    s = data["state"]
    Ti, N = number_of_data(s["Ti"]), number_of_data(s["N"])
    filtered = {"N": N} if s["Td"] else {}
    return PidStandard(s["Kc"], Ti, s["Td"], b=s["b"], c=s["c"], **filtered)


def loop_of(data: Mapping[str, Any]) -> Loop | SampledLoop:
    """The loop that the page's data stand for; with a sampling interval, as of a pole placement, the sampled one."""
    s, process = data["state"], process_of(data)
    if s.get("kind") != "rst":
        return (
            SampledLoop(process, rst_of(program_settings(s, s["h"])))
            if s.get("h")
            else Loop(process, regulator_of(data))
        )
    count, h = process.order + 1, s["h"]
    pair = s["speed"] * (-s["damping"] + 1j * math.sqrt(max(1 - s["damping"] ** 2, 0.0)))
    wanted = [pair, pair.conjugate()][:count] + [complex(-s["rest"])] * (count - 2)
    observer = [math.exp(-s["observer"] * h)] if s.get("observer") else []
    z = [np.exp(p * h) for p in wanted]
    return SampledLoop(process, place(sample(process, h), z, observer=observer).regulator)


def still(data: Mapping[str, Any]) -> Any:
    """A matplotlib figure: y and u after a set-point step and a load step, and the Nyquist curve."""
    import matplotlib.pyplot as plt

    loop, s = loop_of(data), data["state"]
    fig = plt.figure(figsize=SIZE, layout="constrained")
    grid = fig.add_gridspec(2, 2, width_ratios=[1.5, 1])
    axes = [fig.add_subplot(grid[0, 0]), fig.add_subplot(grid[1, 0]), fig.add_subplot(grid[:, 1])]
    names = data.get("names", {})
    for axis, name in zip(axes, (names.get("y", "output y"), names.get("u", "input u")), strict=False):
        axis.set_ylabel(_literal(name))
        axis.grid(True, linewidth=0.4, alpha=0.5)
    axes[1].set_xlabel("time $t$ [s]")
    output, entered, seen = _responses(loop, data)
    axes[0].plot(*output, color=COLOURS[0], linewidth=1.4)
    axes[1].plot(*entered, color=COLOURS[0], linewidth=1.4)
    if seen is not None:
        axes[0].plot(*seen, ".", color="0.45", markersize=3)
    for limit in (s.get("low"), s.get("high")):
        if limit is not None:
            axes[1].axhline(limit, color=COLOURS[1], linewidth=0.8, linestyle=":")
    axes[0].axhline(s["r"], color="0.6", linewidth=0.8, linestyle="--")
    axes[2].add_patch(plt.Circle((0, 0), 1, fill=False, edgecolor="0.6", linestyle=":"))
    curve = nyquist_curve(loop)
    axes[2].plot(curve.real, curve.imag, color=COLOURS[0], linewidth=1.4, linestyle=STYLES[0])
    axes[2].plot(-1, 0, "x", color=COLOURS[1])
    if loop.is_stable:
        near = 1 / loop.margins().Ms.value
        axes[2].add_patch(plt.Circle((-1, 0), near, fill=False, edgecolor=COLOURS[1], linestyle="--", linewidth=0.9))
    axes[2].set(xlim=(-2.2, 1.2), ylim=(-2.2, 1.2), aspect="equal")
    axes[2].set_xlabel(_title(loop), fontsize="small")
    axes[2].grid(True, linewidth=0.4, alpha=0.5)
    return fig


def nyquist_curve(loop: Loop | SampledLoop) -> np.ndarray:
    """The values of the loop transfer along the frequencies that a diagram of it shows."""
    if isinstance(loop, SampledLoop):
        return np.asarray(loop.at(np.geomspace(1e-3, 1.0, 600) * np.pi))
    crossovers = loop.transfer.gain_crossovers
    middle = float(crossovers[0]) if len(crossovers) else 1 / (loop.process.delay or 1.0)
    return np.asarray(loop.transfer(1j * middle * np.geomspace(0.03, 60, 1500)))


Course = tuple[np.ndarray, np.ndarray]


def _responses(loop: Loop | SampledLoop, data: Mapping[str, Any]) -> tuple[Course, Course, Course | None]:
    """(t, y) and (t, u); where the measurement is disturbed (t, what the regulator sees)."""
    s = data["state"]
    if is_programmed(data):
        course = run_program(data, process_of(data), _horizon(Loop(loop.process, regulator_of(data))))
        seen = (course.t, course.measured) if s.get("wave") and len(course.t) < FEW else None
        return _output(course), stairs(course.t, course.u), seen
    if isinstance(loop, SampledLoop):
        steps = max(40, round(12 / (s["speed"] * s["h"])))
        load = [0.0 if k < steps // 2 else s["d"] for k in range(steps + 1)]
        low, high = number_of_data(s.get("low"), -math.inf), number_of_data(s.get("high"))
        course = simulate(
            loop.process, loop.regulator.controller(low, high), s["h"], steps, reference=s["r"], load=load
        )
        return _output(course), stairs(course.t, course.u), None
    horizon = _horizon(loop)
    t = np.linspace(0.0, horizon, 600)
    reference, load_step = loop.step("reference", horizon), loop.step("load", horizon)
    (y1, u1), (y2, u2) = reference.after([(0.0, s["r"])], t), load_step.after([(horizon / 2, s["d"])], t)
    return (t, y1 + y2), (t, u1 + u2), None


def _output(course: Simulation) -> Course:
    """(t, y), also between few samples."""
    if len(course.t) >= FEW:
        return course.t, course.y
    t = np.linspace(0.0, course.t[-1], FEW)
    return t, course.between(t)


def _horizon(loop: Loop) -> float:
    """How much time is shown [s]."""
    try:
        return 2.4 * max(loop.step("reference").metrics().settling, 3 * loop.process.delay)
    except LoopError:
        return 5 * (loop.process.delay + sum(1 / abs(p.real) for p in loop.process.poles if p.real))


def _title(loop: Loop | SampledLoop) -> str:
    if not loop.is_stable:
        return "Nyquist curve; the loop is unstable"
    return f"Nyquist curve; $M_s$ = {loop.margins().Ms.value:.3g}"


def _literal(text: str) -> str:
    return text.replace("$", r"\$")


def still_svg(data: Mapping[str, Any], usual: bool = False) -> str:
    """The figure as SVG text, the same at each run. usual: in matplotlib's own style, whatever the user's is."""
    import matplotlib as mpl

    with mpl.rc_context():
        if usual:
            mpl.rcdefaults()
        return _svg(still(data))


def _svg(fig: Any) -> str:
    import matplotlib as mpl
    import matplotlib.pyplot as plt

    buffer = io.StringIO()
    with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "loopbook"}):
        fig.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(fig)
    return buffer.getvalue()
