"""Predictors, cascades and feedforward: by block algebra at complex s, by closed forms in time, by counted poles."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.loop.cascade import CascadeLoop
from loopbook.loop.continuous import Loop
from loopbook.loop.feedforward import FeedforwardLoop, feedforward
from loopbook.loop.general import GeneralLoop
from loopbook.loop.roots import poles
from loopbook.loop.smith import SmithLoop
from loopbook.loop.transfer import LoopError
from loopbook.process.transfer_function import Process

S = np.array([0.05j, 0.3j, 0.1 + 1j, -0.1 + 0.2j])


def random_loop(rng):
    den = np.ones(1)
    for T in 10 ** rng.uniform(-1, 1, int(rng.integers(1, 4))):
        den = np.convolve(den, [T, 1])
    if rng.random() < 0.3:
        den = np.convolve(den, [1, 0])
    Td = rng.uniform(0, 1) * (rng.random() < 0.5)
    process = Process([1], den, 10 ** rng.uniform(-1, 0.7))
    return process, PidStandard(rng.uniform(0.1, 2), rng.uniform(2, 20), Td, N=5)


@pytest.mark.parametrize("seed", range(40))
def test_a_general_loop_of_one_dead_time_is_a_loop(seed):
    """Stability, all margins and crossovers by intervals on sums of exponentials, and by polynomials."""
    process, regulator = random_loop(np.random.default_rng(seed))
    one, other = Loop(process, regulator), GeneralLoop(process, regulator)
    assert one.unstable_roots == other.unstable_roots
    if not one.is_stable:
        with pytest.raises(LoopError, match="unstable"):
            other.margins()
        return
    a, b = one.margins(), other.margins()
    for name in ("gain", "gain_low", "phase", "delay"):
        assert getattr(b, name) == pytest.approx(getattr(a, name), rel=1e-10)
    assert (b.Ms.value, b.Mt.value) == pytest.approx((a.Ms.value, a.Mt.value), rel=1e-10)
    assert b.Ms.w == pytest.approx(a.Ms.w, rel=1e-6)
    assert [c.w for c in b.gain_crossovers] == pytest.approx([c.w for c in a.gain_crossovers], rel=1e-10)
    assert other.decay_rate == pytest.approx(one.decay_rate, rel=2e-6)


@pytest.mark.parametrize("k", [2.3e-7, 4.1e6])
def test_a_general_loop_in_other_units_of_time(k):
    def loop(f):
        echo = Process([1], [20 * f * f, 9 * f, 1], 1 * f) + Process([0.5], [4 * f, 1], 2.6 * f)
        return GeneralLoop(echo, PidStandard(0.4, 6 * f))

    one, other = loop(1.0), loop(k)
    a, b = one.margins(), other.margins()
    assert (b.gain, b.phase, b.Ms.value) == pytest.approx((a.gain, a.phase, a.Ms.value), rel=1e-9)
    assert (b.delay / k, b.Ms.w * k, other.decay_rate * k) == pytest.approx((a.delay, a.Ms.w, one.decay_rate), rel=1e-9)
    t = np.linspace(0, 80, 200)
    assert np.abs(one.step("load", 80.0).y(t) - other.step("load", 80.0 * k).y(t * k)).max() < 1e-11


def test_margins_of_an_echo_are_where_it_becomes_unstable():
    echo = Process([1], [2, 1], 1) + Process([0.5], [2, 1], 3)
    m = GeneralLoop(echo, 0.5).margins()
    for factor, stable in ((0.999, True), (1.001, False)):
        assert GeneralLoop(echo * (m.gain * factor), 0.5).is_stable is stable
    w = np.linspace(1e-3, 60, 400_001)
    distance = np.abs(1 + 0.5 * echo(1j * w))
    assert m.Ms.value == pytest.approx(1 / distance.min(), rel=1e-6)


MODEL, PI = Process([2], [10, 1], 6), PidStandard(2.0, 10)


def test_a_right_predictor_takes_the_dead_time_out_of_the_loop():
    loop = SmithLoop(MODEL, PI)
    t = np.linspace(0, 40, 401)
    inside = Process([0.4], [1, 0.4], 6)  # 2 (10 s + 1)/(10 s + 1) 2/(10 s) = 0.4/s closed, behind the dead time
    assert np.abs(loop.step("reference", 40.0).y(t) - inside.step(t)).max() < 1e-12
    assert loop.step("reference", 60.0).final[0] == pytest.approx(1.0)
    assert loop.is_stable and np.allclose(np.asarray(poles(loop)), [-0.1, -0.1, -0.4], atol=1e-9)


@pytest.mark.parametrize("true", [MODEL, Process([2.4], [12, 1], 7.5), Process([1.8], [24, 11, 1], 5)])
@pytest.mark.parametrize(("source", "output"), [(a, b) for a in ("reference", "load", "noise") for b in "yu"])
def test_a_predictor_by_block_algebra(true, source, output):
    loop = SmithLoop(true, PI, model=MODEL)
    G, M, C = true(S), MODEL.rational(S) * (1 - np.exp(-6 * S)), PI(S)
    Q = C / (1 + C * M)  # the regulator with its predictor
    to_y = {"reference": G * Q, "load": G, "noise": -G * Q}[source] / (1 + G * Q)
    to_u = (Q if source == "reference" else -Q if source == "noise" else 0.0) - Q * to_y
    assert np.allclose(loop.closed(source, output)(S), to_y if output == "y" else to_u, rtol=1e-10)
    assert np.allclose(loop.transfer(S), G * Q, rtol=1e-10)


@pytest.mark.parametrize("gain", [0.6, 2.0])
def test_how_wrong_the_dead_time_may_be(gain):
    """Just inside the range the poles lie to the left, just outside they do not; in between everywhere to the left."""
    model = Process([2], [10, 1], 8)
    loop = SmithLoop(model, PidStandard(gain, 10))
    low, high = loop.robustness().delay
    assert low < 8 < high and loop.robustness().model_delay == 8
    for delay, stable in ((high * 0.9999, True), (high * 1.0001, False), (low * 1.0001, True), (low * 0.9999, False)):
        if 0 < delay:
            assert loop.with_delay(delay - 8).is_stable is stable, delay
    assert all(loop.with_delay(x - 8).is_stable for x in np.linspace(max(low, 0.01), high, 23)[1:-1])
    gains = loop.robustness().gain
    assert loop.with_gain(gains.high * 0.999).is_stable and not loop.with_gain(gains.high * 1.001).is_stable
    assert "model has 8 s" in str(loop.robustness())


def test_a_wrong_predictor_in_time_by_small_steps():
    """The blocks one by one, u held for h: the difference falls with h."""
    true, t = Process([2], [10, 1], 7.0), np.linspace(0, 60, 61)
    y = SmithLoop(true, PI, model=MODEL).step("reference", 60.0).y(t)
    errors = []
    for h in (0.01, 0.0025):
        n, pole = round(60 / h), np.exp(-h / 10)
        x, late, model_late, integral = np.zeros(n + 1), round(7 / h), round(6 / h), 0.0
        for k in range(n):
            seen = x[max(k - late, 0)] * (k >= late) + x[k] - x[max(k - model_late, 0)] * (k >= model_late)
            u = PI.K * (1 - seen) + integral
            integral += PI.K / PI.Ti * h * (1 - seen)
            x[k + 1] = pole * x[k] + 2 * (1 - pole) * u
        slow = np.concatenate([np.zeros(late), x])[: n + 1]
        errors.append(np.abs(slow[np.round(t / h).astype(int)] - y).max())
    assert errors[1] < 3e-3 and errors[1] == pytest.approx(errors[0] / 4, rel=0.1)


def test_what_a_predictor_cannot_do_is_said():
    assert not SmithLoop(Process([1], [10, -1], 1), PidStandard(3, 10)).is_stable, "an unstable model"
    with pytest.raises(LoopError, match="acts at once"):
        SmithLoop(Process([1, 1], [2, 1], 1), 1.0).is_stable  # noqa: B018
    with pytest.raises(LoopError, match="only 6 s"):
        SmithLoop(MODEL, PI).with_delay(-7)


CASCADE = CascadeLoop(
    Process([2], [5, 1], 0.5), Process([1], [40, 1], 4), PidStandard(2.0, 6, b=0.5), PidStandard(3.0, 40, 1, N=8)
)


@pytest.mark.parametrize("source", ["reference", "inner load", "outer load", "noise"])
@pytest.mark.parametrize("output", ["y", "y1", "u", "r1"])
def test_a_cascade_by_block_algebra(source, output):
    P1, P2 = CASCADE.inner_process(S), CASCADE.outer_process(S)
    c1, c2 = CASCADE.inner.polynomials, Loop(CASCADE.outer_process, CASCADE.outer_regulator).polynomials
    F1, B1, F2, B2 = c1.feedforward(S), c1.feedback(S), c2.feedforward(S), c2.feedback(S)
    r, d1, d2, n = (float(source == name) for name in ("reference", "inner load", "outer load", "noise"))
    # r1 = F2 r - B2 (y + n), u = F1 r1 - B1 y1, y1 = P1 (u + d1), y = P2 (y1 + d2): four equations at each s
    for i in range(len(S)):
        matrix = np.array(
            [[1, 0, 0, B2[i]], [-F1[i], 1, B1[i], 0], [0, -P1[i], 1, 0], [0, 0, -P2[i], 1]], dtype=complex
        )
        right = np.array([F2[i] * r - B2[i] * n, 0, P1[i] * d1, P2[i] * d2])
        r1, u, y1, y = np.linalg.solve(matrix, right)
        expected = {"y": y, "y1": y1, "u": u, "r1": r1}[output]
        assert complex(CASCADE.closed(source, output)(S[i])) == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_margins_of_a_cascade_are_where_it_becomes_unstable():
    assert CASCADE.is_stable and CASCADE.unstable_roots == 0
    outer, inner = CASCADE.margins(), CASCADE.inner_margins()
    for factor, stable in ((0.999, True), (1.001, False)):
        P1, P2, C1, C2 = (
            CASCADE.inner_process, CASCADE.outer_process, CASCADE.inner_regulator, CASCADE.outer_regulator,
        )  # fmt: skip
        assert CascadeLoop(P1, P2 * (outer.gain * factor), C1, C2).is_stable is stable
        assert CascadeLoop(P1, P2.delayed(outer.delay * factor), C1, C2).is_stable is stable
        assert CascadeLoop(P1 * (inner.gain * factor), P2, C1, C2).is_stable is stable
        assert CascadeLoop(P1.delayed(inner.delay * factor), P2, C1, C2).is_stable is stable
    assert CASCADE.inner.margins().gain != pytest.approx(inner.gain), "the outer loop takes some of it"


def test_a_cascade_in_time():
    """No dead time, proportional inside: the same as one loop, by the other solver."""
    cascade = CascadeLoop(Process([2], [5, 1]), Process([1], [40, 1], 4), 4.0, PidStandard(3.0, 40))
    one = Loop(Process([8], [5, 9]) * Process([1], [40, 1], 4), PidStandard(3.0, 40))
    t = np.linspace(0, 150, 300)
    ours = cascade.closed("reference", "y").step_signal(150.0)(t)
    assert np.abs(ours - one.step("reference", 150.0).y(t)).max() < 1e-12
    assert cascade.closed("inner load", "y").static_gain == pytest.approx(0, abs=1e-12)
    assert cascade.closed("reference", "y").static_gain == pytest.approx(1)
    with pytest.raises(ValueError, match="inner load"):
        cascade.closed("load", "y")


def test_ideal_feedforward_takes_the_disturbance_away():
    P, W = Process([2], [10, 1], 1), Process([3], [30, 13, 1], 4)
    F = feedforward(P, W)
    assert F.exact and not F.said and F.transfer.delay == 3
    loop = FeedforwardLoop(P, PidStandard(0.8, 10), W, F.transfer)
    assert not any(loop.closed("disturbance", "y").num) and loop.is_stable
    assert loop.margins() == Loop(P, PidStandard(0.8, 10)).margins()
    s = np.array([0.1j, 1j])
    assert np.allclose(loop.closed("disturbance", "u")(s), F.transfer(s))


def test_feedforward_that_comes_too_late_leaves_what_arrives_before():
    P, W, C = Process([2], [10, 1], 4), Process([3], [5, 1], 1), PidStandard(0.8, 10)
    F = feedforward(P, W)
    assert not F.exact and "3 s before" in F.said and F.transfer.delay == 0
    loop = FeedforwardLoop(P, C, W, F)
    s = np.array([0.1j, 0.4 + 1j])
    around = (W(s) + P(s) * F.transfer(s)) / (1 + P(s) * C(s))
    assert np.allclose(loop.closed("disturbance", "y")(s), around, rtol=1e-11)
    assert np.allclose(loop.closed("disturbance", "u")(s), F.transfer(s) - C(s) * around, rtol=1e-11)
    with_it, without = loop.step("disturbance", 80.0), Loop(P, C, W).step("disturbance", 80.0)
    assert with_it.y.peak()[1] == pytest.approx(3 * (1 - np.exp(-3 / 5)), rel=1e-9), "3 s of W's own step, then it acts"
    assert with_it.y.integral_of_magnitude() < 0.7 * without.y.integral_of_magnitude()
    assert np.abs(with_it.y(np.linspace(0, 3.9, 9)) - without.y(np.linspace(0, 3.9, 9))).max() < 1e-12


def test_what_cannot_be_fed_forward_is_said():
    P, W = Process([2], [40, 14, 1], 1), Process([3], [5, 1], 4)
    with pytest.raises(LoopError, match="differentiates 1 times"):
        feedforward(P, W)
    assert "behind 1 lag of 2 s" in feedforward(P, W, filter=2.0).said
    with pytest.raises(LoopError, match="a zero with real part 1 1/s"):
        feedforward(Process([-1, 1], [1, 2, 1]), W)
    with pytest.raises(LoopError, match="no gain"):
        feedforward(Process([0], [1]), W)


@pytest.mark.parametrize(
    ("regulator", "settles"),
    [
        (PidParallel(0.0, 0.05), 1.0),  # I alone
        (PidParallel(0.0, 0.0, 2.0, 5.0), 0.0),  # D alone
        (PidParallel(0.0, 0.05, 1.0, 5.0), 1.0),  # I and D
    ],
)
def test_integral_or_derivative_action_alone(regulator, settles):
    process = Process([2], [10, 1], 1)
    loop = Loop(process, regulator)
    s = np.array([0.2j, 0.5 + 0.1j])
    D = regulator.D * s / (1 + s * regulator.Tf) if regulator.D else 0.0
    assert np.allclose(regulator(s), regulator.I / s + D, rtol=1e-13)
    assert loop.is_stable and loop.final_values("reference")[0] == pytest.approx(settles, abs=1e-12)
    assert loop.margins().Ms.value >= 1.0 and SmithLoop(process, regulator).is_stable
    assert float(loop.step("reference", 400.0).y(400.0)) == pytest.approx(settles, abs=1e-6)
