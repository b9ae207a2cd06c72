"""Each experiment gives its own model back, tells what it assumed, and refuses what it cannot read."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from loopbook.documents.pid_report.batch.processes import batch, four_lags
from loopbook.experiments import (
    combination,
    double_pulse,
    integrating_step,
    relay,
    self_oscillation,
    short_pulse,
    sine,
    step,
)
from loopbook.experiments.data import FrequencyData, StepData
from loopbook.experiments.plant import ExperimentError, Plant
from loopbook.loop.process_phase import NoSuchFrequency, frequency_at, phase
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.frequency_response import response
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record
from notebook_reports.ledger.verdicts import rounds_to

FOPDT = Process.fopdt(2.0, 3.0, 1.0)
INTEGRATING = Process.integrating(2.0, 1.0, 0.5)
EXAMPLE = four_lags(0.1)


def test_example_process_gives_the_printed_inputs():
    found, point = step.step_data(EXAMPLE), ultimate(EXAMPLE)
    assert rounds_to(found.L, "0.075") and rounds_to(found.T, "1.04") and found.Kp == 1
    assert rounds_to(point.K180, "0.0091") and rounds_to(point.T180, "0.199")


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_step_gives_the_model_back(noise):
    found = step.estimate(step.apply_step(Plant(FOPDT, noise=noise, seed=3))).data
    tolerance = 1e-3 if not noise else 0.04
    assert found.Kp == pytest.approx(2, rel=tolerance)
    assert pytest.approx(3, rel=tolerance) == found.T
    assert pytest.approx(1, rel=tolerance) == found.L


def test_recorded_step_agrees_with_the_exact_one():
    for process in (EXAMPLE, Process((-0.5, 1.0), (1.0, 3.0, 3.0, 1.0))):
        exact, read = step.step_data(process), step.estimate(step.apply_step(Plant(process, samples=20001))).data
        for name in ("Kp", "T", "L"):
            assert getattr(read, name) == pytest.approx(getattr(exact, name), rel=1e-3)


@settings(deadline=None, max_examples=20)
@given(st.floats(0.1, 10), st.floats(0.2, 5), st.floats(0.05, 5))
def test_exact_step_data_of_a_first_order_process(gain, T, L):
    found = step.step_data(Process.fopdt(gain, T, L))
    assert (found.Kp, found.T, found.L) == pytest.approx((gain, T, L), rel=1e-9)


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_integrating_step(noise):
    found = integrating_step.estimate(integrating_step.apply_long_step(Plant(INTEGRATING, noise=noise))).data
    exact = integrating_step.slope_data(INTEGRATING)
    assert (exact.Kv, exact.L) == (2.0, 1.5)
    assert found.Kv == pytest.approx(2, rel=2e-3)
    assert pytest.approx(1.5, rel=0.01) == found.L


def test_double_pulse_gives_the_model_back():
    found = double_pulse.estimate(double_pulse.apply_double_pulse(Plant(FOPDT, samples=20001), 1.5))
    assert (found.data.Kp, found.data.T, found.data.L) == pytest.approx((2, 3, 1), rel=2e-3)
    assert found.marks["L_from_max"] == pytest.approx(found.marks["L_from_min"], rel=2e-3)


@given(st.floats(0.1, 10), st.floats(0.2, 5), st.floats(0.05, 5), st.floats(0.1, 3))
def test_double_pulse_formulas_invert_the_extremes(gain, T, L, width):
    y_max = gain * (1 - math.exp(-width / T))
    y_min = -y_max * (1 - math.exp(-width / T))
    found = double_pulse.solve(1.0, width, y_max, y_min, L + width, L + 2 * width)
    assert found == pytest.approx((gain, T, L, L), rel=1e-6)


def test_short_pulse_error_falls_with_its_width():
    errors = []
    for width in (0.2, 0.1, 0.05):
        found = short_pulse.estimate(short_pulse.apply_pulse(Plant(INTEGRATING, samples=20001), width)).data
        errors.append(abs(found.L1 - 1.0))
        assert found.Kv == pytest.approx(2, rel=1e-3)
    assert errors[0] > errors[1] > errors[2]
    exact = short_pulse.pulse_data(INTEGRATING)
    assert (exact.Kv, exact.T2, exact.L1) == pytest.approx((2, 0.5, 1), rel=1e-9)
    assert pytest.approx(integrating_step.slope_data(INTEGRATING).L) == exact.step.L


def test_sine_finds_the_ultimate_point():
    found, tried = sine.search(Plant(FOPDT), 0.3, 5)
    point = ultimate(FOPDT)
    assert pytest.approx(point.K180, rel=1e-6) == found.data.K180
    assert pytest.approx(point.T180, rel=1e-6) == found.data.T180
    assert len(tried) > 5


def test_clipped_sine_is_exact():
    """Against a plain integration of 3 y' + y = 2 u(t - 1) with the clipped sine."""
    from scipy.integrate import solve_ivp

    record = Plant(FOPDT, low=-0.6, high=0.8).play_sine(1.0, 1.3, 20.0)
    u = lambda t: min(max(math.sin(1.3 * t), -0.6), 0.8) if t > 0 else 0.0  # noqa: E731
    solved = solve_ivp(lambda t, y: (2 * u(t - 1) - y) / 3, (0, 20), [0.0], max_step=0.01, rtol=1e-9, atol=1e-11)
    assert np.interp(solved.t, record.time, record.y) == pytest.approx(solved.y[0], abs=2e-5)
    assert record.u.max() == 0.8 and record.u.min() == -0.6


def test_relay_oscillates_near_the_ultimate_point():
    found, point = relay.estimate(relay.apply_relay(Plant(EXAMPLE))), ultimate(EXAMPLE)
    assert pytest.approx(point.T180, rel=0.06) == found.data.T180
    assert pytest.approx(point.K180, rel=0.08) == found.data.K180


@pytest.mark.parametrize("member", [m for m in batch() if m.family == 3][:6], ids=lambda m: m.name)
def test_the_relay_does_not_chatter_on_rounding_errors(member):
    """Fast lags: the output starts as t^3 and is for long no larger than its rounding errors about zero."""
    found, point = relay.estimate(relay.apply_relay(Plant(member.process, samples=2001))), ultimate(member.process)
    assert pytest.approx(point.T180, rel=0.06) == found.data.T180


def test_relay_period_of_a_first_order_process_is_exact():
    """With e^-Ls/(1+sT) and no hysteresis: y peaks at 1 - e^(-L/T), half a period is L + T log(2 - e^(-L/T))."""
    record = relay.apply_relay(Plant(Process.fopdt(1.0, 3.0, 1.0), samples=40001))
    found = relay.estimate(record)
    assert pytest.approx(1 + 3 * math.log(2 - math.exp(-1 / 3)), rel=5e-4) == found.data.T180 / 2
    assert found.marks["y_a"] == pytest.approx(1 - math.exp(-1 / 3), rel=5e-4)
    assert pytest.approx(math.pi / 4 * (1 - math.exp(-1 / 3)), rel=5e-4) == found.data.K180


def test_hysteresis_moves_the_phase_as_the_describing_function_says():
    record = relay.apply_relay(Plant(EXAMPLE), hysteresis=0.01)
    found = relay.estimate(record, 0.01)
    actual = math.degrees(float(phase(EXAMPLE, np.array(2 * math.pi / found.data.T180))))
    assert found.marks["phase"] > -170
    assert actual == pytest.approx(found.marks["phase"], abs=6)


def test_self_oscillation_finds_the_ultimate_gain():
    found, _ = self_oscillation.search(Plant(EXAMPLE), 20)
    point = ultimate(EXAMPLE)
    assert pytest.approx(point.K180, rel=1e-5) == found.data.K180
    assert pytest.approx(point.T180, rel=1e-5) == found.data.T180


def test_noise_is_seeded():
    one, two, other = (step.apply_step(Plant(FOPDT, noise=0.1, seed=s)).y for s in (1, 1, 2))
    assert (one == two).all() and (one != other).any()


def test_actuator_limits_scale_what_is_learnt_correctly():
    limited = step.estimate(step.apply_step(Plant(FOPDT, high=0.25), amplitude=1.0))
    assert limited.marks["du"] == 0.25
    assert limited.data.Kp == pytest.approx(2, rel=1e-3)


def test_printed_grid_search():
    found = combination.grid(StepData(1, 1.04, 0.075), FrequencyData(0.0091, 0.199))
    assert rounds_to(found.error * 1e7, "1.5161")
    assert rounds_to(found.data.T1, "0.9988") and rounds_to(found.data.T2, "0.1057")
    assert rounds_to(found.data.L1, "0.0102")
    assert found.tried == 100000 and not found.equal_lags
    assert found.largest_e2 < 1e-7 and found.largest_e3 < 1e-14


@settings(deadline=None, max_examples=25)
@given(st.floats(0.5, 5), st.floats(0.05, 0.95), st.floats(0.02, 1))
@example(0.5, 0.25, 0.875)
def test_bracketing_gives_the_two_lags_back(T1, alpha, L1):
    process = Process((1.5,), tuple(np.polymul([T1, 1], [alpha * T1, 1])), L1)
    point = ultimate(process)
    from scipy.optimize import brentq

    lack = lambda t: (T1 * math.exp(-t / T1) - alpha * T1 * math.exp(-t / (alpha * T1))) / (T1 - alpha * T1)  # noqa: E731
    t63 = L1 + brentq(lambda t: lack(t) - math.exp(-1), 0, 50 * T1)
    tangent = step.step_data(process).L
    found = combination.solve(StepData(1.5, t63 - tangent, tangent), FrequencyData(point.K180, point.T180))
    assert pytest.approx((T1, alpha * T1, L1), rel=1e-5) == (found.T1, found.T2, found.L1)


def test_bracketing_is_more_exact_than_the_grid():
    data = StepData(1, 1.04, 0.075), FrequencyData(0.0091, 0.199)
    grid, found = combination.grid(*data), combination.solve(*data, tail=0.37)
    alpha = found.T2 / found.T1
    assert abs(combination.residual(alpha, *data, tail=0.37)) < 1e-14 < grid.error
    assert abs(alpha - grid.alpha) < 1e-5


def test_frequency_tools():
    w = np.geomspace(0.01, 10, 50)
    for member in batch()[::17]:
        value, slope = response(member.process, w)
        ahead, _ = response(member.process, w * (1 + 1e-6))
        assert slope * w * 1e-6 == pytest.approx(ahead - value, rel=1e-3, abs=1e-12)
        assert np.exp(1j * phase(member.process, w)) == pytest.approx(value / abs(value), rel=1e-9)
    with pytest.raises(NoSuchFrequency, match="does not pass -180 degrees"):
        frequency_at(Process((1.0,), (1.0, 1.0)), -math.pi)


def plain_record(u, y):
    return Record(np.linspace(0, 10, len(u)), u, y)


RAMP = np.linspace(0, 10, 400)
STEP_INPUT = np.where(RAMP > 1, 1.0, 0.0)
REFUSED = {
    "step on an integrator": (lambda: step.estimate(plain_record(STEP_INPUT, RAMP)), "no steady state"),
    "exact step on an integrator": (lambda: step.step_data(INTEGRATING), "use integrating_step"),
    "no answer": (lambda: step.estimate(plain_record(STEP_INPUT, 0 * RAMP)), "does not answer"),
    "two steps": (lambda: step.estimate(plain_record(STEP_INPUT + (RAMP > 5), RAMP)), "changes 2 times"),
    "negative gain": (lambda: step.estimate(plain_record(STEP_INPUT, -STEP_INPUT * (1 - np.exp(-RAMP)))), "negative"),
    "integrating step on a lag": (
        lambda: integrating_step.estimate(step.apply_step(Plant(FOPDT))),
        "use step.estimate",
    ),
    "one pulse": (lambda: double_pulse.estimate(short_pulse.apply_pulse(Plant(INTEGRATING), 0.1)), "double pulse"),
    "pulse extremes": (lambda: double_pulse.solve(1, 1, 0.5, -0.9, 1, 2), "0 < -y_min < y_max"),
    "relay too slow": (lambda: relay.apply_relay(Plant(FOPDT), hysteresis=5.0), "does not oscillate"),
    "relay chatters": (lambda: relay.apply_relay(Plant(Process((1.0,), (1.0, 1.0)))), "add hysteresis or dead time"),
    "relay input": (lambda: relay.estimate(plain_record(RAMP, RAMP)), "a relay has two"),
    "sine range": (lambda: sine.search(Plant(FOPDT), 0.1, 0.5), "does not pass -180 degrees"),
    "sine on an integrator": (lambda: sine.apply_sine(Plant(INTEGRATING), 1.0), "use the relay experiment"),
    "oscillation shrinks": (
        lambda: self_oscillation.estimate(self_oscillation.apply_gain(Plant(EXAMPLE), 60), 60),
        "raise the gain",
    ),
    "oscillation grows": (
        lambda: self_oscillation.estimate(self_oscillation.apply_gain(Plant(EXAMPLE), 160), 160),
        "lower the gain",
    ),
    "oscillation saturates": (
        lambda: self_oscillation.apply_gain(Plant(EXAMPLE, high=1.0), 100),
        "make the step smaller",
    ),
    "never oscillates": (lambda: self_oscillation.apply_gain(Plant(Process((1.0,), (1.0, 1.0))), 5), "does not make"),
    "kappa": (
        lambda: combination.solve(StepData(1, 0.1, 1), FrequencyData(1.2, 2.0)),
        "use amigo-step-pi or amigo-step-pid",
    ),
    "no two lags": (lambda: combination.solve(StepData(1, 5, 0.1), FrequencyData(0.5, 1.0)), "no T2/T1"),
    "limits": (lambda: Plant(FOPDT, low=1.0), "working point 0 must lie between"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_the_reason(case):
    call, words = REFUSED[case]
    with pytest.raises(ExperimentError, match=words):
        call()
