"""A figure that is shown once: where a notebook draws open figures after each cell, it is closed before it is given."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def shown_once(fig: Any) -> "Figure":
    """The same figure. Elsewhere it stays with pyplot, so that ``plt.show()`` opens it."""
    import matplotlib
    import matplotlib.pyplot as plt

    if "inline" in matplotlib.get_backend():
        plt.close(fig)
    return fig
