"""A proportional regulator with a limited output: between the linear loop at its ultimate gain and a relay.

With a gain far above the ultimate one and no limit the loop diverges; with a limit it oscillates steadily, and the
higher the gain the closer the control signal comes to a relay's square wave. Then 4 d/(pi a) estimates the ultimate
gain (`derivations.experiments.describing_function`), d the limit and a the amplitude of y.
"""

from dataclasses import dataclass

import numpy as np

from derivations.errors import LoopbookError
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import simulate

PERIODS, PER_PERIOD = 30, 400


class NoLimitCycle(LoopbookError):
    """The loop does not oscillate steadily: the gain is below the ultimate one."""


@dataclass(frozen=True)
class LimitCycle:
    """amplitude of y [y], period [s], share of the time at a limit [1], the run's t [s], y and u."""

    amplitude: float
    period: float
    at_limit: float
    t: np.ndarray
    y: np.ndarray
    u: np.ndarray

    def ultimate_gain(self, limit: float) -> float:
        """4 d/(pi a) with d = limit: exact for a relay and a sinusoidal y."""
        return float(4 * limit / (np.pi * self.amplitude))


@dataclass(frozen=True)
class _Gain:
    K: float

    def step(self, y: float, reference: float) -> float:
        return self.K * (reference - y)


def limit_cycle(process: Process, K: float, limit: float, period: float) -> LimitCycle:
    """What a saturated P loop settles to after a kick, measured over its last ten periods.

    K: gain [u/y]; limit: |u| <= limit [u]; period: about that of the oscillation [s], sets the horizon (30 periods)
    and the sampling (400 per period, which adds half a sampling interval of delay).
    Raises NoLimitCycle where the oscillation has died out.
    """
    h, steps = period / PER_PERIOD, PERIODS * PER_PERIOD
    kick = np.where(np.arange(steps + 1) < PER_PERIOD // 10, limit, 0.0)
    run = simulate(process, _Gain(K), h, steps, load=kick, limits=(-limit, limit))
    late = run.t > run.t[-1] * 2 / 3
    t, y, u = run.t[late], run.y[late], run.u[late]
    up = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    halves = np.array_split(y, 2)
    if len(up) < 3 or np.ptp(halves[1]) < 0.95 * np.ptp(halves[0]):
        raise NoLimitCycle(f"K = {K:g}: the oscillation dies out; the loop without limits is stable")
    instants = t[up] - y[up] * h / (y[up + 1] - y[up])
    whole = slice(up[0], up[-1] + 1)
    amplitude = float(np.ptp(y[whole]) / 2)
    return LimitCycle(
        amplitude=amplitude,
        period=float(np.diff(instants).mean()),
        at_limit=float((abs(u[whole]) >= limit).mean()),
        t=run.t,
        y=run.y,
        u=run.u,
    )
