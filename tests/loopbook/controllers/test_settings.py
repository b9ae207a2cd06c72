"""Bad settings are refused by name, value and range; rules and forms give good ones."""

import math
from fractions import Fraction

import pytest

from loopbook.controllers import ANTI_WINDUP, PidSettings, SettingError
from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.settings import tracking_time

GOOD = {"K": 2.0, "Ti": 4.0, "Td": 1.0, "Tf": 0.1, "h": 0.5, "u_low": 0.0, "u_high": 10.0}


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("h", 0, "h = 0 is outside its range: h > 0 s"),
        ("h", -0.1, "h = -0.1 is outside its range: h > 0 s"),
        ("Ti", 0, "Ti = 0 is outside its range: Ti > 0 s; Ti = None switches the integral action off"),
        ("Ti", -1.0, "Ti = -1.0 is outside"),
        ("Td", -1, "Td = -1 is outside its range: Td >= 0 s"),
        ("Tf", -0.5, "Tf = -0.5 is outside its range: Tf >= 0 s"),
        ("b", 1.2, "b = 1.2 is outside its range: 0 <= b <= 1"),
        ("b", -0.1, "b = -0.1 is outside"),
        ("c", 2, "c = 2 is outside its range: 0 <= c <= 1"),
        ("K", 0, "K = 0 is outside its range: K > 0 or K < 0"),
        ("K", math.nan, "K = nan is outside its range: a finite real number"),
        ("K", "2", "K = '2' is outside its range: a finite real number"),
        ("K", True, "K = True is outside"),
        ("h", math.inf, "h = inf is outside its range: a finite real number"),
        ("u_low", 10.0, "u_low = 10.0 is outside its range: u_low < u_high = 10.0"),
        ("u_high", math.nan, "u_high = nan is outside its range: a real number"),
        ("rate", 0, "rate = 0 is outside its range: rate > 0 per second, or None"),
        ("Tt", 0.25, "Tt = 0.25 is outside its range: Tt > h/2 = 0.25 s; below it tracking diverges"),
        ("anti_windup", "magic", "anti_windup = 'magic' is outside its range: one of tracking, conditional"),
    ],
)
def test_bad_settings(name, value, message):
    with pytest.raises(SettingError) as caught:
        PidSettings(**{**GOOD, name: value})
    assert message in str(caught.value)
    assert caught.value.name == name
    assert caught.value.range


def test_unknown_setting_in_a_change():
    with pytest.raises(SettingError, match="Kp = 3 is outside its range: one of K, Ti"):
        PidSettings(**GOOD).changed(Kp=3)


def test_tracking_time_rules():
    assert tracking_time(4.0, 1.0) == 2.0
    assert tracking_time(3.0, 0) == 1.5
    assert tracking_time(Fraction(9, 4), Fraction(1)) == Fraction(3, 2)
    assert tracking_time(2, 1) == math.sqrt(2)
    with pytest.raises(SettingError, match="irrational: give Tt as a fraction"):
        tracking_time(Fraction(2), Fraction(1))


def test_default_tracking_time_never_falls_below_the_sampling_interval():
    assert PidSettings(**GOOD).Tt == 2.0
    assert PidSettings(**{**GOOD, "Td": 0.001}).Tt == 0.5  # sqrt(0.004) = 0.063 < h/2 would diverge
    assert PidSettings(K=1.0, h=1.0).Tt is None


def test_from_a_named_form():
    s = PidSettings.of(PidStandard(2.0, math.inf, 1.0, b=0.5, N=5), h=0.1)
    assert (s.K, s.Ti, s.Td, s.Tf, s.b, s.c) == (2.0, None, 1.0, 0.2, 0.5, 0.0)


def test_each_rule_of_anti_windup_is_explained():
    assert set(ANTI_WINDUP) == {"tracking", "conditional", "conditional-safe", "clamping", "none"}
    for rule in ANTI_WINDUP:
        assert PidSettings(**GOOD, anti_windup=rule).anti_windup == rule
