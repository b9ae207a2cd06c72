"""500 loops of every kind that the page can show, always the same: what golden vectors are made of.

Five kinds in turn: lags, integrating, unstable, dead time over three time constants, and processes with zeros, complex
poles or double integrators, whose loops are often stable for a middle gain alone.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from loopbook.controllers.pid_forms import PidParallel, PidSeries, PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.transfer import LoopError
from loopbook.process.transfer_function import Process

KINDS = ("lags", "integrating", "unstable", "long dead time", "conditional")
COUNT = 500
BIPROPER = 0.06  # of the processes act at once


@dataclass(frozen=True)
class Case:
    kind: str
    process: Process
    pid: PidStandard

    @property
    def loop(self) -> Loop:
        return Loop(self.process, self.pid)


def cases(count: int = COUNT, start: int = 0, stride: int = 1) -> Iterator[Case]:
    """The loops number start, start + stride, ... below `count`."""
    for number in range(start, count, stride):
        yield _case(KINDS[number % len(KINDS)], np.random.default_rng([23, number]))


def _lags(rng: np.random.Generator, most: int) -> list[float]:
    times = np.exp(rng.uniform(np.log(0.05), np.log(20), rng.integers(1, most + 1)))
    if len(times) > 1 and rng.random() < 0.25:
        times[1:] = times[0]
    return sorted(times.tolist(), reverse=True)


def _product(factors: list[list[float]]) -> np.ndarray:
    total = np.ones(1)
    for factor in factors:
        total = np.polymul(total, factor)
    return total


def _process(kind: str, rng: np.random.Generator) -> tuple[Process, float]:
    """A process, and the time [s] in which it moves."""
    lags = _lags(rng, 3)
    slowest = lags[0]
    delay = float(rng.choice([0.0, 0.001, 0.05, 0.3, 1.0, 2.0])) * slowest * float(rng.uniform(0.5, 1.5))
    num, factors = [1.0], [[T, 1.0] for T in lags]
    if kind == "integrating":
        factors.append([1.0, 0.0])
    elif kind == "unstable":
        factors[0] = [slowest, -1.0]
        factors[1:] = [[T * 0.1, 1.0] for T in lags[1:]]
        delay = float(rng.choice([0.0, 0.02, 0.1, 0.3])) * slowest * float(rng.uniform(0.5, 1.5))
    elif kind == "long dead time":
        delay = slowest * float(rng.uniform(3.01, 10))
    elif kind == "conditional":
        choice = rng.integers(4)
        if choice == 0:
            num = [float(rng.uniform(-1, 2)) * slowest, 1.0]
        elif choice == 1:
            zeta = float(rng.uniform(0.05, 0.7))
            factors = [[slowest**2, 2 * zeta * slowest, 1.0], *factors[1:]]
        elif choice == 2:
            factors = [[1.0, 0.0], [1.0, 0.0], *([[T * 0.05, 1.0] for T in lags[1:]])]
            delay = min(delay, 0.1 * slowest)
        else:
            factors = [[slowest, -1.0], [1.0, 0.0]]
            delay = min(delay, 0.05 * slowest)
    if rng.random() < BIPROPER and kind in ("lags", "long dead time"):
        num, factors = [float(rng.uniform(0.1, 0.8)) * slowest, 1.0], factors[:1]
    scale = float(np.exp(rng.uniform(-3, 3))) * (-1 if rng.random() < 0.1 else 1)
    return Process(tuple(np.asarray(num) * scale), tuple(_product(factors)), delay), slowest + delay


def _regulator(kind: str, process: Process, time: float, rng: np.random.Generator) -> PidStandard:
    """Of any kind, with a gain for which the loop is stable if one was found and three times out of four."""
    action = str(rng.choice(["P", "PI", "PID", "PID"]))
    acts_at_once = process.relative_degree == 0
    slow = kind in ("unstable", "conditional")
    Ti = float("inf") if action == "P" else time * float(np.exp(rng.uniform(0, 3) if slow else rng.uniform(-1.5, 1.5)))
    Td = time * float(rng.uniform(0.05, 0.6)) if action == "PID" else 0.0
    c = float(rng.choice([0.0, 0.0, 0.3, 1.0]))
    N = float(rng.choice([2, 5, 10, 10, 20, 100]))
    if rng.random() < 0.1 and not acts_at_once and process.relative_degree > 1:
        N, c = float("inf"), 0.0
    b = float(rng.choice([0.0, 0.5, 1.0, rng.uniform(0, 1)]))

    def with_gain(K: float) -> PidStandard:
        return PidStandard(K, Ti, Td, b=b, c=c, N=N if Td else None)

    size = 1 / abs(process(1j / time))
    sign = 1.0 if process.num[-1] > 0 else -1.0
    gains = sign * size * np.exp(rng.permutation(np.linspace(-4, 2, 13)) + rng.uniform(-0.2, 0.2))
    if rng.random() < 0.75:
        for K in gains:
            try:
                if Loop(process, with_gain(float(K))).is_stable:
                    return with_gain(float(K))
            except LoopError:
                continue
    return with_gain(float(gains[0]))


def _case(kind: str, rng: np.random.Generator) -> Case:
    process, time = _process(kind, rng)
    pid = _regulator(kind, process, time, rng)
    if rng.random() < 0.15 and pid.Td == 0:
        parallel = pid.parallel()
        pid = PidParallel(parallel.P, parallel.I, b=pid.b, c=pid.c).standard()
    elif rng.random() < 0.15 and pid.Td and 4 * pid.Td < pid.Ti < 1e9:
        pid = PidSeries(pid.K, pid.Ti, pid.Td, N=10).standard()
    return Case(kind, process, pid)
