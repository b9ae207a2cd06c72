"""Settings over the optimum against the relative dead time, one point a process; optimal loops beside the circle."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.documents.pid_report.batch.processes import FORMULAS
from loopbook.documents.pid_report.batch.study import Ratios
from loopbook.loop.continuous import Loop
from loopbook.loop.process_phase import frequency_at
from loopbook.plots.curves import COLOURS
from loopbook.plots.legend import legend_below
from loopbook.plots.nyquist import nyquist_figure
from loopbook.process.transfer_function import Process
from loopbook.tuning.migo import circle

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARKERS = ("o", "s", "^", "v", "D", "P", "X", "*", "<")
DECADES = 8.0  # from this spread on the axis is logarithmic
NAMES = {"K": "$K/K_{MIGO}$", "Ti": "$T_i/T_{i,MIGO}$", "Td": "$T_d/T_{d,MIGO}$", "ki": "$k_i/k_{i,MIGO}$"}


def ratio_figure(ratios: Ratios, parameters: Sequence[str], title: str, band: float = 0.15) -> "Figure":
    """One panel a parameter, side by side: its ratio to the optimum, grey band 1 +- `band`, families by marker."""
    import matplotlib.pyplot as plt

    fig, axes = plt.subplots(1, len(parameters), figsize=(6.3, 3.4), squeeze=False, layout="constrained")
    for axis, name in zip(axes[0], parameters, strict=True):
        for family in range(1, 10):
            chosen = [m.family == family for m in ratios.members]
            across, up = ratios.tau[chosen], getattr(ratios, name)[chosen]
            look = {"marker": MARKERS[family - 1], "color": COLOURS[(family - 1) % len(COLOURS)]}
            look["label"] = f"${FORMULAS[family]}$"
            axis.plot(across, up, linestyle="none", markersize=3.5, markerfacecolor="none", **look)
        axis.axhspan(1 - band, 1 + band, color="0.9", zorder=0)
        values = getattr(ratios, name)
        if values.max() > DECADES * values.min():
            axis.set_yscale("log")
        axis.set_title(NAMES[name], fontsize="medium")
        axis.grid(True, linewidth=0.4, alpha=0.5)
        axis.set_xlabel(r"rel. dead time $\tau$ [1]")
    fig.suptitle(title)
    legend_below(fig, axes[0, 0])
    return fig


def joint_circle_figure(process: Process, regulators: Mapping[str, Any], M: float, title: str) -> "Figure":
    """The Nyquist curves of a process under several regulators, with the joint circle of M."""
    w = frequency_at(process, -2.5) * np.geomspace(1e-2, 1e2, 4000)
    curves = {name: Loop(process, regulator).transfer(1j * w) for name, regulator in regulators.items()}
    return nyquist_figure(curves, circle(M), f"joint circle, $M = {M:g}$", title)


def gain_figure(tau: Any, gain: Any, title: str) -> "Figure":
    """The integral gain of PID over that of PI against the relative dead time."""
    import matplotlib.pyplot as plt

    fig, axis = plt.subplots(figsize=(6.3, 3.0), layout="constrained")
    axis.plot(tau, gain, "o", markersize=4, markerfacecolor="none", color=COLOURS[0])
    axis.axhline(2.0, color="0.6", linewidth=0.8, linestyle=":")
    axis.set_yscale("log")
    axis.set_xlabel(r"relative dead time $\tau$ [1]")
    axis.set_ylabel("$k_i$ of PID over PI [1]")
    axis.grid(True, linewidth=0.4, alpha=0.5)
    axis.set_title(title)
    return fig
