"""Crossovers, margins, sensitivity peaks and stability with exact dead time, each by a second route."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from loopbook.controllers.pid_forms import PidParallel
from loopbook.loop.continuous import Loop
from loopbook.loop.margins import gain_crossovers, margins, phase_crossovers
from loopbook.loop.sensitivity_peaks import _Axis, complementary_peak, sensitivity_peak
from loopbook.loop.stability import decay_rate, is_stable, shifted, unstable_roots
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.process.transfer_function import Process

TANK = Process([1 / 8360], [35, 12, 1], 2)
TUNED = PidParallel(25194.1165104731, 1956.14979824376, 68803.105267141, 28.6213074510803)


def walton_marshall(num, den, delay):
    """Roots in the right half plane by another method: count them without dead time, then let it grow and count those
    that cross the axis at the frequencies with |n| = |d|, in the direction of the slope of |d|^2 - |n|^2."""
    count = int((np.roots(np.polyadd(den, num)).real > 0).sum())

    def squared(p):
        turned = np.asarray(p) * 1j ** np.arange(len(p) - 1, -1, -1)
        return np.real(np.polymul(turned, np.conj(turned)))

    difference = np.polysub(squared(den), squared(num))
    x = np.roots(difference[(len(difference) - 1) % 2 :: 2])
    for w in np.sqrt(x[(abs(x.imag) < 1e-9 * abs(x)) & (x.real > 0)].real):
        turn = np.angle(-np.polyval(num, 1j * w) / np.polyval(den, 1j * w)) % (2 * np.pi)
        crossings = int(np.floor((delay * w - turn) / (2 * np.pi))) + 1
        count += 2 * int(np.sign(np.polyval(np.polyder(difference), w))) * max(crossings, 0)
    return count


coefficient = st.floats(-3, 3).filter(lambda c: abs(c) > 1e-2)


@st.composite
def loops(draw):
    order = draw(st.integers(1, 5))
    den = draw(st.lists(coefficient, min_size=order + 1, max_size=order + 1)) + [0.0] * draw(st.integers(0, 2))
    num = draw(st.lists(coefficient, min_size=1, max_size=order))
    return LoopTransfer(tuple(num), tuple(den), draw(st.floats(0.05, 8)))


def away_from_the_border(loop):
    return all(abs(abs(c.phase_margin)) > 1e-3 for c in gain_crossovers(loop)) and all(
        abs(np.log(c.gain)) > 1e-6 for c in phase_crossovers(loop, 0.5)
    )


@settings(max_examples=150, deadline=None)
@given(loops())
@pytest.mark.long
def test_the_argument_count_agrees_with_roots_that_cross_the_axis(loop):
    """Any rational part: unstable, integrating, non-minimum-phase; any dead time."""
    free = np.roots(np.polyadd(loop.den, loop.num))
    assume((abs(free.real) > 1e-6).all() and abs(loop.den[-1] + loop.num[-1]) > 1e-6)
    assume((abs(loop.poles.real[loop.poles != 0]) > 1e-6).all())
    assume(away_from_the_border(loop))
    assert unstable_roots(loop) == walton_marshall(loop.num, loop.den, loop.delay)


@pytest.mark.parametrize("delay", [0.3, 1.0, 5.0])
def test_integrator_with_dead_time_is_stable_below_half_pi(delay):
    limit = np.pi / 2 / delay
    assert unstable_roots(LoopTransfer([0.999 * limit], [1, 0], delay)) == 0
    assert unstable_roots(LoopTransfer([1.001 * limit], [1, 0], delay)) == 2
    assert unstable_roots(LoopTransfer([5.001 * limit], [1, 0], delay)) == 4
    assert not is_stable(LoopTransfer([limit], [1, 0], delay))


@pytest.mark.parametrize("gain", [1e-9, 1.0, 1e9])
def test_an_integrator_without_dead_time_is_stable_for_every_positive_gain(gain):
    loop = LoopTransfer([gain], [1, 0], 0.0)
    assert unstable_roots(loop) == 0 and is_stable(loop)
    assert (margins(loop).gain, margins(loop).phase) == (np.inf, pytest.approx(90))
    assert unstable_roots(LoopTransfer([-gain], [1, 0], 0.0)) == 1


def test_an_unstable_process_with_dead_time_bears_gain_between_two_limits():
    """1/(s - 1) exp(-sL) under P control: 1 < K < sqrt(1 + w^2) with w = tan(w L)."""
    from scipy.optimize import brentq

    delay = 0.4
    w = brentq(lambda w: np.tan(w * delay) - w, 0.5 / delay, (np.pi / 2 - 1e-6) / delay)
    loop = margins(LoopTransfer([1.5], [1, -1], delay))
    assert loop.gain_low == pytest.approx(1 / 1.5, rel=1e-12)
    assert loop.gain == pytest.approx(np.hypot(1, w) / 1.5, rel=1e-12)
    assert unstable_roots(LoopTransfer([1.001], [1, -1], delay)) == 0
    assert unstable_roots(LoopTransfer([0.999], [1, -1], delay)) == 1
    assert unstable_roots(LoopTransfer([1.001 * np.hypot(1, w)], [1, -1], delay)) == 2


def test_margins_of_an_integrator_with_dead_time():
    """k/s exp(-sL): wc = k, phase margin 90 degrees - k L, gain margin pi/(2 k L), delay margin its angle over k."""
    k, delay = 0.7, 0.9
    m = margins(LoopTransfer([k], [1, 0], delay))
    assert m.gain == pytest.approx(np.pi / 2 / (k * delay), rel=1e-13)
    assert m.phase == pytest.approx(90 - np.degrees(k * delay), rel=1e-13)
    assert m.delay == pytest.approx((np.pi / 2 - k * delay) / k, rel=1e-13)
    assert m.gain_low == 0
    assert len(m.gain_crossovers) == 1


def test_the_tuned_double_tank():
    """Phase margin 60 degrees with the exact dead time; the other margins as double-tank's Table 3 prints them."""
    m = Loop(TANK, TUNED).margins()
    assert m.phase == pytest.approx(60, abs=1e-10)
    assert round(m.gain_decibels) == 10
    loop = Loop(TANK, TUNED)
    assert loop.with_gain(0.999 * m.gain).is_stable
    assert not loop.with_gain(1.001 * m.gain).is_stable
    assert loop.with_delay(0.999 * m.delay).is_stable
    assert not loop.with_delay(1.001 * m.delay).is_stable


def test_conditionally_stable_loop_has_a_lower_gain_margin():
    """Triple lag with two integrators: stable only between two gains."""
    loop = LoopTransfer(tuple(4 * np.poly([-1, -1])), (1, 0.5, 0.0, 0.0), 0.05)
    m = margins(loop)
    assert 0 < m.gain_low < 1 < m.gain < np.inf
    for factor, stable in ((1.001 * m.gain_low, True), (0.999 * m.gain_low, False), (0.999 * m.gain, True)):
        assert is_stable(LoopTransfer(tuple(factor * np.array(loop.num)), loop.den, loop.delay)) == stable


def test_a_late_turn_of_the_nyquist_curve_decides():
    """A lightly damped mode at 30 rad/s behind a slow process: the margin lies on a turn far out."""
    den = np.polymul([1, 1], [1 / 900, 0.01 / 30, 1])
    m = margins(LoopTransfer([0.3], tuple(den), 0.21))
    slow = margins(LoopTransfer([0.3], (1, 1), 0.21))
    assert m.gain < slow.gain / 5
    decisive = min((c for c in m.phase_crossovers if c.gain > 1), key=lambda c: c.gain)
    assert 28 < decisive.w < 32
    assert not is_stable(LoopTransfer([0.3 * 1.001 * m.gain], tuple(den), 0.21))


@settings(max_examples=60, deadline=None)
@given(loops())
@pytest.mark.long
def test_no_crossover_is_missed_and_none_invented(loop):
    """Against sign changes on a fine grid, on which neighbouring crossovers cannot hide from us but from the grid."""
    w = np.geomspace(1e-4, 1e3, 60_001)
    value = loop(1j * w)
    found = loop.phase_crossovers(0.02)
    assert (abs(np.angle(-loop(1j * found))) < 1e-6).all()
    smooth = abs(np.angle(value[1:] / value[:-1])) < 0.3
    there = (value.imag[:-1] * value.imag[1:] < 0) & (value.real[:-1] < 0) & (abs(value[1:]) > 0.021) & smooth
    for at in np.flatnonzero(there):
        assert ((found > w[at] * (1 - 1e-9)) & (found < w[at + 1] * (1 + 1e-9))).any()
    gains = loop.gain_crossovers
    for at in np.flatnonzero((abs(value[1:]) - 1) * (abs(value[:-1]) - 1) < 0):
        assert ((gains >= w[at]) & (gains <= w[at + 1])).any()
    assert (abs(loop.magnitude(gains) - 1) < 1e-6).all()


@settings(max_examples=60, deadline=None)
@given(loops())
@pytest.mark.long
def test_sensitivity_peaks_are_never_below_what_a_grid_sees(loop):
    w = np.geomspace(1e-4, 1e3, 60_001)
    value = loop(1j * w)
    try:
        Ms, Mt = sensitivity_peak(loop), complementary_peak(loop)
    except LoopError as error:
        assert "border" in str(error)
        return
    seen, seen_t = 1 / abs(1 + value), abs(value) / abs(1 + value)
    assert Ms.value >= seen.max() * (1 - 2e-6)
    assert Mt.value >= seen_t.max() * (1 - 2e-6)
    if np.isfinite(Ms.w) and Ms.w > 0:
        assert 1 / abs(1 + loop(1j * Ms.w)) == pytest.approx(Ms.value, rel=1e-9)


def test_peaks_of_a_neutral_loop_are_limits():
    """0.6 exp(-s): the curve is a circle that comes within 0.4 of -1 again and again."""
    loop = LoopTransfer([0.6], [1], 1.0)
    assert sensitivity_peak(loop).value == pytest.approx(2.5)
    assert complementary_peak(loop).value == pytest.approx(1.5)
    assert margins(loop).gain == pytest.approx(1 / 0.6)
    assert unstable_roots(LoopTransfer([1.2], [1], 1.0)) == np.inf


@pytest.mark.long
def test_margins_of_rational_loops_agree_with_python_control():
    import control

    for num, den in (([3], [1, 3, 3, 1]), ([0.5], [1, 2, 1, 0]), ([20, 20], [1, 11, 10, 0])):
        ours, (gm, pm, _, _) = margins(LoopTransfer(num, den)), control.margin(control.tf(num, den))[:4]
        assert ours.gain == pytest.approx(gm, rel=1e-6) or (ours.gain == gm == np.inf)
        assert ours.phase == pytest.approx(pm, rel=1e-6)


def test_decay_rate_of_a_double_root():
    """s + k exp(-s) with k = 1/e has its rightmost root, a double one, at -1."""
    assert decay_rate(LoopTransfer([np.exp(-1)], [1, 0], 1.0)) == pytest.approx(1, rel=1e-3)


def test_decay_rate_is_where_a_response_dies():
    loop = Loop(TANK, TUNED)
    rate = loop.decay_rate
    assert unstable_roots(shifted(loop.transfer, 0.999 * rate)) == 0
    assert unstable_roots(shifted(loop.transfer, 1.001 * rate)) > 0
    error = loop.step(horizon=160).error
    decades = np.log(abs(error(100.0) / error(150.0))) / 50
    assert decades == pytest.approx(rate, rel=0.02)


def test_a_hidden_unstable_mode_counts():
    """Process and regulator cancel (s - 1): the loop transfer hides it, the loop does not."""
    loop = Loop(Process([1, -1], [1, 3, 2], 0.3), PidParallel(1, 0))
    assert loop.is_stable
    from loopbook.controllers.regulator import Regulator

    hidden = Loop(Process([1], [1, 1, -2], 0.3), Regulator.one_dof([0.2, -0.2], [1, 2]))
    assert not hidden.is_stable
    assert hidden.unstable_roots == 1


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda: unstable_roots(LoopTransfer([1, 0, 0], [1, 1], 1)), "more zeros than poles"),
        (lambda: unstable_roots(LoopTransfer([np.pi / 2], [1, 0], 1)), "border of stability.* s = 1.5708j"),
        (lambda: unstable_roots(LoopTransfer([1], [1, 0, 0], 0)), "border"),
        (lambda: margins(LoopTransfer([2], [1, 0], 1)), "unstable .2 roots"),
        (lambda: sensitivity_peak(LoopTransfer([np.pi / 2], [1, 0], 1)), "border"),
        (lambda: LoopTransfer([0.6], [1], 1.0).phase_crossovers(0.5), "infinitely many"),
        (lambda: decay_rate(LoopTransfer([2], [1, 0], 1)), "nothing decays"),
    ],
)
def test_errors_say_what_is_wrong(ask, says):
    with pytest.raises(LoopError, match=says):
        ask()


@settings(max_examples=60, deadline=None)
@given(loop=loops())
def test_what_a_survey_says_of_an_interval_holds_on_all_of_it(survey_holds, loop):
    edges = np.concatenate([[0.0], np.geomspace(1e-3, 1e2, 60)])
    for curve in (_Axis(loop, inverse=False), _Axis(loop, inverse=True)):
        survey_holds(curve, edges)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(0.1, 5), max_size=4), st.floats(0, 4), st.floats(0.05, 0.9), st.floats(0.1, 2))
def test_the_decay_rate_is_counted_on_both_sides(lags, delay, share, Ti):
    """All roots to the left of -rate, and one to the right a little further: by the other method of counting too."""
    den = np.polymul(np.poly([-1 / lag for lag in lags]) * np.prod(lags), [1, 0])
    gain = share / (delay + sum(lags) + Ti)
    loop = LoopTransfer((gain * Ti, gain), tuple(np.atleast_1d(den)), delay)
    assume(is_stable(loop))
    rate = decay_rate(loop)
    assert is_stable(shifted(loop, rate))
    assert not is_stable(shifted(loop, rate * (1 + 1e-6)))
    for factor in (0.999, 1.001):
        there = shifted(loop, rate * factor)
        assert (walton_marshall(there.num, there.den, delay) > 0) == (factor > 1)


def test_the_two_sensitivities_add_up_to_one():
    loop, s = Loop(TANK, TUNED), 1j * np.geomspace(1e-3, 10, 50)
    assert loop.sensitivity(s) + loop.complementary_sensitivity(s) == pytest.approx(1.0, abs=1e-12)
    peak = complementary_peak(loop.transfer)
    assert abs(loop.complementary_sensitivity(1j * peak.w)) == pytest.approx(peak.value, rel=1e-9)


@pytest.mark.parametrize("T", [1.0, 1e-6, 3e7])
@pytest.mark.parametrize("num, den, K", [((1, 1), (1, -1), 3), ((2, 1), (1, 1), 0.6), ((2, 1), (1, 1), 0.5)])
def test_a_loop_gain_that_stays_above_one_bears_no_dead_time(num, den, K, T):
    """Neutral: |L| >= 1 at infinite frequency, so that any dead time brings roots to the right or to the axis."""
    process = Process([num[0] * T, num[1]], [den[0] * T, den[1]])
    assert Loop(process, K).margins().delay == 0.0
    assert not Loop(process.delayed(1e-9 * T), K).is_stable


@pytest.mark.parametrize("seed", range(10))
def test_peaks_of_a_loop_that_does_not_fall_off_with_dead_time(seed):
    """Its curve turns for ever at one radius; Ms and Mt are found before that or are the limit, as on a dense grid."""
    draw = np.random.default_rng(seed)
    n = int(draw.integers(1, 4))
    num = np.poly(-(10 ** draw.uniform(-1, 1, n)) * draw.choice([-1, 1], n))
    process = Process(
        draw.uniform(0.05, 0.9) * num, np.poly(-(10 ** draw.uniform(-1, 1, n))), 10 ** draw.uniform(-2, 0.5)
    )
    loop = Loop(process, 1.0)
    while not loop.is_stable:
        loop = loop.with_gain(0.7)
    found = loop.margins()
    w = np.append(1e-9, np.geomspace(1e-3, 1e5, 400_001))
    G = loop.transfer(1j * w)
    for peak, grid in ((found.Ms, abs(1 / (1 + G)).max()), (found.Mt, abs(G / (1 + G)).max())):
        assert grid * (1 - 1e-6) <= peak.value <= grid * 1.02, peak
        if np.isfinite(peak.w) and peak.w:
            at = loop.transfer(1j * peak.w)
            assert peak.value == pytest.approx(abs((at if peak is found.Mt else 1) / (1 + at)), rel=1e-9)
