"""A figure that is shown once: where a notebook draws open figures after each cell, it is closed before it is given."""

from typing import Any


def shown_once(fig: Any) -> Any:
    """The same figure. Elsewhere it stays with pyplot, so that ``plt.show()`` opens it."""
    import matplotlib
    import matplotlib.pyplot as plt

    if "inline" in matplotlib.get_backend():
        plt.close(fig)
    return fig
