"""A process as an experimenter meets it: an actuator with limits, a noisy sensor, samples.

The output is exact between switchings: a piecewise constant input is a sum of steps, a sine is the step response of
G(s) w s/(s^2 + w^2), and a clipped sine is a sum of both, each shifted by the dead time. Noise is white, normal and
seeded, so an experiment repeats itself.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.numerics.signals import Signal
from loopbook.numerics.step_response import open_loop_step
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record
from loopbook.refusal import Refusal

AT_ONCE = 1.0
"""A horizon [s] for a process that has no time of its own."""


class ExperimentError(Refusal):
    """An experiment that cannot tell what it was asked for; the message says why and what to do instead."""


@dataclass(frozen=True)
class Estimate:
    """What an experiment found.

    data: the numbers a tuning rule takes (`loopbook.experiments.data`). marks: what was read off on the way, by name.
    assumed: what the numbers rest on, one sentence each. record: the experiment itself.
    """

    data: Any
    marks: dict[str, float]
    assumed: tuple[str, ...]
    record: Record = field(repr=False)


@dataclass(frozen=True)
class Plant:
    """A process with actuator limits and a noisy sensor.

    low, high: limits of the input, as deviations from the working point. noise: standard deviation of the sensor's
    white noise [y]. seed: of that noise. samples: how many a record holds.
    """

    process: Process
    low: float = -math.inf
    high: float = math.inf
    noise: float = 0.0
    seed: int = 0
    samples: int = 4001

    def __post_init__(self) -> None:
        if not self.low < 0 < self.high:
            raise ExperimentError(f"limits low = {self.low}, high = {self.high}: the working point 0 must lie between")
        if not self.noise >= 0:
            raise ExperimentError(f"noise = {self.noise!r} is no standard deviation")

    @cached_property
    def _responses(self) -> dict:
        return {}

    def step_response(self, horizon: float, frequency: float = 0.0, phase: float = 0.0) -> Signal:
        """The response to a step (frequency 0) or to sin(w t + phase) switched on at 0; a `Signal` on [0, horizon]."""
        key = horizon, frequency, phase
        if key not in self._responses:
            source = self.process.rational
            if frequency:
                wave = [math.sin(phase), frequency * math.cos(phase), 0.0]  # s times the transform of the sine
                num = np.polymul(source.num, wave)
                source = Process(tuple(num), tuple(np.polymul(source.den, [1.0, 0.0, frequency**2])))
            self._responses[key] = open_loop_step(source, horizon).delayed(self.process.delay)
        return self._responses[key]

    def clip(self, u: Any) -> Any:
        """The input that gets through the actuator."""
        return np.clip(u, self.low, self.high)

    def measured(self, y: np.ndarray) -> np.ndarray:
        """The output with the sensor's noise."""
        return y + self.noise * np.random.default_rng(self.seed).standard_normal(len(y)) if self.noise else y

    def play(self, switchings: Sequence[tuple[float, float]], horizon: float) -> Record:
        """Apply a piecewise constant input: (instant [s] >= 0, level) in order; zero before the first.

        Each instant is a sample, so the record holds the input exactly: the nearest sample moves there.
        """
        time = np.linspace(0.0, horizon, self.samples)
        for instant, _ in switchings:
            time[round(instant / horizon * (self.samples - 1))] = instant
        u, y, before = np.zeros_like(time), np.zeros_like(time), 0.0
        response = self.step_response(horizon)
        for instant, level in switchings:
            level = float(self.clip(level))
            u[time >= instant] = level
            y += (level - before) * response(np.minimum(time - instant, horizon))
            before = level
        return Record(time, u, self.measured(y), source="simulated")

    def play_sine(self, amplitude: float, frequency: float, horizon: float) -> Record:
        """Apply amplitude sin(w t) from t = 0; where the actuator clips it, its flat tops are exact too."""
        time = np.linspace(0.0, horizon, self.samples)
        u = self.clip(amplitude * np.sin(frequency * time))
        y = np.zeros_like(time)
        step = self.step_response(horizon)
        pieces = [(0.0, None), *self._clippings(amplitude, frequency, horizon)]
        for i, (instant, level) in enumerate(pieces):
            was = 0.0 if i == 0 else pieces[i - 1][1]
            later = np.minimum(time - instant, horizon)
            for value, sign in ((level, 1.0), (was, -1.0)):
                if value is None:
                    angle = round(math.remainder(frequency * instant, 2 * math.pi), 12)
                    y += sign * amplitude * self.step_response(horizon, frequency, angle)(later)
                elif value:
                    y += sign * value * step(later)
        return Record(time, u, self.measured(y), source="simulated")

    def _clippings(self, amplitude: float, frequency: float, horizon: float) -> list[tuple[float, float | None]]:
        """(instant, level) where the actuator takes the sine's place, (instant, None) where the sine comes back."""
        found = []
        for limit in (self.low, self.high):
            if abs(limit) < amplitude:
                rise = math.asin(abs(limit) / amplitude) / frequency
                period = 2 * math.pi / frequency
                start = rise if limit > 0 else rise + period / 2
                for turn in range(int(horizon / period) + 1):
                    begin = start + turn * period
                    found += [(begin, limit), (begin + period / 2 - 2 * rise, None)]
        return sorted((instant, level) for instant, level in found if instant < horizon) if found else []


def settling_horizon(process: Process, factor: float = 12.0) -> float:
    """A horizon [s] after which a stable process has settled: dead time and `factor` times the sum of its lags."""
    if any(p and p.real >= 0 for p in process.poles):
        raise ExperimentError(f"the process is unstable by itself, poles {process.poles}: no open-loop experiment ends")
    lags = sum_of_lags(process)
    return process.delay * 1.5 + factor * lags if lags else 4 * process.delay or AT_ONCE


def sum_of_lags(process: Process) -> float:
    """What 1/|Re p| [s] of the poles that are no integrators add up to."""
    return float(sum(1 / abs(p.real) for p in process.poles if p.real))


def smooth(y: np.ndarray, window: int) -> np.ndarray:
    """A moving average over an odd number of samples, shorter at the ends.

    >>> smooth(np.array([0.0, 3.0, 0.0]), 3)
    array([1.5, 1. , 1.5])
    """
    if window <= 1:
        return y
    total = np.concatenate([[0.0], np.cumsum(y)])
    i = np.arange(len(y))
    a, b = np.maximum(i - window // 2, 0), np.minimum(i + window // 2 + 1, len(y))
    return (total[b] - total[a]) / (b - a)
