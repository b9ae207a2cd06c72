"""The program of the settings on the process: what an interval, limits, a sine, other settings at half-time do."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from loopbook.controllers import generated
from loopbook.controllers.pid import Pid
from loopbook.controllers.rst import Rst
from loopbook.controllers.settings import PidSettings
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation, simulate

SAMPLES = 1200
MOST_SAMPLES = 6000
SAMPLES_OF_WAVE = 20


def number_of_data(value: Any, none: float = math.inf) -> float:
    """A number of the page's data, where "inf" is infinite and null is `none`."""
    return none if value is None else float(value)


def program_settings(state: Mapping[str, Any], h: float) -> PidSettings:
    """The settings of the program that runs every h seconds."""
    Ti, N, Td = number_of_data(state["Ti"]), number_of_data(state["N"]), state["Td"]
    return PidSettings(
        K=state["Kc"],
        Ti=Ti,
        Td=Td,
        Tf=Td / N,
        b=state["b"],
        c=state["c"],
        h=h,
        u_low=number_of_data(state.get("low"), -math.inf),
        u_high=number_of_data(state.get("high")),
        anti_windup="tracking" if state.get("windup", True) else "none",
    )


def rst_of(settings: PidSettings) -> Rst:
    """The program without its limits, as polynomials in z^-1: R u = T y_sp - S y.

        u = p1 y_sp - p2 y + p5 z^-1/(1 - z^-1) (y_sp - y) + p4 z^-1/(1 - p3 z^-1) (y - c y_sp)

    >>> rst_of(PidSettings(K=2.0, Ti=4.0, h=1.0)).S
    (2.0, -1.5)
    """
    s = settings
    p = dict(zip(generated.GAINS, generated.gains()(s.K, s.Ti, s.Td, s.Tf, s.b, s.c, s.h, s.Tt), strict=True))
    whole = np.array([1.0, -1.0]) if s.Ti is not None else np.array([1.0])
    lag = np.array([1.0, -p["p_3"]]) if s.Td else np.array([1.0])
    late = lambda row: np.append(0.0, row)  # noqa: E731
    R = np.convolve(whole, lag)
    integral = p["p_5"] * late(lag) if s.Ti is not None else np.zeros(1)
    derivative = p["p_4"] * late(whole) if s.Td else np.zeros(1)
    S = _total(p["p_2"] * R, integral, -derivative)
    T = _total(p["p_1"] * R, integral, -s.c * derivative)
    return Rst(tuple(R), tuple(S), tuple(T), s.h)


def _total(*rows: np.ndarray) -> np.ndarray:
    size = max(len(row) for row in rows)
    return np.asarray(sum(np.pad(row, (0, size - len(row))) for row in rows))


def is_programmed(data: Mapping[str, Any]) -> bool:
    """Does the page run the program of a PID regulator, in the place of its continuous law?"""
    s = data["state"]
    limited = s.get("low") is not None or s.get("high") is not None
    return bool(s.get("kind") != "rst" and (s.get("h") or limited or s.get("wave") or _first(data)))


def _first(data: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The settings before half-time."""
    pins = data.get("pins")
    return {**data["state"], **pins[0]} if pins and data["state"].get("jump") else None


class _Changing:
    """A program that gets other settings at a sample."""

    def __init__(self, first: PidSettings, then: PidSettings, at: int, bumpless: bool):
        self.pid, self.then, self.left, self.how = Pid(first, x=0.0), then, at, "exact" if bumpless else "none"

    def step(self, y: float, reference: float) -> float:
        if self.left == 0:
            s = self.then
            more = {name: getattr(s, name) for name in ("K", "Ti", "Td", "Tf", "b", "c", "Tt", "anti_windup")}
            self.pid.change(self.how, **more)
        self.left -= 1
        return float(self.pid.step(y, reference))


def run_program(data: Mapping[str, Any], process: Process, horizon: float) -> Simulation:
    """The run that the page shows: a set-point step, at half-time a load step or other settings."""
    s, first = data["state"], _first(data)
    wave, f = s.get("wave", 0.0), s.get("freq", 1.0)
    short = [horizon / SAMPLES, *([1 / (SAMPLES_OF_WAVE * f)] if wave else [])]
    h = s.get("h") or max(min(short), horizon / MOST_SAMPLES)
    steps = max(2, min(MOST_SAMPLES, round(horizon / h)))
    settings, half = program_settings(s, h), round(steps / 2)
    program: Any = Pid(settings, x=0.0)
    if first is not None:
        program = _Changing(program_settings(first, h), settings, half, s.get("smooth", True))
    return simulate(
        process,
        program,
        h,
        steps,
        reference=s["r"],
        load=[0.0] * half + [s["d"]] * (steps + 1 - half),
        noise=lambda t: wave * math.sin(2 * math.pi * f * t),
    )
