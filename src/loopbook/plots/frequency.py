"""Bode and Nyquist diagrams of arrays, with the margins drawn."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.plots.curves import COLOURS, STYLES
from loopbook.plots.legend import legend_below

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ANGLES, MOST_TICKS = (5, 15, 30, 45, 90, 180, 360), 7
BOX = {"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.7}
BESIDE: dict[str, Any] = {"textcoords": "offset points", "xytext": (5, 0), "bbox": BOX}
NEAR = 3.0  # how far a Nyquist diagram looks beyond what is near -1


@dataclass(frozen=True)
class Curve:
    """A frequency response: w [rad/s], gain, phase [degrees], arrays of one length; all margins as (w, value):
    gains: where the phase is -180 degrees (mod 360), the factor to -1. phases: where the gain is 1, degrees to -1.
    peak: (w, Ms), None where there is none.
    """

    w: np.ndarray
    gain: np.ndarray
    phase: np.ndarray
    gains: Sequence[tuple[float, float]] = ()
    phases: Sequence[tuple[float, float]] = ()
    peak: tuple[float, float] | None = None


def bode_figure(curves: Mapping[str, Curve], title: str) -> "Figure":
    """Gain and phase over the frequency; of a single curve with its margins."""
    import matplotlib.pyplot as plt

    fig, axes = plt.subplots(2, 1, figsize=(6.3, 4.8), sharex=True, layout="constrained")
    for i, (name, curve) in enumerate(curves.items()):
        how = _line(i)
        axes[0].loglog(curve.w, curve.gain, label=name, **how)
        axes[1].semilogx(curve.w, curve.phase, **how)
    if len(curves) == 1:
        (curve,) = curves.values()
        _draw_margins(axes, curve)
    else:
        legend_below(fig, axes[0])
    axes[0].set_ylabel("gain")
    axes[1].set_ylabel("phase [°]")
    low, high = axes[1].get_ylim()
    step = next((step for step in ANGLES if (high - low) / step <= MOST_TICKS), 360 * (1 + int((high - low) / 2520)))
    axes[1].yaxis.set_major_locator(plt.MultipleLocator(step))
    axes[1].set_xlabel("frequency $\\omega$ [rad/s]")
    axes[0].set_title(title)
    for axis in axes:
        axis.grid(True, which="both", linewidth=0.4, alpha=0.5)
    return fig


def _line(i: int) -> dict[str, Any]:
    return {"color": COLOURS[i % len(COLOURS)], "linestyle": STYLES[i % len(STYLES)], "linewidth": 1.4}


def _draw_margins(axes: Any, curve: Curve) -> None:
    """The least of each margin as a line from the curve to where it would be critical."""
    gains = [(w, g) for w, g in curve.gains if g > 1 and curve.w[0] <= w <= curve.w[-1]]
    phases = [(w, p) for w, p in curve.phases if curve.w[0] <= w <= curve.w[-1]]
    if not (gains or phases):
        return
    axes[0].axhline(1.0, color="0.5", linewidth=0.8)
    if gains:
        w, g = min(gains, key=lambda pair: pair[1])
        axes[0].plot([w, w], [1 / g, 1.0], color="black", linewidth=1.6)
        axes[0].annotate(f"$G_m = {g:.3g}$", (w, 1 / math.sqrt(g)), **BESIDE)
        axes[1].axvline(w, color="0.6", linewidth=0.8, linestyle=":")
    if phases:
        w, p = min(phases, key=lambda pair: abs(pair[1]))
        at = float(np.interp(math.log(w), np.log(curve.w), curve.phase))
        axes[1].axhline(at - p, color="0.5", linewidth=0.8)
        axes[1].plot([w, w], [at - p, at], color="black", linewidth=1.6)
        axes[1].annotate(f"$\\varphi_m = {p:.3g}$°", (w, at - p / 2), **BESIDE)
        axes[0].axvline(w, color="0.6", linewidth=0.8, linestyle=":")


def nyquist_curves(curves: Mapping[str, Curve], title: str) -> "Figure":
    """Nyquist curves around -1, of a single curve with its margins and the circle that Ms stays out of."""
    import matplotlib.pyplot as plt

    fig, axis = plt.subplots(figsize=(5.0, 4.6), layout="constrained")
    angle = np.linspace(0, 2 * np.pi, 361)
    axis.plot(np.cos(angle), np.sin(angle), color="0.7", linewidth=0.8)
    for i, (name, curve) in enumerate(curves.items()):
        value = curve.gain * np.exp(1j * np.radians(curve.phase))
        axis.plot(value.real, value.imag, label=name, **_line(i))
    axis.plot(-1, 0, "+", color="black", markersize=9)
    if len(curves) == 1:
        (curve,) = curves.values()
        _draw_distances(axis, curve)
    if len(curves) > 1 or curve.gains or curve.phases:
        axis.legend(fontsize="small", loc="lower right")
    axis.set(xlim=(-NEAR, NEAR / 2), ylim=(-NEAR, NEAR / 2), aspect="equal", title=title)
    axis.set_xlabel("real part")
    axis.set_ylabel("imaginary part")
    axis.grid(True, linewidth=0.4, alpha=0.5)
    return fig


def _draw_distances(axis: Any, curve: Curve) -> None:
    gains = [g for _, g in curve.gains if g > 1]
    if gains:
        g = min(gains)
        axis.plot([-1 / g], [0], "o", color=COLOURS[1], markersize=5, label=f"gain margin {g:.3g}")
    if curve.phases:
        p = math.radians(min((p for _, p in curve.phases), key=abs))
        point = -np.exp(1j * p)
        axis.plot([0, point.real], [0, point.imag], color="0.5", linewidth=0.8)
        axis.plot(
            [point.real],
            [point.imag],
            "s",
            color=COLOURS[2],
            markersize=5,
            label=f"phase margin {math.degrees(p):.3g}°",
        )
    if curve.peak is not None:
        radius, angle = 1 / curve.peak[1], np.linspace(0, 2 * np.pi, 181)
        circle = -1 + radius * np.exp(1j * angle)
        label = f"$M_s = {curve.peak[1]:.3g}$"
        axis.plot(circle.real, circle.imag, color=COLOURS[3], linewidth=1.0, linestyle="--", label=label)
