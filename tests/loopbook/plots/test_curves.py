"""A figure of curves has what a reader needs: title, labels, guides, a legend where there is a choice."""

import matplotlib
import pytest

matplotlib.use("Agg")

from loopbook.plots.curves import curves


def test_panels_carry_title_labels_and_guides():
    import matplotlib.pyplot as plt

    two = {"y [m]": {"a": ([0, 1], [0, 1]), "o b": ([0, 1], [1, 1])}, "u [V]": {"_only": ([0, 1], [2, 2])}}
    fig = curves(two, "Title", levels=[0.5], instants=[0.2])
    top, bottom = fig.axes
    assert top.get_title() == "Title" and bottom.get_xlabel() == "time $t$ [s]"
    assert (top.get_ylabel(), bottom.get_ylabel()) == ("y [m]", "u [V]")
    (legend,) = fig.legends
    assert [t.get_text() for t in legend.get_texts()] == ["a", "b"]
    assert top.get_legend() is None and bottom.get_legend() is None
    assert len(top.lines) == 4 and len(bottom.lines) == 2
    assert top.lines[1].get_marker() == "o" and top.lines[0].get_marker() == "None"
    plt.close(fig)


def test_no_panel_is_an_error():
    with pytest.raises(ValueError, match="at least one panel"):
        curves({}, "Title")
