"""Runs side by side: measurement above, output below, a curve each."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np

from loopbook.plots.runs import runs


def test_each_run_is_a_curve_in_both_panels():
    t = np.linspace(0, 1, 5)
    named = {"one": SimpleNamespace(t=t, y=t, u=-t), "two": SimpleNamespace(t=t, y=2 * t, u=0 * t)}
    figure = runs(named, "two runs")
    above, below = figure.axes
    assert [line.get_label() for line in above.get_lines()] == ["one", "two"]
    assert np.array_equal(above.get_lines()[1].get_ydata(), 2 * t)
    assert np.array_equal(below.get_lines()[0].get_ydata(), -t)
    assert below.get_xlabel() == "time $t$ [s]" and figure.axes[0].get_title() == "two runs"
    plt.close(figure)
