"""Nyquist curves beside the joint circle of a given M."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from loopbook.loop.continuous import Loop
from loopbook.plots.curves import COLOURS, STYLES
from loopbook.process.frequency_response import frequency_at
from loopbook.process.transfer_function import Process
from loopbook.tuning.migo import circle


def nyquist_figure(process: Process, regulators: Mapping[str, Any], M: float, title: str) -> Any:
    """The curves of a process under several regulators, with the circle they must stay out of."""
    import matplotlib.pyplot as plt

    fig, axis = plt.subplots(figsize=(4.6, 4.0), layout="constrained")
    C, R = circle(M)
    axis.add_patch(plt.Circle((-C, 0), R, facecolor="0.92", edgecolor="0.4", label=f"joint circle, $M = {M:g}$"))
    w = frequency_at(process, -2.5) * np.geomspace(1e-2, 1e2, 4000)
    for i, (name, regulator) in enumerate(regulators.items()):
        curve = Loop(process, regulator).transfer(1j * w)
        axis.plot(curve.real, curve.imag, label=name, color=COLOURS[i], linestyle=STYLES[i], linewidth=1.4)
    axis.plot(-1, 0, "+", color="black")
    axis.set(xlim=(-C - 1.4 * R, 0.6), ylim=(-1.9 * R, 1.2 * R), aspect="equal")
    axis.set_xlabel("real part of $L(i\\omega)$ [1]")
    axis.set_ylabel("imaginary part of $L(i\\omega)$ [1]")
    axis.grid(True, linewidth=0.4, alpha=0.5)
    axis.legend(fontsize="small", loc="lower left")
    axis.set_title(title)
    return fig
