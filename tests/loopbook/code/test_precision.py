"""What float32 costs: the formulas against what the numbers do."""

import numpy as np
import pytest

from loopbook.code import CodeError, controller, pid_block
from loopbook.code.precision import cost, dead_error, longer_interval, run_error

SLOW = {"K": 1.0, "Ti": 1000.0, "h": 0.01, "u_low": 0.0, "u_high": 100.0}


def moved(block, error: float, integral: float, samples: int = 1) -> float:
    """How far I goes from this value under a constant error, in float32."""
    loop = controller(block, np.float32)
    zero = np.float32(0)
    loop.start(zero, zero, np.float32(integral), zero)
    loop.step(zero, zero, zero)
    before = loop.I
    for _ in range(samples):
        loop.step(np.float32(error), zero, zero)
    return float(loop.I - before)


@pytest.mark.parametrize("integral", [50.0, 37.3, 3.0, 0.02])
def test_below_the_dead_error_the_integral_stands_still_and_above_it_moves(integral):
    block = pid_block(**SLOW)
    dead = dead_error(block, integral)
    assert moved(block, 0.99 * dead, integral, samples=300) == 0
    assert moved(block, 1.02 * dead, integral) > 0


def test_an_increment_of_1e_7_does_not_move_50_in_200_seconds():
    block = pid_block(K=1.0, Ti=1.0, h=0.01, u_low=0.0, u_high=100.0)
    assert moved(block, 1e-5, 50.0, samples=20_000) == 0, "K h/Ti e = 1e-7, 20,000 times"


def test_the_compensated_sum_moves_it():
    block = pid_block(K=1.0, Ti=1.0, h=0.01, u_low=0.0, u_high=100.0, compensated=True)
    assert moved(block, 1e-5, 50.0, samples=20_000) == pytest.approx(2e-3, rel=0.01)


def test_double_precision_sees_what_single_does_not():
    block = pid_block(**SLOW)
    assert dead_error(block, 50.0, "double") == pytest.approx(dead_error(block, 50.0) / 2**29)


def test_a_longer_interval_brings_the_dead_error_down_to_what_is_borne():
    block = pid_block(**SLOW)
    h = longer_interval(block, 50.0, 0.01)
    assert dead_error(pid_block(**SLOW | {"h": h}), 50.0) == pytest.approx(0.01)


def test_without_integral_action_nothing_is_dead():
    assert dead_error(pid_block(K=1.0, h=0.1), 50.0) == 0


def test_the_error_of_a_run_is_that_of_its_rounding():
    block = pid_block(K=2.3, Ti=7.7, Td=1.1, Tf=0.13, h=0.1, u_low=0.0, u_high=100.0)
    k = np.arange(200)
    y = 20 + np.sin(k / 10)
    single = run_error(block, y, np.full(200, 20.5), (35.0, 20.0))
    double = run_error(block, y, np.full(200, 20.5), (35.0, 20.0), "double")
    assert 1e-6 < single < 1e-2
    assert 0 < double < 1e-11


def test_the_cost_advises_only_where_it_matters():
    good = pid_block(K=2.3, Ti=7.7, h=0.1, u_low=0.0, u_high=100.0, rest=(35.0, 20.0))
    assert not cost(good, 100.0).advice
    slow = pid_block(**SLOW, rest=(50.0, 20.0))
    (sentence,) = cost(slow, 100.0).advice
    assert "LREAL" in sentence and "compensated" in sentence and "h of at least" in sentence
    assert not cost(slow, 100.0, real="double").advice
    assert cost(slow, 100.0, bits=12).y_step == pytest.approx(100 / 4095)


def test_what_is_asked_wrongly_is_said():
    block = pid_block(**SLOW)
    with pytest.raises(CodeError, match="span = 0"):
        cost(block, 0)
    with pytest.raises(CodeError, match="starts from rest"):
        cost(block, 1.0, run=([1.0], [1.0]))
