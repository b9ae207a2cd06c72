"""Runs of a controlled process side by side: measurement above, output below."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from loopbook.plots.curves import curves

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def runs(named: Mapping[str, Any], title: str, y: str = "speed [km/h]", u: str = "output [V]", **more: Any) -> "Figure":
    """A matplotlib figure of several `loopbook.response.simulation.Simulation` by name. more: as for `curves`."""
    speeds = {name: (run.t, run.y) for name, run in named.items()}
    outputs = {name: (run.t, run.u) for name, run in named.items()}
    return curves({y: speeds, u: outputs}, title, **more)
