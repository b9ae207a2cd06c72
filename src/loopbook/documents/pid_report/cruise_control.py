"""The report's running example: a car whose speed is held by on-off, P and PI control.

The car is a first-order lag from the control voltage [V] to the speed [km/h]; it holds 90 km/h at 9 V, so its gain is
10 km/h per volt. The report gives no time constant; a car that reaches 200 km/h at 10 V has the gain 20.
Source: pid-report, chapters 1 to 3.
"""

from typing import Any, NamedTuple

import numpy as np

from loopbook.controllers.on_off import OnOff
from loopbook.controllers.pid import Pid
from loopbook.controllers.settings import PidSettings
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation, simulate

LIMITS: Any = {"u_low": 0.0, "u_high": 10.0}


def car(T: float, gain: float = 10.0, delay: float = 0.0) -> Process:
    """gain exp(-delay s) / (T s + 1) [km/h per V], times in s."""
    return Process.fopdt(gain, T, delay)


def uphill(T: float, h: float, throttle_fixed: bool) -> Simulation:
    """80 s of driving at 90 km/h; from 20 s on a hill takes 0.8 V away. PI control, or the throttle fixed at 9 V."""
    controller = Pid(PidSettings(K=0.5, Ti=T, h=h, **LIMITS), I=9.0)
    if throttle_fixed:
        controller.manual(9.0)
    hill = lambda time: -0.8 * (time >= 20)  # noqa: E731
    return simulate(car(T), controller, h, round(80 / h), reference=90.0, load=hill, u_before=9.0)


class Swing(NamedTuple):
    """The second half of a run with on-off control: speeds [km/h] and switches a minute."""

    lowest: float
    highest: float
    mean: float
    switches: float


def relay_run(T: float, h: float, delay: float, **band: float) -> tuple[Simulation, OnOff]:
    """Five minutes of on-off control of a 200 km/h car at the set-point 50 km/h. delay [s]; band as for `OnOff`."""
    relay = OnOff(0.0, 10.0, **band)
    return simulate(car(T, 20.0, delay), relay, h, round(300 / h), reference=50.0), relay


def on_off(T: float, h: float, delay: float, **band: float) -> Swing:
    """How the speed swings in the second half of `relay_run`."""
    run, relay = relay_run(T, h, delay, **band)
    late = run.y[len(run.y) // 2 :]
    return Swing(late.min(), late.max(), late.mean(), relay.switches / 5)


def set_point_and_hill(T: float, h: float, Ti: float, K: float = 0.3) -> Simulation:
    """120 s of PI control: set-point 50 to 90 km/h at 10 s, a hill of 0.8 V at 60 s (figure 3.5)."""
    pi = Pid(PidSettings(K=K, Ti=Ti, h=h, Tt=Ti, **LIMITS), I=5.0)
    wanted = lambda time: 50.0 + 40.0 * (time >= 10)  # noqa: E731
    hill = lambda time: -0.8 * (time >= 60)  # noqa: E731
    return simulate(car(T), pi, h, round(120 / h), reference=wanted, load=hill, u_before=5.0)


def weighted(T: float, h: float, b: float) -> Simulation:
    """100 s of PI control with set-point weight b: 50 to 60 km/h at 10 s, a load of 1 V at 50 s (figure 3.7)."""
    pi = Pid(PidSettings(K=0.5, Ti=8.0, b=b, h=h), I=5.0 + 0.5 * 50.0 * (1 - b))
    wanted = lambda time: 50.0 + 10.0 * (time >= 10)  # noqa: E731
    load = lambda time: -1.0 * (time >= 50)  # noqa: E731
    return simulate(car(T), pi, h, round(100 / h), reference=wanted, load=load, u_before=5.0)


def settling(run: Simulation, wanted: float, within: float = 1.0) -> float:
    """The time [s] from which the speed stays within a distance of a wanted one."""
    outside = np.flatnonzero(abs(run.y - wanted) > within)
    return float(run.t[min(outside[-1] + 1, len(run.t) - 1)]) if len(outside) else 0.0


def start(T: float, h: float, u_before: float, I: float) -> float:
    """Settling time [s] at 50 km/h after PI control starts with a given integral part on a car that had u_before."""
    pi = Pid(PidSettings(K=0.1, Ti=T, h=h, **LIMITS), I=I)
    return settling(simulate(car(T), pi, h, round(120 / h), reference=50.0, u_before=u_before), 50.0)


def scaled(h: float, factor: float, Td: float = 0.0) -> np.ndarray:
    """Speed after a unit step of the set-point at 300 samples, with every time multiplied by a factor.

    Process time constant 1 s, Ti 1 s, Td, Tf = Td/5 and the sampling interval h [s], before the multiplication.
    """
    f = factor
    pid = Pid(PidSettings(K=0.3, Ti=f, Td=Td * f, Tf=Td * f / 5, h=h * f))
    return simulate(car(f), pid, h * f, 300, reference=1.0).y
