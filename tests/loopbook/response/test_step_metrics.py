"""Step metrics: closed forms, stepinfo's convention, and what each does with a hopeless response."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loopbook.response.step_metrics import NotSettled, StepMetricsError, exact_metrics, sampled_metrics


def first_order(T, delay=0.0, gain=1.0):
    return lambda t: gain * np.where(t >= delay, 1 - np.exp(-np.maximum(t - delay, 0) / T), 0.0)


def second_order(zeta, w=1.0):
    wd = w * math.sqrt(1 - zeta**2)
    return lambda t: 1 - np.exp(-zeta * w * t) * (np.cos(wd * t) + zeta * w / wd * np.sin(wd * t))


@settings(deadline=None, max_examples=30)
@given(T=st.floats(0.05, 50), delay=st.floats(0, 3), gain=st.sampled_from([-8360.0, 0.2, 1.0]))
def test_exact_first_order_has_rise_T_ln9_and_settling_L_plus_T_ln50(T, delay, gain):
    m = exact_metrics(first_order(T, delay, gain), gain, delay + 40 * T, breakpoints=[delay])
    assert m.rise == pytest.approx(T * math.log(9), rel=1e-9)
    assert m.settling == pytest.approx(delay + T * math.log(50), rel=1e-9)
    assert (m.overshoot, m.undershoot, m.convention) == (0.0, 0.0, "exact")


@settings(deadline=None, max_examples=30)
@given(zeta=st.floats(0.1, 0.75))
def test_exact_second_order_overshoot_and_peak_time(zeta):
    m = exact_metrics(second_order(zeta), 1.0, 12 / zeta)
    wd = math.sqrt(1 - zeta**2)
    assert m.overshoot == pytest.approx(100 * math.exp(-math.pi * zeta / wd), rel=1e-8)
    assert m.peak_time == pytest.approx(math.pi / wd, rel=1e-5)
    assert m.peak == pytest.approx(1 + m.overshoot / 100)


@settings(deadline=None, max_examples=30)
@given(zeta=st.floats(0.1, 0.99))
def test_exact_settling_is_the_last_crossing_also_on_a_coarse_grid(zeta):
    y = second_order(zeta)
    m = exact_metrics(y, 1.0, 12 / zeta, points=600)
    assert abs(float(y(m.settling)) - 1) == pytest.approx(0.02, rel=1e-6)
    later = np.linspace(m.settling * (1 + 1e-9), 12 / zeta, 200_001)
    assert np.max(np.abs(y(later) - 1)) <= 0.02 * (1 + 1e-9)


def test_exact_finds_an_extremum_that_leaves_the_band_between_two_grid_points():
    bump = 10.0
    y = lambda t: 1 - np.exp(-5 * t) + 0.0201 * np.exp(-(((t - bump - 0.05) / 0.1) ** 2))  # noqa: E731
    assert np.max(np.abs(y(np.array([bump, bump + 0.1])) - 1)) < 0.02
    assert exact_metrics(y, 1.0, 20.0, points=200).settling > bump


def test_undershoot_of_a_non_minimum_phase_response():
    y = lambda t: 1 - np.exp(-t) - 2 * t * np.exp(-t)  # noqa: E731   (1 - s) / (s + 1)^2
    m = exact_metrics(y, 1.0, 40.0)
    t = np.linspace(0, 5, 2_000_001)
    assert m.undershoot == pytest.approx(-100 * y(t).min(), rel=1e-9)


def test_stepinfo_on_a_straight_line():
    m = sampled_metrics([0.0, 1.0, 2.0, 3.0, 4.0], [0, 1, 2, 3, 4])
    assert m.rise == pytest.approx(3.2)
    assert m.settling == pytest.approx(3.92)
    assert (m.peak, m.peak_time, m.final) == (4.0, 4.0, 4.0)


def test_stepinfo_counts_from_the_time_axis_not_from_the_step():
    y = first_order(2.0)(np.arange(0, 40.0, 0.5))
    early, late = sampled_metrics(y, np.arange(80) * 0.5), sampled_metrics(y, 7 + np.arange(80) * 0.5)
    assert late.settling == pytest.approx(early.settling + 7)
    assert late.rise == pytest.approx(early.rise)
    assert sampled_metrics([0, 1, 1]).peak_time == 2.0  # times 1, 2, 3 where none are given


def test_stepinfo_approaches_exact_as_the_samples_get_dense():
    y, t = second_order(0.4), np.linspace(0, 60, 60_001)
    a, b = sampled_metrics(y(t), t, final=1.0), exact_metrics(y, 1.0, 60.0)
    assert a.rise == pytest.approx(b.rise, abs=1e-6)
    assert a.overshoot == pytest.approx(b.overshoot, abs=1e-5)
    assert a.settling == pytest.approx(b.settling, abs=1e-6)  # max|y - final| is the step itself here


def test_the_bands_differ_where_the_response_starts_the_wrong_way():
    y = lambda t: 1 - (1 + 6 * t) * np.exp(-t)  # noqa: E731
    t = np.linspace(0, 40, 40_001)
    assert sampled_metrics(y(t), t, final=1.0).settling < exact_metrics(y, 1.0, 40.0).settling - 0.5


def test_stepinfo_overshoot_is_relative_to_the_final_value_not_to_the_step():
    m = sampled_metrics([1.0, 2.5, 2.0, 2.0], [0, 1, 2, 3])
    assert m.overshoot == pytest.approx(25.0)
    assert sampled_metrics([0, -2.5, -2.0, -2.0], [0, 1, 2, 3]).overshoot == pytest.approx(25.0)
    assert sampled_metrics([0, -0.5, 2.0, 2.0], [0, 1, 2, 3]).undershoot == pytest.approx(25.0)


def test_stepinfo_without_an_answer():
    unsettled = sampled_metrics([0.0, 1.0, 0.0, 1.0], [0, 1, 2, 3], final=0.5)
    assert math.isnan(unsettled.settling)
    assert math.isnan(sampled_metrics([0.0, 0.5], final=1.0).rise)
    back_to_zero = sampled_metrics([0.0, 1.0, 0.0])
    assert back_to_zero.overshoot == math.inf and back_to_zero.undershoot == 0.0
    assert sampled_metrics([2.0, 2.0, 2.0]).settling == 0.0


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: sampled_metrics([1.0]), "two samples or more, got 1"),
        (lambda: sampled_metrics([1.0, math.nan]), "sample 1 is not finite"),
        (lambda: sampled_metrics([1.0, 2.0], [0, 1, 2]), "equally long"),
        (lambda: sampled_metrics([1.0, 2.0, 3.0], [0, 1, 1]), "t must increase; it does not after sample 1"),
        (lambda: exact_metrics(first_order(1), 1.0, 0.0), "horizon must be a positive time"),
        (lambda: exact_metrics(first_order(1), math.inf, 9.0), "without a final value does not settle"),
        (lambda: exact_metrics(lambda t: t * np.exp(-t), 0.0, 50.0), "ends where it begins"),
        (lambda: exact_metrics(lambda t: t * math.nan, 1.0, 50.0), "sample 0 is not finite"),
    ],
)
def test_errors_say_what_is_wrong(call, text):
    with pytest.raises(StepMetricsError, match=text):
        call()


def test_an_unsettled_response_says_by_how_much():
    with pytest.raises(NotSettled, match=r"not settled at t = 2: .* 0.1353, the band is 0.02") as caught:
        exact_metrics(first_order(1.0), 1.0, 2.0)
    assert caught.value.error == pytest.approx(math.exp(-2))
    assert (caught.value.horizon, caught.value.band) == (2.0, pytest.approx(0.02))
