"""Loops and regulators in sums and products, and every question asked of everything that has an answer to it."""

import numpy as np
import pytest

import loopbook as lb
from loopbook.process.transfer_function import DelayedSum, Process, TransferFunction

P, C = lb.tf(2, [[10, 1], [4, 1]], 3), lb.PidStandard(0.5, 10, 1, N=8)
ECHO, LAG = P + lb.tf(1, [2, 1], 1), lb.tf(1, [2, 1], 1)
LOOP = lb.Loop(P, C)
IN_Z = lb.c2d(P.rational, 0.5, "tustin")
RST = lb.place(lb.sample(P, 0.5), 0.8).regulator
SAMPLED = lb.SampledLoop(P, RST)
CASCADE = lb.CascadeLoop(lb.tf(2, [5, 1], 0.5), lb.tf(1, [40, 1], 4), 4.0, lb.PidStandard(3.0, 40.0))
FORWARD = lb.FeedforwardLoop(LAG, C, lb.tf(3, [10, 1], 4), lb.feedforward(LAG, lb.tf(3, [10, 1], 4)))
CONTINUOUS = [P, P / 2, ECHO, P.feedback(), LOOP, lb.GeneralLoop(ECHO, 0.2), lb.SmithLoop(P, C), CASCADE, FORWARD]
PULSED = [IN_Z, lb.sample(P, 0.5), lb.DiscreteLoop(IN_Z, 0.5), SAMPLED]
NAMES = [type(one).__name__ for one in (*CONTINUOUS, *PULSED)]
S = 0.05 + 0.3j


def of(system, s):
    return complex((system.closed() if hasattr(system, "closed") else system)(s))


@pytest.mark.parametrize("loop", CONTINUOUS[4:], ids=lambda loop: type(loop).__name__)
def test_a_loop_stands_for_what_it_makes_of_its_reference(loop):
    value = of(loop, S)
    for found, expected in (
        (2 * loop, 2 * value),
        (loop / np.float64(4), value / 4),
        (-loop, -value),
        (loop + P, value + of(P, S)),
        (P - loop, of(P, S) - value),
        (loop * loop, value**2),
        (loop - loop, 0),
        (loop**2, value**2),
        (1 / loop, 1 / value),
        (loop.feedback(0.5), value / (1 + 0.5 * value)),
        (lb.feedback(loop, LAG), value / (1 + value * of(LAG, S))),
        (lb.feedback(P, loop), of(P, S) / (1 + value * of(P, S))),
    ):
        assert of(found, S) == pytest.approx(expected, rel=1e-10, abs=1e-12)


def test_a_loop_in_z_does_too():
    loop, z = lb.DiscreteLoop(IN_Z, 0.5), np.exp(0.2j)
    value = of(loop, z)
    assert of(2 * loop - IN_Z, z) == pytest.approx(2 * value - of(IN_Z, z))
    assert of(loop**2, z) == pytest.approx(value**2) and of(IN_Z**-1, z) == pytest.approx(1 / of(IN_Z, z))
    assert of(SAMPLED.feedback(0.1), z) == pytest.approx(of(SAMPLED, z) / (1 + 0.1 * of(SAMPLED, z)))


@pytest.mark.parametrize(
    "regulator", [C, lb.PidStandard(2, 4, 1), lb.PidParallel(0, 0.1), lb.PidSeries(1, 5, 1, N=5), C.regulator()]
)
def test_a_regulator_in_a_product_is_its_feedback_path(regulator):
    value = complex(regulator.feedback(S) if isinstance(regulator, lb.Regulator) else regulator(S))
    for found in (P * regulator, regulator * P):
        assert of(found, S) == pytest.approx(value * of(P, S), rel=1e-12)
    assert of(ECHO * regulator, S) == pytest.approx(value * of(ECHO, S), rel=1e-12)
    assert of(1 + regulator * LAG, S) == pytest.approx(1 + value * of(LAG, S), rel=1e-12)
    assert of(lb.feedback(P, regulator), S) == pytest.approx(of(P, S) / (1 + value * of(P, S)), rel=1e-12)


def test_margins_of_a_product_are_those_of_the_loop():
    assert lb.margins(P * C) == LOOP.margins()
    assert lb.margins(ECHO * 0.3).Ms.value == pytest.approx(lb.GeneralLoop(ECHO, 0.3).margins().Ms.value)
    assert lb.margins(lb.sample(P, 0.5)) == lb.DiscreteLoop(lb.sample(P, 0.5), 1.0).margins()
    assert isinstance(P * C, Process) and isinstance(ECHO * 0.3, DelayedSum)


@pytest.mark.parametrize("system", [*CONTINUOUS, *PULSED], ids=NAMES)
def test_poles_zeros_and_gain_of_everything(system):
    """Each root is one: the function is large or small there; and the gain is its value at rest."""
    closed = system.closed() if hasattr(system, "closed") else system
    for root in np.asarray(lb.poles(system))[:4]:
        assert root.real < 1.01 and np.isfinite(root)
    pulses, at_rest = hasattr(closed, "h"), 1.0 if hasattr(closed, "h") else 0.0
    for zero in np.asarray(lb.zeros(system))[:4]:
        if abs(zero) > 1e-9 and not pulses:
            assert abs(of(closed, zero)) < 1e-6 * abs(of(closed, zero + 0.1)), zero
    gain = lb.dcgain(system)
    near = (
        complex(closed.num @ np.ones(len(closed.num)) / sum(closed.den))
        if not callable(closed)
        else of(closed, at_rest)
    )
    assert gain == pytest.approx(near.real, rel=1e-6)


@pytest.mark.parametrize("system", [*CONTINUOUS, *PULSED], ids=NAMES)
def test_responses_of_everything(system):
    """A ramp is the integral of a step, a step that of an impulse; at the end of a step stands the gain."""
    step, impulse, ramp = (f(system, 200.0) for f in (lb.step_response, lb.impulse_response, lb.ramp_response))
    assert float(step(200.0)) == pytest.approx(lb.dcgain(system), rel=2e-3)
    if isinstance(system, Process | DelayedSum | TransferFunction) or hasattr(system, "characteristic"):
        t = np.linspace(0.0, 60.0, 24001)
        for whole, slope in ((step, impulse), (ramp, step)):
            summed = np.concatenate([[0.0], np.cumsum((slope(t)[1:] + slope(t)[:-1]) / 2) * (t[1] - t[0])])
            assert np.abs(summed - whole(t)).max() < 2e-3 * max(1.0, np.abs(whole(t)).max())
    else:
        k = np.arange(0.0, 100.0, 0.5)
        assert np.cumsum(impulse(k)) == pytest.approx(step(k), abs=1e-6)
        assert np.cumsum(0.5 * step(k))[:-1] == pytest.approx(ramp(k)[1:], abs=1e-4 * 100)


@pytest.mark.parametrize("system", [*CONTINUOUS, *PULSED], ids=NAMES)
def test_step_figures_of_everything(system):
    found = lb.step_info(system)
    y = lb.step_response(system, 400.0)
    t = np.linspace(0.0, 400.0, 400_001)
    values = y(t)
    outside = np.flatnonzero(np.abs(values - found.final) > 0.02 * abs(found.final))
    assert found.final == pytest.approx(lb.dcgain(system), rel=1e-9)
    assert found.settling == pytest.approx(
        t[outside[-1]], abs=0.51 if hasattr(system, "h") or system is SAMPLED else 2e-3
    )
    assert found.peak == pytest.approx(np.abs(values).max(), rel=1e-3)


@pytest.mark.parametrize("system", [*CONTINUOUS, *PULSED], ids=NAMES)
def test_crossovers_of_everything(system):
    found = lb.crossovers(system)
    assert found.stable in (True, False)
    if found.stable and hasattr(system, "margins"):
        m = system.margins()
        assert [c.w for c in found.gain_crossovers] == pytest.approx([c.w for c in m.gain_crossovers])
        assert [c.w for c in found.phase_crossovers] == pytest.approx([c.w for c in m.phase_crossovers])


def test_what_does_not_settle_is_said():
    with pytest.raises(ValueError, match="does not settle"):
        lb.step_info(lb.DiscreteProcess.in_z([1], [1, -1], 0.1))
    with pytest.raises(ValueError, match="its own samples"):
        lb.step_info(IN_Z, [0.0, 1.0])
    with pytest.raises(ValueError, match="no response"):
        lb.step_response(object())
    with pytest.raises(ValueError, match="no gain"):
        lb.dcgain(object())


def test_sums_have_poles_and_zeros_of_their_own():
    assert ECHO.poles.real == pytest.approx([-0.1, -0.25, -0.5])
    closed = P.feedback(0.5)
    assert np.abs(1 + 0.5 * P(closed.poles)).max() < 1e-9 and not closed.zeros.size
    assert (2 * lb.tf("s") + 1).zeros.real == pytest.approx([-0.5])
