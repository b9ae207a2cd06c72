"""What saturation does to the integral, method by method: a step that saturates, a spike, a lock-up, a transfer.

The process is 1/(s + 1)^2, sampled every h seconds. Source of the questions: pid-report, sections 4.2.3 to 4.2.6.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from loopbook.controllers.pid import Pid
from loopbook.controllers.settings import PidSettings
from loopbook.documents.pid_report.printed_programs import ProgramController
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation, simulate

PROCESS = Process([1.0], [1.0, 2.0, 1.0])
H = 0.1
FAR = {"u_low": -100.0, "u_high": 100.0}


def settings(**more: Any) -> PidSettings:
    """K = 4, Ti = 2 s, Td = 0.4 s, Tf = 0.1 s, limits 0 and 1.5; any of them may be replaced."""
    base = {"K": 4.0, "Ti": 2.0, "Td": 0.4, "Tf": 0.1, "h": H, "u_low": 0.0, "u_high": 1.5}
    return PidSettings(**{**base, **more})


@dataclass(frozen=True)
class Observed:
    """A controller that remembers its integral part at each sample."""

    controller: Any
    integral: list[float]

    def step(self, y: float, y_sp: float) -> float:
        u = self.controller.step(y, y_sp)
        state = getattr(self.controller, "states", None)
        self.integral.append(float(state["I"] if state else self.controller.I))
        return u


def watched(controller: Any) -> Observed:
    return Observed(controller, [])


def unreachable(anti_windup: str, seconds: float = 40.0, **more: float) -> tuple[Simulation, np.ndarray]:
    """Set-point 1.8 for 15 s, more than the 1.5 that the process can reach, then 1. The run and I over time.

    more: other `settings`, in all of these studies.
    """
    observed = watched(Pid(settings(anti_windup=anti_windup, **more)))
    wanted = lambda t: 1.8 if t < 15 else 1.0  # noqa: E731
    run = simulate(PROCESS, observed, H, round(seconds / H), reference=wanted)
    return run, np.array(observed.integral)


def recovery(run: Simulation, after: float = 15.0, wanted: float = 1.0, within: float = 0.02) -> float:
    """Seconds after an instant until the output of the process stays within a band around the wanted value."""
    outside = run.t[(abs(run.y - wanted) > within) & (run.t >= after)]
    return float(outside[-1] - after) if len(outside) else 0.0


def spike(anti_windup: str, size: float = 1.0, **more: float) -> tuple[Simulation, np.ndarray]:
    """A steady loop at 1 with one false sample, ``size`` too high, at 1 s. The run and I over time."""
    start = settings(anti_windup=anti_windup, **more)
    p24 = start.K * start.Td / (start.Tf + start.h)
    observed = watched(Pid(start, I=1.0, x=p24))
    noise = np.zeros(121)
    noise[10] = size
    run = simulate(PROCESS, observed, H, 120, reference=1.0, noise=noise, u_before=1.0)
    return run, np.array(observed.integral)


def locked(rule: str, K: float = 6.0, Ti: float = 1.2, Td: float = 1.8) -> tuple[Simulation, np.ndarray]:
    """A step of the set-point to 0.8 from rest, limits 0 and 1, no filter; times in s.

    rule: "4.7" for the printed program, else a rule of anti-windup for `Pid` with the same settings and derivative
    on the error. The run of 60 s and I over time.
    """
    tuned = PidSettings(K=K, Ti=Ti, Td=Td, c=1.0, h=H, u_low=0.0, u_high=1.0)
    if rule == "4.7":
        observed = watched(ProgramController("4.7", tuned))
    else:
        observed = watched(Pid(tuned.changed(anti_windup=rule), x=0.0))
    return simulate(PROCESS, observed, H, 600, reference=0.8), np.array(observed.integral)


def locking() -> tuple[int, int]:
    """(loops that figure 4.7 locks up, loops): of 48 settings those that settle with the safe conditional integration.

    K from 1 to 6, Ti from 1.2 to 4 s, Td from 0 to 1.8 s; settled is within 0.01 of the set-point after 60 s.
    """
    grid = [(K, Ti, Td) for K in (1.0, 2.0, 4.0, 6.0) for Ti in (1.2, 2.0, 4.0) for Td in (0.0, 0.4, 0.9, 1.8)]
    settles = lambda rule, one: abs(locked(rule, *one)[0].y[-1] - 0.8) < 0.01  # noqa: E731
    sound = [one for one in grid if settles("conditional-safe", one)]
    return sum(not settles("4.7", one) for one in sound), len(sound)


def transfer(way: str, error: float, seconds: float = 20.0, **more: float) -> float:
    """The step of the output at the change from manual to automatic, with a constant error during manual.

    way: "exact" or "tracking". The controller has no limits in reach.
    """
    pid = Pid(settings(**{**more, **FAR}))
    pid.manual(1.0)
    for _ in range(round(seconds / H)):
        pid.step(1.0 - error, 1.0)
    pid.auto(way)
    return pid.step(1.0 - error, 1.0) - 1.0


class _Changing:
    """A controller whose settings change at 1 s; it remembers its integral part."""

    def __init__(self, bumpless: str, new: Mapping[str, float], start: PidSettings):
        self.pid = Pid(start, I=1.0, x=start.K * start.Td / (start.Tf + start.h))
        self.bumpless, self.new = bumpless, new
        self.integral: list[float] = []

    def step(self, y: float, y_sp: float) -> float:
        if len(self.integral) == round(1 / H):
            self.pid.change(self.bumpless, **self.new)
        u = self.pid.step(y, y_sp)
        self.integral.append(float(self.pid.I))
        return u


def change(bumpless: str, new: Mapping[str, float], **more: float) -> tuple[Simulation, np.ndarray]:
    """A steady loop at 1 in which settings change at 1 s; bumpless as for `Pid.change`. The run and I over time."""
    controller = _Changing(bumpless, new, settings(**{**more, **FAR}))
    run = simulate(PROCESS, controller, H, 150, reference=1.0, u_before=1.0)
    return run, np.array(controller.integral)


def integrating(anti_windup: str) -> Simulation:
    """A large set-point step, 10, on 1/(s(s + 1)) with limits -0.5 and 0.5: K = 0.8, Ti = 4 s, Td = 1 s, 120 s."""
    tuned = settings(K=0.8, Ti=4.0, Td=1.0, u_low=-0.5, u_high=0.5, anti_windup=anti_windup)
    return simulate(Process([1.0], [1.0, 1.0, 0.0]), Pid(tuned), H, 1200, reference=10.0)


def recovery_of_pi(Tt: float) -> float:
    """`recovery` after the unreachable set-point for a PI controller, K = 2, Ti = 2 s, with tracking time Tt [s]."""
    wanted = lambda t: 1.8 if t < 15 else 1.0  # noqa: E731
    pi = Pid(settings(K=2.0, Td=0.0, Tf=0.0, Tt=Tt))
    return recovery(simulate(PROCESS, pi, H, 500, reference=wanted))


def misprinted(unit: float | None, **more: float) -> Simulation:
    """A set-point step with the program of figure 4.13 and p4 = K Td h, as eq. 4.17 is read; None: with the right p4.

    unit: the unit of time [s] in which the controller's times are counted. more: other `settings`. The time axis of
    the run is in seconds.

    >>> [round(float(misprinted(unit).y[-1]), 2) for unit in (None, 0.05)]
    [1.0, 6.24]
    """
    free = settings(**{**more, "u_low": -9.0, "u_high": 9.0})
    wrong = {} if unit is None else {"p_4": free.K * (free.Td / unit) * (free.h / unit)}
    return simulate(PROCESS, ProgramController("4.13", free, gains=wrong), free.h, round(20 / free.h), reference=1.0)
