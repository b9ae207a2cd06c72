"""Named curves over one axis, in one panel or several: step responses, control signals, static characteristics."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

from loopbook.plots.legend import legend_below, legend_beside

STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)))
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""A palette that stays apart for colour-blind readers; the line styles stay apart in print."""


def curves(
    panels: Mapping[str, Mapping[str, tuple[Any, Any]]],
    title: str,
    x: str = "time $t$ [s]",
    *,
    levels: Sequence[float] = (),
    instants: Sequence[float] = (),
    height: float = 0.0,
) -> "Figure":
    """A matplotlib figure: per panel its y label (with the unit) and its curves by name as (x values, y values).

    levels: horizontal guides in the first panel. instants: vertical guides in every panel. height: inch; default 3
    for one panel, 4.4 for more. A name that starts with "_" is drawn without a legend entry; a name that starts with
    "o " is drawn as points. Panels share the x axis. Raises ValueError without panels.

    >>> fig = curves({"output $y$ [K]": {"rise": ([0, 1], [0, 1])}}, "A title")
    >>> fig.axes[0].get_ylabel()
    'output $y$ [K]'
    """
    import matplotlib.pyplot as plt

    if not panels:
        raise ValueError("curves needs at least one panel: {'y [m]': {'name': (t, y)}}")
    named = [[n for n in lines if not n.startswith("_")] if len(lines) > 1 else [] for lines in panels.values()]
    one_for_all = len({tuple(names) for names in named if names}) == 1
    size = (6.3, height or (3.0 if len(panels) == 1 else 4.4))
    fig, axes = plt.subplots(len(panels), 1, figsize=size, sharex=True, squeeze=False, layout="constrained")
    for axis, names, (label, lines) in zip(axes[:, 0], named, panels.items(), strict=True):
        for i, (name, (across, up)) in enumerate(lines.items()):
            points = name.startswith("o ")
            how = {"marker": "o", "linestyle": "none"} if points else {"linestyle": STYLES[i % len(STYLES)]}
            shown = name[2:] if points else name
            axis.plot(across, up, color=COLOURS[i % len(COLOURS)], linewidth=1.4, markersize=5, label=shown, **how)
        for instant in instants:
            axis.axvline(instant, color="0.6", linewidth=0.8, linestyle=":")
        axis.set_ylabel(label)
        axis.grid(True, linewidth=0.4, alpha=0.5)
        if names and not one_for_all:
            legend_beside(axis)
    for level in levels:
        axes[0, 0].axhline(level, color="0.6", linewidth=0.8, linestyle=":")
    axes[0, 0].set_title(title)
    axes[-1, 0].set_xlabel(x)
    if one_for_all:
        legend_below(fig, next(axis for axis, names in zip(axes[:, 0], named, strict=True) if names))
    return fig
