"""The corners of a zero-order hold."""

import numpy as np

from loopbook.plots.stairs import stairs


def test_value_holds_until_the_next_instant():
    t, u = stairs(np.array([0.0, 0.5, 1.0]), [1.0, 3.0, 2.0])
    assert np.interp([0.25, 0.75], t, u).tolist() == [1.0, 3.0]
    assert (t[-1], u[-1]) == (1.0, 2.0)
