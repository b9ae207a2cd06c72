"""A legend that hides no curve: below the figure, where that is one for all panels."""

import re
from typing import Any

ROOM = 78
"""Characters of small letters in one row below a figure, its samples and gaps included."""
AROUND = 7
"""What an entry takes beside its words, in characters."""
ROW = 0.2
"""Inch of height for a row of entries."""


def legend_below(fig: Any, axis: Any, **more: Any) -> None:
    """Name the curves of one panel below the figure, which grows by as much. more: as for matplotlib's legend."""
    handles, names = axis.get_legend_handles_labels()
    if not names:
        return
    wide = max(map(_length, names)) + AROUND
    one_row = sum(_length(name) + AROUND for name in names) <= ROOM
    columns = len(names) if one_row else max(1, min(len(names), ROOM // wide))
    rows = -(-len(names) // columns)
    fig.set_figheight(fig.get_figheight() + ROW * rows + 0.1)
    fig.legend(handles, names, loc="outside lower center", ncols=columns, **{"fontsize": "small", **more})


def legend_beside(axis: Any) -> None:
    """Name the curves of one panel at its right, where another panel has others."""
    axis.legend(fontsize="small", loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)


def _length(name: str) -> int:
    """The characters of a name as they are read, roughly: commands and braces of formulas are none."""
    return len(re.sub(r"\\[a-zA-Z]+|[$^_{}\\]", "", name))
