"""The discrete controller by its gains: integral or derivative action alone, a published sequence."""

from fractions import Fraction as F

import numpy as np
import pytest

from loopbook.controllers.parallel_settings import ParallelSettings
from loopbook.controllers.pid import Pid
from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.controllers.settings import PidSettings, SettingError
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import simulate


def test_the_published_sequence_of_an_integrator_with_back_calculation():
    """ros control_toolbox: ki = 1, dt = 1, limits +-5, tracking time 1."""
    pid, errors = Pid(ParallelSettings(I=1, h=1, Tt=1, u_low=-5, u_high=5)), [1, 2, 3, 1, 2, -1, 1]
    outputs, integrals = [], []
    for e in errors:
        outputs.append(pid.step(0, e))
        integrals.append(pid.I)
    assert outputs == [0, 1, 3, 5, 5, 5, 4] and integrals == [1, 3, 6, 6, 7, 4, 5]
    again = Pid(ParallelSettings(I=1.0, h=1.0, Tt=1.0, u_low=-5.0, u_high=5.0))
    assert again.run([0.0] * 7, [float(e) for e in errors]).tolist() == outputs


@pytest.mark.parametrize(("b", "c", "Td", "Tf"), [(1, 0, 0, 0), (F(1, 2), 1, F(1, 3), F(1, 5)), (1, 0, 2, 0)])
def test_with_p_it_is_the_standard_form_exactly(b, c, Td, Tf):
    K, Ti, h = F(3, 2), F(7, 3), F(1, 10)
    standard = PidSettings(K=K, Ti=Ti, Td=Td, Tf=Tf, b=b, c=c, h=h, Tt=F(1))
    gains = ParallelSettings(P=K, I=K / Ti, D=K * Td, Tf=Tf, b=b, c=c, h=h, Tt=F(1))
    assert standard.gains() == gains.gains()
    y = [F(k % 5, 7) for k in range(20)]
    assert Pid(standard).run(y, F(1)) == Pid(gains).run(y, F(1))


def test_derivative_action_alone_filters_the_difference():
    """Backward difference of D s/(1 + s Tf) on the measurement: x(k) = p3 x(k-1) - D/(Tf + h) (y(k) - y(k-1))."""
    D, Tf, h = 2.0, 0.3, 0.1
    pid = Pid(ParallelSettings(D=D, Tf=Tf, h=h))
    y = np.sin(np.arange(40) * 0.3)
    found, x, before = [], 0.0, y[0]
    for value in y:
        x = Tf / (Tf + h) * x - D / (Tf + h) * (value - before)
        before = value
        found.append(x)
    assert np.allclose([pid.step(value, 0.0) for value in y], found, atol=1e-14)


def test_integral_action_alone_settles_a_process():
    integrator = Pid(ParallelSettings.of(PidParallel(0.0, 0.03), 0.5))
    run = simulate(Process([2], [10, 1], 1), integrator, 0.5, 1000, reference=1.0)
    assert run.y[-1] == pytest.approx(1.0, abs=1e-6)
    pid = Pid(ParallelSettings(I=0.1, h=1.0, u_high=1.0))
    assert pid.settings.Tt == 1.0, "without P the integral is set back within one sample"
    for _ in range(50):
        pid.step(0.0, 5.0)
    assert pid.I == pytest.approx(1.0 + 0.5), "no windup"


def test_settings_can_be_changed_without_a_bump():
    pid = Pid(ParallelSettings(P=1.0, I=0.2, h=0.1))
    before = [pid.step(0.1 * k, 1.0) for k in range(5)][-1]
    pid.change(P=0.0)
    assert pid._unlimited(0.4, 1.0) == pytest.approx(before + 0.2 * 0.1 * 0.6)
    assert ParallelSettings.of(PidStandard(2.0, 4.0, 1.0, N=5), 0.1).D == 2.0


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({}, "controls nothing"),
        ({"I": 1.0, "h": 0.0}, "h > 0"),
        ({"P": 1.0, "Tf": -1.0}, "Tf >= 0"),
        ({"P": 1.0, "b": 2.0}, "0 <= b"),
        ({"P": 1.0, "u_low": 1.0, "u_high": 0.0}, "u_low < u_high"),
        ({"P": 1.0, "rate": 0.0}, "rate > 0"),
        ({"P": float("nan")}, "finite real"),
        ({"I": 1.0, "Tt": 0.01}, "tracking diverges"),
        ({"I": 1.0, "anti_windup": "hope"}, "one of"),
    ],
)
def test_what_is_out_of_range_is_said(settings, says):
    with pytest.raises(SettingError, match=says):
        ParallelSettings(**{"h": 0.1, **settings})
    with pytest.raises(SettingError, match="no such setting"):
        ParallelSettings(P=1.0, h=0.1).changed(K=2.0)


def test_ints_beside_fractions_stay_exact():
    settings = ParallelSettings(P=1, I=F(1, 3), h=1, u_high=1)
    assert all(isinstance(u, F) for u in Pid(settings).run([0, 0, 0], F(1, 10)))
