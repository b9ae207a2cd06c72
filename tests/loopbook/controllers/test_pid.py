"""The discrete PID: against the document's programs, exact fractions, and its own defining properties."""

import math
from fractions import Fraction as F

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loopbook.controllers import (
    ANTI_WINDUP,
    BadMeasurement,
    BadMeasurementWarning,
    Pid,
    PidSettings,
    SettingError,
)
from loopbook.documents.pid_report.printed_programs import ProgramController

fractions = st.integers(-40, 40).map(lambda n: F(n, 8))
times = st.integers(1, 16).map(lambda n: F(n, 4))
signals = st.lists(st.tuples(fractions, fractions), min_size=2, max_size=12)
exact_settings = st.builds(
    lambda K, Ti, Td, Tf, h, Tt, b: PidSettings(
        K=K, Ti=Ti, Td=Td, Tf=Tf, h=h, Tt=h / 2 + Tt, b=b, u_low=F(-2), u_high=F(3)
    ),
    *(fractions.filter(bool), times, times, times, times, times),
    st.sampled_from([F(0), F(1, 2), F(1)]),
)


@settings(max_examples=60, deadline=None)
@given(setting=exact_settings, start=fractions, signals=signals)
@pytest.mark.long
def test_equal_to_figures_4_9_to_4_13(setting, start, signals):
    """Sample by sample, exactly, with limits that bind: controller and five programs agree to the last digit."""
    p24 = setting.K * setting.Td / (setting.Tf + setting.h)
    p11 = setting.Tf / (setting.Tf + setting.h)
    states = {
        "4.9": {"y_fold": start},
        "4.10": {"F_temp": p11 * start, "D_temp": -setting.K * setting.Td / setting.h * start},
        "4.11": {"y_old": start},
        "4.12": {"x": p24 * start},
        "4.13": {"x": p24 * start},
        "shortest": {"x": p24 * start, "w": p24 * start + setting.K * setting.b * signals[0][0]},
    }
    pid = Pid(setting, x=p24 * start)
    programs = {figure: ProgramController(figure, setting, **state) for figure, state in states.items()}
    for k, (y_sp, y) in enumerate(signals):
        u = pid.step(y, y_sp)
        for figure, program in programs.items():
            if figure == "shortest":  # it computes w with the set-point of the sample before
                program.states["w"] = pid.settings.K * pid.settings.b * y_sp + program.states["x"] + program.states["I"]
            assert program.step(y, y_sp) == u, f"figure {figure} departs at sample {k}"
            assert program.v == pid.v, f"figure {figure}"
            assert program.states["I"] == pid.I, f"figure {figure}"
        assert isinstance(u, F)


@settings(max_examples=40, deadline=None)
@given(
    setting=exact_settings,
    signals=signals,
    rule=st.sampled_from(sorted(ANTI_WINDUP)),
    rate=st.sampled_from([None, F(1)]),
)
def test_the_fast_path_is_the_same_controller(setting, signals, rule, rate):
    setting = setting.changed(anti_windup=rule, rate=rate)
    slow, fast = Pid(setting), Pid(setting)
    y_sp, y = zip(*signals, strict=True)
    assert fast.run(y, y_sp) == [slow.step(b, a) for a, b in signals]
    assert (fast.I, fast.x, fast.u, fast.v) == (slow.I, slow.x, slow.u, slow.v)
    assert fast.step(F(2), F(1)) == slow.step(F(2), F(1))


@pytest.mark.parametrize("rule", ANTI_WINDUP)
def test_without_limits_every_rule_is_the_same(rule):
    free = {"K": 2.0, "Ti": 3.0, "Td": 1.0, "Tf": 0.2, "h": 0.5}
    y = np.sin(np.arange(50) * 0.3)
    assert np.array_equal(Pid(PidSettings(**free)).run(y, 1.0), Pid(PidSettings(**free, anti_windup=rule)).run(y, 1.0))


@settings(max_examples=60, deadline=None)
@given(
    setting=exact_settings,
    signals=signals,
    rule=st.sampled_from(sorted(ANTI_WINDUP)),
    rate=st.sampled_from([None, F(1, 2)]),
)
def test_limits_hold(setting, signals, rule, rate):
    pid = Pid(setting.changed(anti_windup=rule, rate=rate))
    last = None
    for y_sp, y in signals:
        u = pid.step(y, y_sp)
        assert setting.u_low <= u <= setting.u_high
        if rate and last is not None:
            assert abs(u - last) <= rate * setting.h
        if rule == "clamping":
            assert setting.u_low <= pid.I <= setting.u_high
        last = u


def _frequency_gain(settings_: PidSettings, omega: float) -> complex:
    """-u/y of the recursion at z = exp(i omega h), from the z-transform of eqs 4.3 to 4.13."""
    s, z = settings_, np.exp(1j * omega * settings_.h)
    derivative = s.K * s.Td * (1 - 1 / z) / (s.Tf + s.h - s.Tf / z)
    integral = s.K * s.h / s.Ti / (z - 1)
    return s.K + integral + derivative


def test_frequency_response():
    """A sine in, after the transient: amplitude and phase of the discrete transfer function."""
    s = PidSettings(K=2.0, Ti=5.0, Td=1.0, Tf=0.3, h=0.2)
    omega, n = 2 * np.pi / 8.0, 4000
    t = np.arange(n) * s.h
    u = Pid(s).run(np.sin(omega * t), 0.0)
    tail = slice(n - 400, n)  # ten periods
    basis = np.column_stack([np.sin(omega * t[tail]), np.cos(omega * t[tail]), np.ones(400)])
    sine, cosine, _ = np.linalg.lstsq(basis, -u[tail], rcond=None)[0]
    assert abs((sine + 1j * cosine) - _frequency_gain(s, omega)) < 1e-9


def test_tends_to_the_continuous_controller():
    """For h -> 0 the discrete transfer function tends to K (1 + 1/(s Ti) + s Td/(1 + s Tf)), first order in h."""
    w = 0.7
    s = PidSettings(K=2.0, Ti=5.0, Td=1.0, Tf=0.3, h=1e-3)
    true = s.K * (1 + 1 / (1j * w * s.Ti) + 1j * w * s.Td / (1 + 1j * w * s.Tf))
    errors = [abs(_frequency_gain(s.changed(h=h), w) - true) for h in (2e-3, 1e-3)]
    assert errors[1] < 2e-3
    assert 1.9 < errors[0] / errors[1] < 2.1


@pytest.mark.parametrize(("c", "kick"), [(0, 0.0), (1, 2.0 * 1.0 / (0.1 + 0.5))])
def test_derivative_on_measurement_or_error(c, kick):
    """A set-point step of 1 gives K b at once, and K Td/(Tf + h) more with the derivative on the error."""
    pid = Pid(PidSettings(K=2.0, Ti=4.0, Td=1.0, Tf=0.1, h=0.5, b=0.3, c=c))
    before = pid.step(0.0, 0.0)
    assert math.isclose(pid.step(0.0, 1.0) - before, 2.0 * 0.3 + kick)


def test_a_first_sample_has_no_derivative_kick():
    pid = Pid(PidSettings(K=2.0, Td=1.0, Tf=0.1, h=0.5))
    assert math.isclose(pid.step(5.0, 0.0), -10.0)
    assert math.isclose(pid.step(5.0, 0.0), -10.0)


def test_without_integral_action_the_offset_stays():
    pid = Pid(PidSettings(K=0.1, h=1.0, u_low=0.0, u_high=10.0), I=9.0)
    assert [round(pid.step(y, 90.0), 12) for y in (90.0, 85.0)] == [9.0, 9.5]
    assert pid.I == 9.0


def test_conditional_as_printed_is_figure_4_7():
    """Same integral as the program, sample by sample, for a PI controller (figure 4.7 differs in D)."""
    s = PidSettings(K=F(3), Ti=F(2), h=F(1), u_low=F(-1), u_high=F(1), anti_windup="conditional", Tt=F(1))
    pid, program = Pid(s), ProgramController("4.7", s)
    for y in (0, 1, F(1, 4), -1, F(-1, 8), F(1, 16), 2):
        assert pid.step(F(y), F(0)) == program.step(F(y), F(0))
        assert program.states["I"] == pid.I


@pytest.mark.parametrize(("rule", "stuck"), [("conditional", True), ("conditional-safe", False)])
def test_conditional_integration_that_locks_up(rule, stuck):
    """I above the limit with a small error of the other sign: figure 4.7 never moves again."""
    pid = Pid(PidSettings(K=1.0, Ti=5.0, h=1.0, u_low=0.0, u_high=10.0, anti_windup=rule), I=12.0)
    outputs = [pid.step(51.0, 50.0) for _ in range(100)]
    assert (outputs[-1] == 10.0 and pid.I == 12.0) == stuck


@settings(max_examples=60, deadline=None)
@given(setting=exact_settings, start=fractions, error=fractions.filter(bool))
def test_conditional_safe_always_leaves_the_wrong_limit(setting, start, error):
    """With a constant error the output ends at the limit that the error asks for, from any I."""
    setting = setting.changed(anti_windup="conditional-safe", Td=F(0))
    pid = Pid(setting, I=start)
    rate = abs(setting.K * setting.h / setting.Ti * error)
    span = abs(start) + abs(setting.K * error) * 2 + 10
    samples = min(int(span / rate) + 2, 3000)
    for _ in range(samples):
        u = pid.step(F(0), error)
    if samples < 3000:
        assert u == (setting.u_high if setting.K * error > 0 else setting.u_low)


def test_tracking_unwinds_with_its_time_constant():
    """In saturation v - u shrinks by 1 - h/Tt per sample where the error is zero."""
    pid = Pid(PidSettings(K=1.0, Ti=5.0, h=1.0, Tt=4.0, u_low=0.0, u_high=10.0), I=18.0)
    excess = []
    for _ in range(4):
        pid.step(0.0, 0.0)
        excess.append(pid.v - pid.u)
    assert np.allclose(np.diff(np.log(excess)), math.log(0.75))


def _settled(pid: Pid, y_sp=5.0, y=5.0, samples=400):
    for _ in range(samples):
        pid.step(y, y_sp)
    return pid


BASE = PidSettings(K=2.0, Ti=4.0, Td=1.0, Tf=0.3, b=0.5, h=0.5, Tt=2.0)
CHANGES = [
    {"K": 3.0},
    {"b": 1.0},
    {"c": 1.0},
    {"Ti": 2.0},
    {"Td": 2.0},
    {"Td": 0.0},
    {"Tf": 0.0},
    {"h": 0.1},
    {"Tt": 9.0},
]
CHANGES += [{"K": -1.0, "Td": 3.0, "Tf": 1.0, "b": 0.0, "c": 0.3}]


@pytest.mark.parametrize("change", CHANGES, ids=str)
def test_exact_change_of_any_setting(change):
    """Steady: nothing moves, then or later. In motion: the output for the last signals is what it was."""
    quiet = _settled(Pid(BASE))
    u = quiet.u
    quiet.change(**change)
    assert all(math.isclose(quiet.step(5.0, 5.0), u, abs_tol=1e-9) for _ in range(20))
    moving = Pid(BASE)
    for y in (0.0, 1.0, 3.0):
        moving.step(y, 5.0)
    expected = moving._unlimited(3.5, 5.0)
    moving.step(3.5, 5.0)
    moving.change(**change)
    twin = Pid(BASE)
    for y in (0.0, 1.0, 3.0, 3.5):
        twin.step(y, 5.0)
    assert math.isclose(moving._unlimited(3.5, 5.0), twin._unlimited(3.5, 5.0), abs_tol=1e-9)
    assert expected == twin.v


def test_the_documents_change_lets_the_derivative_jump():
    """Eq. 4.10 in figure 4.13: at rest the output jumps by -(K' - K) Td/(Tf + h) y."""
    pid = _settled(Pid(BASE))
    u = pid.u
    pid.change("integral", K=3.0)
    assert math.isclose(pid.step(5.0, 5.0) - u, -1.0 * 1.0 / 0.8 * 5.0, abs_tol=1e-9)


def test_a_refused_change_changes_nothing():
    pid = _settled(Pid(BASE))
    before = (pid.settings, pid.I, pid.x, pid._gains)
    with pytest.raises(SettingError, match="Ti = 0 is outside its range"):
        pid.change(K=3.0, Ti=0)
    assert (pid.settings, pid.I, pid.x, pid._gains) == before


def test_manual_and_back():
    """Exact: the first automatic output is the operator's, whatever e is. Tracking: K Tt/Ti e away from it."""
    results = {}
    for transfer in ("exact", "tracking"):
        pid = _settled(Pid(BASE.changed(u_low=-100.0, u_high=100.0)))
        u = pid.u
        assert pid.manual() == u
        assert pid.step(5.0, 5.0) == u
        pid.manual(12.0)
        for _ in range(200):
            assert pid.step(4.0, 5.0) == 12.0
        pid.auto(transfer)
        results[transfer] = pid.step(4.0, 5.0) - 12.0
        assert pid.mode == "auto"
    assert math.isclose(results["exact"], 0.0, abs_tol=1e-12)
    assert math.isclose(results["tracking"], 2.0 * 2.0 / 4.0 * 1.0)


def test_manual_needs_an_output_within_the_limits():
    pid = Pid(BASE.changed(u_low=0.0, u_high=10.0))
    with pytest.raises(SettingError, match=r"u = None is outside its range: 0\.0 <= u <= 10\.0; no sample has run yet"):
        pid.manual()
    with pytest.raises(SettingError, match="u = 11 is outside its range"):
        pid.manual(11)
    with pytest.raises(SettingError, match="transfer = 'soft' is outside its range: exact or tracking"):
        pid.auto("soft")
    pid.manual(3.0)
    with pytest.raises(ValueError, match="the controller is in manual"):
        pid.run([1.0], 0.0)


@pytest.mark.parametrize(("y_sp", "y", "name"), [(0.0, math.nan, "y"), (0.0, math.inf, "y"), (math.nan, 0.0, "y_sp")])
def test_a_bad_measurement_keeps_the_state(y_sp, y, name):
    pid, twin = Pid(BASE), Pid(BASE)
    for controller in (pid, twin):
        controller.step(0.2, 1.0)
        controller.step(0.4, 1.0)
    with pytest.raises(
        BadMeasurement, match=f"{name} = (nan|inf) is not a finite number; state kept, last output"
    ) as caught:
        pid.step(y, y_sp)
    assert caught.value.output == twin.u
    assert pid.step(0.5, 1.0) == twin.step(0.5, 1.0)


def test_a_bad_measurement_can_be_held():
    pid = Pid(BASE, on_bad="hold")
    u = pid.step(0.2, 1.0)
    with pytest.warns(BadMeasurementWarning, match="y = nan is not a finite number"):
        assert pid.step(math.nan, 1.0) == u
    with pytest.raises(SettingError, match="on_bad = 'ignore'"):
        Pid(BASE, on_bad="ignore")


def test_a_bad_measurement_in_a_run_is_named():
    y = np.array([0.1, 0.2, math.nan, 0.3])
    with pytest.raises(BadMeasurement, match="y = nan at sample 2"):
        Pid(BASE).run(y, 1.0)
    held = Pid(BASE, on_bad="hold")
    with pytest.warns(BadMeasurementWarning):
        u = held.run(y, 1.0)
    assert u[2] == u[1]
    without = Pid(BASE).run(y[[0, 1, 3]], 1.0)
    assert np.array_equal(u[[0, 1, 3]], without)


def test_run_fills_an_array_and_checks_lengths():
    out = np.empty(3)
    assert Pid(BASE).run([0.0, 0.1, 0.2], 1.0, out) is out
    assert np.isfinite(out).all()
    with pytest.raises(ValueError, match="2 set-points for 3 measurements"):
        Pid(BASE).run([0.0, 0.1, 0.2], [1.0, 1.0])
