"""Seeded loops of many kinds, and the same loops in other units of time, of y and of u."""

from dataclasses import dataclass

import numpy as np

from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.rst import Rst
from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.process.transfer_function import Process


@dataclass(frozen=True)
class Units:
    """The factor of all times, and those of the numbers of y and u."""

    k: float = 1.0
    y: float = 1.0
    u: float = 1.0

    @classmethod
    def seeded(cls, seed: int) -> "Units":
        """k log-uniform from 1e-9 to 1e9, never a power of 2 or 10; y and u from 1e-5 to 1e5."""
        rng = np.random.default_rng([seed, 1])
        k = float(np.exp(rng.uniform(np.log(1e-9), np.log(1e9))))
        assert abs(np.log2(k) % 1) > 1e-9 and abs(np.log10(k) % 1) > 1e-9
        return cls(k, *np.exp(rng.uniform(np.log(1e-5), np.log(1e5), 2)).tolist())


@dataclass(frozen=True)
class Case:
    """A loop in one unit of time. kind: how its roots were drawn. h: an interval in which a regulator samples it."""

    kind: str
    num: np.ndarray
    den: np.ndarray
    delay: float
    pid: tuple[float, float, float, float, float]
    h: float

    @classmethod
    def seeded(cls, seed: int) -> "Case":
        """Orders 1 to 8: lags, oscillators, integrators, unstable poles, zeros on both sides, dead time or none."""
        rng = np.random.default_rng(seed)
        kind = str(rng.choice(["mixed", "equal lags", "far apart", "lag and dead time"], p=[0.7, 0.1, 0.1, 0.1]))
        roots, delayed = _roots(kind, rng), kind == "lag and dead time" or rng.random() < 0.6
        n = len(roots)
        zeros = np.exp(rng.uniform(-3, 3, int(rng.integers(0, n)) if rng.random() < 0.5 else 0))
        zeros = zeros * rng.choice([-1, 1], len(zeros), p=[0.8, 0.2])
        num = np.atleast_1d(np.poly(zeros)) * np.exp(rng.uniform(-3, 3))
        den, delay = np.real(np.poly(roots)), float(np.exp(rng.uniform(-4, 2))) if delayed else 0.0
        K = np.exp(rng.uniform(-4, 0)) / abs(np.polyval(num, 1j) / np.polyval(den, 1j))
        Ti = np.exp(rng.uniform(-1, 4)) if rng.random() < 0.8 else np.inf
        Td = rng.uniform(0.05, 1) if rng.random() < 0.4 else 0.0
        pid = (K, Ti, Td, rng.uniform(2, 20), rng.uniform(0, 1))
        return cls(kind, num, den, delay, pid, float(np.exp(rng.uniform(-4, 0))))

    def process(self, units: Units) -> Process:
        num, den = (p * units.k ** np.arange(len(p) - 1, -1, -1.0) for p in (self.num, self.den))
        return Process(num * (units.y / units.u), den, self.delay * units.k)

    def loop(self, units: Units) -> Loop:
        K, Ti, Td, N, b = self.pid
        pid = PidStandard(K * units.u / units.y, Ti * units.k, Td * units.k, b, 0.0, N=N if Td else None)
        return Loop(self.process(units), pid)

    def sampled_loop(self, units: Units) -> SampledLoop:
        gain = self.pid[0] / 4 * units.u / units.y
        return SampledLoop(self.process(units), Rst((1, -1), (gain, 0), (gain, 0), self.h * units.k))


def _roots(kind: str, rng: np.random.Generator) -> list[complex]:
    if kind == "equal lags":
        return [-float(np.exp(rng.uniform(-2, 2)))] * int(rng.integers(2, 9))
    if kind == "lag and dead time":
        return [-float(np.exp(rng.uniform(-2, 2)))]
    n, found = int(rng.integers(1, 7)), []
    while len(found) < n:
        size, drawn = np.exp(rng.uniform(-8, 8) if kind == "far apart" else rng.uniform(-3, 3)), rng.random()
        if drawn < 0.3 and n - len(found) >= 2:
            zeta = rng.uniform(0.05, 0.95)
            found += [size * complex(-zeta, s * np.sqrt(1 - zeta**2)) for s in (1, -1)]
        else:
            found.append(0.0 if 0.3 <= drawn < 0.42 else 0.1 * size if drawn > 0.93 else -size)
    return found
