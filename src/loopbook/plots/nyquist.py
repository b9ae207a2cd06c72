"""Nyquist curves beside a circle that they must stay out of."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from loopbook.plots.curves import COLOURS, STYLES
from loopbook.plots.legend import legend_below

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def nyquist_figure(
    curves: Mapping[str, NDArray[np.complex128]], circle: tuple[float, float], name: str, title: str
) -> "Figure":
    """The curves L(i w) by name, with the point -1 and a grey circle.

    circle: (C, R), centre -C on the real axis and radius. name: what the circle is, for the legend.
    """
    import matplotlib.pyplot as plt

    fig, axis = plt.subplots(figsize=(4.6, 4.0), layout="constrained")
    C, R = circle
    axis.add_patch(plt.Circle((-C, 0), R, facecolor="0.92", edgecolor="0.4", label=name))
    for i, (label, curve) in enumerate(curves.items()):
        axis.plot(curve.real, curve.imag, label=label, color=COLOURS[i], linestyle=STYLES[i], linewidth=1.4)
    axis.plot(-1, 0, "+", color="black")
    axis.set(xlim=(-C - 1.4 * R, 0.6), ylim=(-1.9 * R, 1.2 * R), aspect="equal")
    axis.set_xlabel("real part of $L(i\\omega)$ [1]")
    axis.set_ylabel("imaginary part of $L(i\\omega)$ [1]")
    axis.grid(True, linewidth=0.4, alpha=0.5)
    legend_below(fig, axis)
    axis.set_title(title)
    return fig
