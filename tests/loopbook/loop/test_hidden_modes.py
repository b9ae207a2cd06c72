"""What process and regulator cancel on the border or to the right of it stays in the loop, and is said."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.regulator import Regulator
from loopbook.loop.continuous import Loop
from loopbook.loop.transfer import LoopError
from loopbook.process.transfer_function import Process

DIFFERENTIATING = Process([1, 0], [1, 2, 1])


@pytest.mark.parametrize("delay", [0.0, 0.4])
@pytest.mark.parametrize("unit", [1.0, 1e-6, 2e5])
def test_integral_action_on_a_process_that_differentiates(delay, unit):
    process = Process([unit, 0], [unit**2, 2 * unit, 1], delay * unit)
    loop = Loop(process, PidStandard(1, 2 * unit))
    assert not loop.is_stable
    for ask in (
        lambda: loop.unstable_roots,
        lambda: loop.decay_rate,
        loop.margins,
        loop.step,
        lambda: loop.final_values("reference"),
        lambda: loop.final_values("load"),
        lambda: loop.step(horizon=5 * unit).metrics(),
        lambda: loop.step(horizon=5 * unit).iae(),
    ):
        with pytest.raises(LoopError, match=r"not internally stable.*cancel a factor at s = 0"):
            ask()


def test_its_input_ramps():
    """y of s/(s + 1)^2 settles, u = e + int e/2 grows for ever: by an integration of the differential equations."""
    response = Loop(DIFFERENTIATING, PidStandard(1, 2)).step(horizon=60)

    def slope(t, x):
        error = 1 - x[1]
        u = error + x[2]
        return [x[1] - 0 * u, u - 2 * x[1] - x[0], error / 2]  # x0' = y, y' = u - 2 y - x0: y = s/(s + 1)^2 u

    found = solve_ivp(slope, (0, 60), [0, 0, 0], rtol=1e-10, atol=1e-12, dense_output=True)
    t = np.linspace(1, 60, 50)
    assert response.u(t) == pytest.approx(1 - found.sol(t)[1] + found.sol(t)[2], rel=1e-7)
    assert np.diff(response.u([50, 60])) == pytest.approx(10 * np.diff(response.u([55, 56])), rel=1e-3)


def test_a_cancelled_oscillator_and_a_cancelled_unstable_pole():
    notch = Regulator.one_dof([1, 0, 4], [1, 3, 2])
    for delay in (0.0, 0.3):
        loop = Loop(Process([0.1], [1, 0, 4], delay), notch)
        assert not loop.is_stable
        with pytest.raises(LoopError, match=r"internally stable.*s = 2j"):
            loop.margins()
    unstable = Loop(Process([1, -1], [1, 2, 1]), Regulator.one_dof([0.1], [1, -1]))
    assert unstable.unstable_roots == 1


def test_a_factor_that_the_process_itself_holds_twice_is_no_mode_of_the_loop():
    """s/(s (s + 1)) is 1/(s + 1)."""
    loop, same = (Loop(p, PidStandard(2, 1)) for p in (Process([1, 0], [1, 1, 0], 0.2), Process([1], [1, 1], 0.2)))
    assert loop.is_stable
    assert loop.margins() == same.margins()
    assert loop.final_values("load") == same.final_values("load") == (0.0, -1.0)
