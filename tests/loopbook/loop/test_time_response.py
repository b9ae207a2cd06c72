"""Responses as objects: against formulas, python-control and the loop's own responses; feedback by algebra."""

import control
import matplotlib
import numpy as np
import pytest

import loopbook as lb
from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.feedback import feedback, transfer_of
from loopbook.loop.time_response import impulse_response, ramp_response, step_response
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process

matplotlib.use("Agg")
LOOP = Loop(Process([2], [40, 14, 1], 3), PidStandard(0.6, 12))


def test_step_impulse_and_ramp_of_a_rational_process_as_python_control():
    P = Process([1, 3], [1, 2, 5])
    theirs = control.tf([1, 3], [1, 2, 5])
    t = np.linspace(0, 6, 121)
    assert np.allclose(step_response(P)(t[:60]), control.step_response(theirs, t[:60]).outputs, atol=1e-9)
    assert np.allclose(impulse_response(P)(t[:60]), control.impulse_response(theirs, t[:60]).outputs, atol=1e-9)
    assert np.allclose(ramp_response(P, 6.0)(t), control.forced_response(theirs, t, t).outputs, atol=1e-9)


def test_a_loop_s_responses_are_integrals_of_one_another():
    horizon = 60.0
    step, impulse, ramp = (of(LOOP, horizon) for of in (step_response, impulse_response, ramp_response))
    t = np.linspace(0, horizon, 500)
    assert np.abs(step(t) - LOOP.step("reference", horizon).y(t)).max() < 1e-12
    area = impulse["y"].signal.until(horizon).integral()
    assert area == pytest.approx(float(step(horizon)), abs=1e-11)
    assert step["y"].signal.until(horizon).integral() == pytest.approx(float(ramp(horizon)), rel=1e-11)


def test_a_ramp_of_a_type_one_loop_lags_by_one_over_the_velocity_gain():
    """e = 1/Kv with Kv = 2 * 0.6/12: the reference 1 s behind for each second per second."""
    assert 150.0 - float(ramp_response(LOOP, 150.0)(150.0)) == pytest.approx(12 / (2 * 0.6), rel=1e-6)


def test_it_shows_and_draws_itself():
    both = step_response({"fast": LOOP, "slow": Loop(LOOP.process, PidStandard(0.2, 12))})
    assert "overshoot [%]" in str(both) and "slow" in both._repr_html_()
    figure = both.plot()
    (axis,) = figure.axes
    assert axis.get_xlabel() == "time $t$ [s]" and len(figure.legends[0].texts) == 2
    assert both["fast"].metrics().overshoot == pytest.approx(LOOP.step().metrics().overshoot, rel=1e-9)
    assert "impulse" in impulse_response(LOOP).plot().axes[0].get_title()
    unstable = step_response(Process([1], [1, -1]))
    assert np.isnan(unstable["y"].final) and unstable["y"].metrics() is None and "nan" not in str(unstable)
    assert step_response(Process([1], [1, 0], 2))["y"].t[-1] == 20.0


def test_sampled_systems_answer_at_their_instants():
    sampled = sample(Process([1], [5, 1]), 1.0)
    assert float(step_response(sampled)(2.0)) == pytest.approx(1 - np.exp(-2 / 5))
    assert float(step_response(sampled)(2.9)) == pytest.approx(1 - np.exp(-2 / 5))
    assert float(impulse_response(sampled)(1.0)) == pytest.approx(1 - np.exp(-1 / 5))
    assert len(step_response({"held": sampled, "continuous": Process([1], [5, 1])}).plot().axes[0].lines) == 2


def test_what_has_no_response_is_said():
    with pytest.raises(ValueError, match="begins with an impulse"):
        impulse_response(Process([1, 0], [1, 1]))
    with pytest.raises(ValueError, match="no response"):
        step_response("x")
    with pytest.raises(ValueError, match="positive number of seconds"):
        step_response(LOOP, -1)
    with pytest.raises(ValueError, match="no system"):
        step_response({})


def test_feedback_takes_what_regulates():
    P = Process([2], [10, 1], 3)
    s = np.array([0.1j, 0.5 + 1j])
    C = PidParallel(0.8, 0.1, 0.3, 20)
    assert np.allclose(feedback(P, C)(s), P(s) / (1 + P(s) * C(s)), rtol=1e-13)
    assert np.allclose(feedback(P * transfer_of(C))(s), Loop(P, C).complementary_sensitivity(s), rtol=1e-13)
    assert feedback(2, 3)(0.0) == pytest.approx(2 / 7)
    ideal = transfer_of(PidParallel(1.0, 1.0, 1.0))  # improper: a differentiator is a transfer function too
    assert np.allclose(ideal(s), 1 + 1 / s + s)
    with pytest.raises(ValueError, match="no regulator"):
        feedback(P, "x")


@pytest.mark.parametrize("source", ["reference", "load", "noise", "disturbance"])
@pytest.mark.parametrize("output", ["y", "u"])
def test_every_closed_loop_transfer_function(source, output):
    B, A, W = [2, 1], [10, 7, 1], Process([3], [10, 7, 1], 1)
    loop = Loop(Process(B, A, 3), PidStandard(0.8, 10, 1, b=0.4, N=5), W)
    s = np.array([0.1j, 0.5 + 1j])
    T, S, R = (np.polyval(row, s) for row in (loop.polynomials.T, loop.polynomials.S, loop.polynomials.R))
    P = loop.process(s)
    to_y = {"reference": P * T / R, "load": P, "noise": -P * S / R, "disturbance": W(s)}[source] / (1 + P * S / R)
    to_u = (T / R if source == "reference" else -S / R if source == "noise" else 0.0) - S / R * to_y
    expected = to_y if output == "y" else to_u
    assert np.allclose(loop.closed(source, output)(s), expected, rtol=1e-12)


def test_closed_says_what_it_lacks():
    with pytest.raises(ValueError, match="one of reference"):
        LOOP.closed("nothing")
    with pytest.raises(ValueError, match="one of y, u"):
        LOOP.closed("load", "x")
    with pytest.raises(ValueError, match="needs the path"):
        LOOP.closed("disturbance")


def test_the_face_has_them():
    assert lb.feedback is feedback and lb.step_response is step_response
    assert lb.dcgain(LOOP) == pytest.approx(1.0) and lb.dcgain(lb.tf(2, [10, 1], 3)) == 2.0
    assert lb.dcgain(sample(Process([3], [5, 1]), 1.0)) == pytest.approx(3.0)
