"""Step metrics of responses that are known everywhere: slow creep, many equal lags, jumps, dead time of any length."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import gammaincinv

from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.without_dead_time import metrics
from loopbook.process.transfer_function import Process
from loopbook.response.signal_metrics import measures
from loopbook.response.step_metrics import StepMetricsError, exact_metrics


@pytest.mark.parametrize("unit", [1e-6, 1.0, 3e4])
@pytest.mark.parametrize("Ti", [100, 1000, 1e6])
@pytest.mark.long
def test_slow_creep_does_not_hide_the_overshoot(Ti, unit):
    """25/(s + 1)^2 under PI: a fast swing as without integral action, then a creep that lasts Ti."""
    loop = Loop(Process([25], [unit**2, 2 * unit, 1]), PidStandard(1, Ti * unit))
    found = loop.step().metrics()
    A = np.array([[0, 1, 0], [-26, -2, 25 / Ti], [-1, 0, 0]])
    run = solve_ivp(lambda t, x: A @ x + [0, 25, 1], (0, 6), np.zeros(3), rtol=1e-12, atol=1e-13, dense_output=True)
    t = np.linspace(0, 6, 600_001)
    y = run.sol(t)[0]
    assert found.overshoot == pytest.approx(100 * (y.max() - 1), rel=1e-7)
    assert found.peak_time == pytest.approx(t[y.argmax()] * unit, rel=1e-4)
    low, high = (t[np.argmax(y >= share)] for share in (0.1, 0.9))
    assert found.rise == pytest.approx((high - low) * unit, rel=1e-4)
    assert round(found.rise / unit, 3) == 0.243


def test_the_case_as_published():
    found = Loop(Process([25], [1, 2, 1]), PidStandard(1, 1000)).step().metrics()
    assert (round(found.overshoot, 2), round(found.rise, 3)) == (47.48, 0.243)


@pytest.mark.parametrize("unit", [1e-7, 1.0, 5e5])
@pytest.mark.parametrize("n", [1, 2, 5, 7, 8, 12, 20])
def test_equal_lags_settle_where_the_incomplete_gamma_function_says(n, unit):
    found = metrics(Process([1], np.poly([-1.0] * n) * unit ** np.arange(n, -1, -1.0)))
    assert found.settling == pytest.approx(unit * gammaincinv(n, 0.98), rel=1e-9)
    assert found.rise == pytest.approx(unit * (gammaincinv(n, 0.9) - gammaincinv(n, 0.1)), rel=1e-9)
    assert found.overshoot == found.undershoot == 0.0


def test_the_published_figure_of_seven_lags():
    assert round(metrics(Process([1], np.poly([-1.0] * 7))).settling, 3) == 13.436


@pytest.mark.parametrize("delay", [0.0, 0.3, 5.0, 1e4])
def test_dead_time_delays_what_is_counted_from_the_step(delay):
    found, without = metrics(Process.fopdt(1, 10, delay)), metrics(Process.fopdt(1, 10, 0))
    assert found.settling == pytest.approx(delay + 10 * np.log(50), rel=1e-12)
    assert found.rise == pytest.approx(without.rise, rel=1e-11)


@pytest.mark.parametrize(
    "lead, lag, gain", [(3, 2, 1), (1.01, 1, -4.0), (0.3, 1, 2.0), (-0.5, 1, 1.0), (40.0, 1.0, 1e6)]
)
def test_a_process_that_acts_at_once_steps_from_rest(lead, lag, gain):
    """y = gain (1 + (lead/lag - 1) exp(-t/lag)), zero before the step."""
    found, jump = metrics(Process([gain * lead, gain], [lag, 1])), lead / lag
    assert found.overshoot == pytest.approx(max(0.0, 100 * (jump - 1)), abs=1e-9)
    assert found.undershoot == pytest.approx(max(0.0, -100 * jump), abs=1e-9)
    assert found.settling == pytest.approx(lag * np.log(abs(jump - 1) / 0.02) if abs(jump - 1) > 0.02 else 0, abs=1e-9)
    reaches = lambda share: lag * np.log((1 - jump) / (1 - share)) if jump < share else 0.0  # noqa: E731
    assert found.rise == pytest.approx(reaches(0.9) - reaches(0.1), abs=1e-9)


def test_the_published_case_of_a_lead():
    found = metrics(Process([3, 1], [2, 1]))
    assert (round(found.overshoot, 6), round(found.settling, 2)) == (50.0, 6.44)


def test_a_loop_that_answers_at_once():
    """PI with the process 1 exp(-L s) and with a lead: the jump counts as overshoot."""
    loop = Loop(Process([2, 1], [1, 1]), PidStandard(3.0, 2.0))
    found = loop.step().metrics()
    assert loop.step().y(0.0) == pytest.approx(6 / 7)
    assert found.rise < loop.step().y.roots(0.9)[0] + 1e-12
    function = loop.step().y
    assert exact_metrics(lambda t: function(t), 1.0, function.end, rest=0.0).settling == pytest.approx(
        found.settling, rel=1e-9
    )


@pytest.mark.parametrize("seed", range(12))
def test_signal_and_function_agree_where_a_grid_suffices(seed):
    rng = np.random.default_rng(seed)
    loop = Loop(Process.fopdt(1, 1, rng.uniform(0.2, 2)), PidStandard(rng.uniform(0.2, 0.9), rng.uniform(0.8, 2)))
    if not loop.is_stable:
        loop = loop.with_gain(0.3)
    y = loop.step().y
    delay = loop.process.delay
    corners = delay * np.arange(1, int(y.end / delay) + 1)
    grid = exact_metrics(lambda t: y(t), 1.0, y.end, breakpoints=corners, points=40_000)
    known = exact_metrics(y, 1.0, y.end)
    for name in ("rise", "settling", "overshoot", "undershoot"):
        assert getattr(known, name) == pytest.approx(getattr(grid, name), rel=1e-8, abs=1e-8)
    assert measures(y, 1.0, 0.02, (0.1, 0.9)).peak == known.peak


@pytest.mark.parametrize("T, L", [(10, 1e-3), (10, 1e-6), (3600, 1e-3), (1e-3, 1e-8)])
def test_dead_times_far_shorter_than_the_loop(T, L):
    """They approach the loop without dead time in proportion to L."""
    pid = PidStandard(2, T / 2)
    with_delay, without = (Loop(Process.fopdt(1, T, delay), pid).step() for delay in (L, 0.0))
    twice = Loop(Process.fopdt(1, T, 2 * L), pid).step()
    for name in ("rise", "settling", "overshoot"):
        a, b, c = (getattr(r.metrics(), name) for r in (without, with_delay, twice))
        assert b == pytest.approx(a, rel=20 * L / T)
        assert c - b == pytest.approx(b - a, rel=100 * L / T + 1e-3, abs=1e-10 * a)
    assert with_delay.iae() == pytest.approx(without.iae(), rel=20 * L / T)


def test_long_cells_continue_the_method_of_steps():
    """Thousands of dead times on one mesh each, and the same in cells that span many of them."""
    loop = Loop(Process([1], [1, 3, 3, 1], 0.004), PidStandard(2.0, 1.5, 0.3, N=10))
    short, long = loop.step(horizon=0.004 * 60), loop.step(horizon=20.0)
    t = np.linspace(0, short.horizon, 500)
    assert np.abs(long.u(t) - short.u(t)).max() < 1e-12 * abs(long.peak_input()[1])
    for at in (2.0, 2 + 3j, 1.7 - 9j):
        closed = loop.transfer(at) * loop.polynomials.feedforward(at) / loop.polynomials.feedback(at)
        assert _laplace(long.y, at) == pytest.approx(closed / (1 + loop.transfer(at)) / at, rel=1e-12)


def _laplace(y, s):
    """The integral of y exp(-s t) over all cells by Gauss's rule: what the transfer function must give."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    half = y.lengths[:, None] / 2
    t = y.edges[:-1, None] + half * (nodes + 1)
    return (y(t) * np.exp(-s * t) * weights * half).sum()


def test_no_step_no_metrics():
    with pytest.raises(StepMetricsError, match="ends where it begins"):
        metrics(Process([1, 0], [1, 2, 1]))
    tiny = metrics(Process([1e-20], [1, 1]))
    assert tiny.settling == pytest.approx(np.log(50)) and tiny.peak == pytest.approx(1e-20)
