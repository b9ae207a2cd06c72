"""On-off control: the law of chapter 2, hysteresis and dead zone."""

import math

import pytest

from loopbook.controllers import BadMeasurement, OnOff, SettingError


def test_maximum_for_positive_minimum_for_negative_errors():
    plain = OnOff(0, 10)
    assert [plain.step(y, 50) for y in (49, 51, 50, 49.9)] == [10, 0, 0, 10]
    assert plain.switches == 2


def test_hysteresis_keeps_the_last_output_within_its_band():
    relay = OnOff(0, 10, hysteresis=2)
    assert [relay.step(y, 50) for y in (47, 49, 52, 52.1, 48, 47.9)] == [10, 10, 10, 0, 0, 10]


def test_dead_zone_rests_within_its_band():
    relay = OnOff(-1, 1, dead_zone=2)
    assert [relay.step(y, 0) for y in (3, 2, 0, -2, -3)] == [-1, 0, 0, 0, 1]
    assert OnOff(0, 10, dead_zone=1, u_rest=2).step(0, 0) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((1, 1), "u_low = 1 is outside its range: u_low < u_high = 1"),
        ((0, 1, -1), "hysteresis = -1 is outside its range: hysteresis >= 0"),
        ((0, 1, 0, math.nan), "dead_zone = nan is outside"),
        ((0, 1, 1, 1), "dead_zone = 1 is outside its range: 0 where hysteresis is given"),
        ((0, 1, 0, 1, 2), "u_rest = 2 is outside its range: u_low <= u_rest <= u_high"),
    ],
)
def test_bad_settings(arguments, message):
    with pytest.raises(SettingError) as caught:
        OnOff(*arguments)
    assert message in str(caught.value)


def test_bad_measurement_keeps_the_output():
    relay = OnOff(0, 1)
    relay.step(0, 1)
    with pytest.raises(BadMeasurement, match="y = nan is not a finite number; state kept, last output 1"):
        relay.step(math.nan, 1)
    assert relay.u == 1
