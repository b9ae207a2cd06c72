"""The design report's figures: the record with its model, the responses of the rules, the trade-off between them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.design.evaluation import Evaluation
from loopbook.design.speed import Speed
from loopbook.design.study import Study
from loopbook.identification.choice import Identified
from loopbook.plots.curves import COLOURS, STYLES, curves
from loopbook.plots.legend import legend_below
from loopbook.response.simulation import Simulation
from notebook_reports import display
from notebook_reports.display import figure
from notebook_reports.project.printable import printable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 6
"""How many responses one figure can hold and still be read."""


def record_or_step(study: Study) -> display.Figure:
    """The record with its model, captioned; for a model that was given its step response."""
    if study.identified is not None:
        caption = "The recorded output with the fitted model, the residuals, and the recorded input."
        return figure(record(study.identified), caption, "Three panels over time: output and model, residuals, input.")
    model = study.model
    t = np.linspace(0.0, 8 * (model.delay + sum(model.lags)), 400)
    drawn = curves({"output $y$": {"model": (t, model.process.step(t))}}, "Unit step response of the given model")
    return figure(drawn, "The step response of the given model.", "A curve over time that starts after the dead time.")


def record(found: Identified) -> "Figure":
    """Input, output and the chosen model; below them the residuals."""
    import matplotlib.pyplot as plt

    log, fit = found.record, found.chosen
    fig, axes = plt.subplots(
        3, 1, figsize=(6.3, 5.4), sharex=True, layout="constrained", gridspec_kw={"height_ratios": [3, 1, 1]}
    )
    axes[0].plot(log.time, log.y, ".", color="0.6", markersize=2.5, label="measured")
    axes[0].plot(log.time, log.y - fit.residuals, color=COLOURS[0], label=f"{fit.structure.name}, {fit.fit:.1f} %")
    axes[0].set_ylabel(_label(log.output_name, log.output_unit))
    axes[0].set_title("The record and the model fitted to it")
    legend_below(fig, axes[0])
    axes[1].plot(log.time, fit.residuals, color=COLOURS[1], linewidth=0.8)
    axes[1].set_ylabel("residual")
    axes[2].step(log.time, log.u, where="post", color=COLOURS[2])
    axes[2].set_ylabel(_label(log.input_name, log.input_unit))
    axes[2].set_xlabel("time $t$ [s]")
    for axis in axes:
        axis.grid(True, linewidth=0.4, alpha=0.5)
    return fig


def sheet(study: Study) -> display.Figure:
    """The record with its model, small, for the first page; of a given model its step response."""
    import matplotlib.pyplot as plt

    if study.identified is None:
        model = study.model
        t = np.linspace(0.0, 8 * (model.delay + sum(model.lags)), 400)
        drawn = curves({"output $y$": {"model": (t, model.process.step(t))}}, "", height=2.0)
        return figure(
            drawn, "The step response of the given model.", "A curve over time that starts after the dead time."
        )
    log, fit = study.identified.record, study.identified.chosen
    fig, axes = plt.subplots(2, 1, figsize=(6.3, 1.9), sharex=True, layout="constrained", height_ratios=[3, 1])
    shown, out = log.used, ~log.used
    axes[0].plot(log.time[shown], log.y[shown], ".", color="0.6", markersize=2.5, label="measured")
    if out.any():
        axes[0].plot(log.time[out], log.y[out], "x", color=COLOURS[1], markersize=4, label="left out")
    axes[0].plot(log.time[shown], (log.y - fit.residuals)[shown], color=COLOURS[0], linewidth=1.2, label="model")
    axes[0].legend(fontsize="x-small", ncols=3)
    axes[1].step(log.time, log.u, where="post", color=COLOURS[2])
    axes[1].set_xlabel("time $t$ [s]", fontsize="small")
    names = (_label(log.output_name, log.output_unit), _label(log.input_name, log.input_unit))
    for axis, name in zip(axes, names, strict=True):
        axis.set_title(name, loc="left", fontsize="small", pad=3)
        axis.grid(True, linewidth=0.4, alpha=0.5)
        axis.tick_params(labelsize="small")
    return figure(fig, "The record and the model fitted to it.", "Two panels over time: output with model, and input.")


def _label(name: str, unit: str) -> str:
    return printable(f"{name} [{unit}]" if unit else name).replace("$", r"\$")


def responses(evaluations: Sequence[Evaluation], horizon: float) -> "Figure":
    """y and u after a reference step at t = 0 and a load step at half the horizon, of at most six loops."""
    t = np.linspace(0.0, horizon, 600)
    outputs, inputs = {}, {}
    stable = [(e.candidate.name, e.reference, e.load) for e in evaluations if e.reference and e.load]
    for name, reference, load in stable[:MOST]:
        y1, u1 = reference.after([(0.0, 1.0)], np.minimum(t, reference.horizon))
        y2, u2 = load.after([(horizon / 2, 1.0)], np.minimum(t, load.horizon))
        outputs[name], inputs["_" + name] = (t, y1 + y2), (t, u1 + u2)
    panels = {"output $y$": outputs, "input $u$": inputs}
    return curves(panels, "Unit steps of the reference (at once) and of the load (half-way)", levels=(1.0,), height=5.0)


def limited(run: Simulation) -> "Figure":
    """The chosen regulator as it will run."""
    panels = {"output $y$": {"sampled loop": (run.t, run.y), "reference": (run.t, run.reference)},
              "input $u$": {"within the limits": (run.t, run.u), "demanded": (run.t, run.demanded)}}  # fmt: skip
    return curves(panels, "The sampled regulator within the actuator's limits", height=4.6)


def _load_against_peak(axis: "Axes", chosen: Evaluation, title: str) -> None:
    """The axes of load error against robustness, with the usual limits of Ms and a ring around the chosen loop."""
    axis.plot(chosen.Ms, chosen.iae_load, "o", markersize=13, markerfacecolor="none", markeredgecolor="0.2")
    for limit, style in ((1.4, STYLES[3]), (2.0, STYLES[1])):
        axis.axvline(limit, color="0.6", linewidth=0.8, linestyle=style)
    axis.set_yscale("log")
    axis.set_xlabel("sensitivity peak $M_s$")
    axis.set_ylabel("IAE after a load step")
    axis.set_title(title)
    axis.grid(True, which="both", linewidth=0.4, alpha=0.5)


def along(curve: Sequence[tuple[Speed, Evaluation]], chosen: Evaluation) -> "Figure":
    """The trade-off along the knob from slow to fast: a line of PI and one of PID; the chosen loop ringed.

    curve: (speed, evaluation) pairs of `Study.curve`.
    """
    import matplotlib.pyplot as plt

    fig, axis = plt.subplots(figsize=(6.3, 3.0), layout="constrained")
    for kind, colour, marker in (("PI", COLOURS[0], "o"), ("PID", COLOURS[1], "s")):
        points = [(k, e) for k, e in curve if bool(e.candidate.pid.Td) is (kind == "PID")]
        if not points:
            continue
        how: dict[str, Any] = {"color": colour, "marker": marker, "markersize": 4}
        axis.plot([e.Ms for _, e in points], [e.iae_load for _, e in points], label=kind, **how)
        for knob, e in points:
            axis.annotate(f"{knob.speed:g}", (e.Ms, e.iae_load), textcoords="offset points", xytext=(4, 4), fontsize=7)
    _load_against_peak(axis, chosen, "From slow (0) to fast (1)")
    if curve:
        axis.legend(fontsize="small")
    return fig


def trade_off(evaluations: Sequence[Evaluation], chosen: Evaluation) -> "Figure":
    """Load error against robustness, one point a rule; PI as circles, PID as squares, the chosen one ringed."""
    import matplotlib.pyplot as plt

    fig, axis = plt.subplots(figsize=(6.3, 3.6), layout="constrained")
    stable = [e for e in evaluations if e.stable]
    for i, e in enumerate(stable):
        how: dict[str, Any] = {"marker": "s" if e.candidate.pid.Td else "o", "linestyle": "none", "markersize": 5}
        colour = COLOURS[i % len(COLOURS)]
        axis.plot(e.Ms, e.iae_load, color=colour, label=f"{i + 1}  {e.candidate.name}", **how)
        axis.annotate(str(i + 1), (e.Ms, e.iae_load), textcoords="offset points", xytext=(4, 4), fontsize=7)
    _load_against_peak(axis, chosen, "Robustness against load rejection")
    if stable:
        axis.legend(fontsize=6.5, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return fig
