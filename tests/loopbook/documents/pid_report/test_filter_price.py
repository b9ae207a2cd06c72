"""The filter's price against what it is by definition: scattered slopes, a delayed ramp, a loop's margins."""

import math

import numpy as np
import pytest

from loopbook.documents.pid_report.filter_forms import filtered
from loopbook.documents.pid_report.filter_price import noise, price


@pytest.mark.parametrize("Tf", [0.0, 0.1, 0.3])
def test_the_noise_is_that_of_the_program(Tf):
    samples = np.random.default_rng(0).standard_normal(100_000)
    slope = np.diff(filtered("backward (4.9)", samples, 0.1, Tf)) / 0.1
    assert slope[1000:].std() == pytest.approx(noise(Tf, 0.1), rel=0.02)


def test_a_ramp_shows_that_much_later():
    t = np.arange(0, 20, 0.1)
    behind = t - filtered("backward (4.9)", t, 0.1, 0.3)
    assert behind[-1] + 0.05 == pytest.approx(price(0.3, 0.1).late)


def test_a_stronger_filter_is_quieter_and_its_loop_less_robust():
    weak, middle, strong = (price(Tf, 0.1) for Tf in (0.0, 0.3, 0.9))
    assert weak.noise > middle.noise > strong.noise
    assert weak.Ms < middle.Ms < strong.Ms
    assert weak.phase_margin > middle.phase_margin > strong.phase_margin


def test_a_loop_that_is_not_stable_has_no_margins():
    slow = price(0.3, 10.0)
    assert math.isnan(slow.phase_margin) and slow.Ms == math.inf
