"""True processes for records and for the loops that are closed on them: plain recursions, nothing of the package."""

from collections import deque
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class True_:
    """gain e^(-delay s)/((1 + T1 s)...), times 1/s if integrating. slower: T of the falling output, 0 for the same.

    second: gain of a further input with the same dynamics, 0 for none.
    """

    gain: float
    lags: tuple[float, ...]
    delay: float
    integrating: bool = False
    slower: float = 0.0
    second: float = 0.0

    @property
    def slowest(self) -> float:
        """The time that a record has to be long against [s]."""
        return max(sum(self.lags), self.slower) or 5 * self.delay


class Plant:
    """The process stepping on a fine grid: each lag exact for an input held over one fine step."""

    def __init__(self, process: True_, step: float, u0: float = 0.0, off: float = 0.0):
        self.p, self.step_size, self.u0 = process, step, u0
        self.lags = [off] + [0.0] * (len(process.lags) - 1) if process.lags else []
        if off and len(process.lags) > 1:
            self.lags = [off] * len(process.lags)
        self.level = 0.0
        self.waiting = deque([0.0] * round(process.delay / step))

    @property
    def y(self) -> float:
        """The output's deviation from rest."""
        if self.p.integrating:
            return self.level
        return self.lags[-1]

    def advance(self, u: float) -> None:
        """One fine step with the input u (absolute, the further input's effect included)."""
        self.waiting.append(self.p.gain * (u - self.u0))
        v = self.waiting.popleft()
        for i, T in enumerate(self.p.lags):
            if self.p.slower and v < self.lags[i]:
                T = self.p.slower
            self.lags[i] = v + (self.lags[i] - v) * np.exp(-self.step_size / T)
            v = self.lags[i]
        if self.p.integrating:
            self.level += v * self.step_size


def recorded(process: True_, u: np.ndarray, other: np.ndarray, dt: float, off: float, fine: int = 20) -> np.ndarray:
    """The output's deviation at the samples, the inputs held from one to the next."""
    plant = Plant(process, dt / fine, u[0], off)
    y = np.empty(len(u))
    factor = process.second / process.gain
    for k in range(len(u)):
        y[k] = plant.y
        for _ in range(fine):
            plant.advance(u[k] + factor * (other[k] - other[0]))
    return y


def closed(
    process: True_,
    program: dict,
    y_rest: float,
    noise: float,
    quantum: float,
    horizon: float,
    seed: int,
    fine: int = 10,
):
    """The program as its data say it, on the true process from rest; the set-point steps at once.

    program: the design's JSON. Returns (time, output deviation from rest, input), at the sampling instants.
    """
    g, limits, s = program["gains"], program["limits"], program["settings"]
    h, start, point = s["h"], program["start"], program["operating_point"]
    low = -np.inf if limits["u_low"] is None else limits["u_low"]
    high = np.inf if limits["u_high"] is None else limits["u_high"]
    steps = int(min(max(horizon / h, 50), 6000))
    random = np.random.default_rng(seed)
    plant = Plant(process, h / fine, point["u0"])
    x, I, setpoint = start["x"], start["I"], point["y0"] + program["expected"]["reference_step"]
    y, u = np.empty(steps), np.empty(steps)
    for k in range(steps):
        y[k] = plant.y
        seen = y_rest + y[k] + noise * random.standard_normal()
        if quantum:
            seen = round(seen / quantum) * quantum
        v = g["p_1"] * setpoint - g["p_2"] * seen + I + x
        u[k] = min(max(v, low), high)
        x = g["p_3"] * x + g["p_4"] * seen
        I = I + g["p_5"] * (setpoint - seen) + g["p_6"] * (u[k] - v)
        for _ in range(fine):
            plant.advance(u[k])
    return h * np.arange(steps), y, u
