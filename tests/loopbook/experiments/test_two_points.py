"""The two-point fit in numbers: the printed example, the inverse of a model, refusals."""

import math

import pytest

from loopbook.experiments.data import DataError
from loopbook.experiments.two_points import PARTS, equal_lags_instants, fit
from loopbook.process.construct import tf


@pytest.mark.parametrize(
    "t1, t2, T, T0",
    [(4.29, 2.1, 3.285, 1.005), (1.87, 0.99, 1.32, 0.55), (3.61, 1.77, 2.76, 0.85), (5.49, 2.48, 4.515, 0.975)],
)
def test_printed_models(t1, t2, T, T0):
    model = fit(1, t1, t2)
    assert (round(model.T, 4), round(model.L, 4)) == (T, T0)


def test_a_lag_with_dead_time_is_returned():
    model = fit(2.0, 0.7 + 3.0, 0.7 + 3.0 / 3)
    assert (model.Kp, model.T, model.L) == pytest.approx((2.0, 3.0, 0.7 + 0.0), abs=1e-12)
    rounded = fit(2.0, -3 * math.log(1 - 0.632), -3 * math.log(1 - 0.283))
    assert abs(rounded.L) < 2e-3


@pytest.mark.parametrize("t1, t2, words", [(1, 2, "must come after"), (3.0, 0.2, "faster at first than a lag")])
def test_impossible_instants_are_refused(t1, t2, words):
    with pytest.raises(DataError, match=words):
        fit(1, t1, t2)


@pytest.mark.parametrize("order", [1, 2, 3, 6])
def test_equal_lags_have_come_so_far_at_their_instants(order):
    reached = tf(1, [[2.5, 1]] * order).step(equal_lags_instants(order, 2.5))
    assert reached == pytest.approx(PARTS, rel=1e-9)


@pytest.mark.parametrize("order, tau", [(0, 1.0), (2, 0.0), (2, -1.0), (2, math.nan)])
def test_lags_that_are_none_are_refused(order, tau):
    with pytest.raises(DataError, match="lags in a row"):
        equal_lags_instants(order, tau)
