"""The step response of num/den at any instant, its steepest point and where it first reaches a level, to rounding.

With the state z = (x, 1) the response is y = c z, z' = M z, so y(t) = c e^(M t) z(0) and slopes are c M z, c M^2 z. A
coarse row of instants, doubling its spacing from the fastest lag to the slowest, brackets what is sought; matrix
exponentials inside the bracket find it.
"""

from collections.abc import Callable

import numpy as np

from loopbook.numerics.state_space import observer_form
from loopbook.process.transfer_function import Process

OCTAVE = 32  # instants per doubling of the spacing


class ExactResponse:
    """The unit step response of the rational part of a stable process, from t = 0 on."""

    def __init__(self, process: Process, horizon: float):
        from scipy.linalg import expm

        plant = observer_form(process.den, [process.num])
        n = len(plant.A)
        self.generator = np.zeros((n + 1, n + 1))
        self.generator[:n, :n], self.generator[:n, n:] = plant.A, plant.B
        self.row = np.append(plant.C[0], plant.D[0, 0])
        self._expm = expm
        fastest = max(abs(process.poles), default=1.0)
        times, states = [0.0], [np.append(np.zeros(n), 1.0)]
        spacing = min(1 / fastest, horizon) / OCTAVE
        step = expm(self.generator * spacing)
        while times[-1] < horizon:
            for _ in range(OCTAVE):
                times.append(times[-1] + spacing)
                states.append(step @ states[-1])
            spacing, step = 2 * spacing, step @ step
        self.times, self.states = np.array(times), np.array(states)

    def _solve(self, row: np.ndarray, level: float, first: int) -> float:
        """The instant between samples first and first + 1 at which row z = level."""
        from scipy.optimize import brentq

        start, state = self.times[first], self.states[first]
        gap: Callable = lambda t: float(row @ (self._expm(self.generator * t) @ state)) - level  # noqa: E731
        return float(start + brentq(gap, 0.0, self.times[first + 1] - start, xtol=1e-15, rtol=1e-13))

    def value(self, t: float) -> float:
        """y(t)."""
        return float(self.row @ (self._expm(self.generator * t) @ self.states[0]))

    def steepest(self) -> tuple[float, float]:
        """The instant of the largest slope, and the slope."""
        slope_row = self.row @ self.generator
        bend_row = slope_row @ self.generator
        slopes, bends = self.states @ slope_row, self.states @ bend_row
        best = int(np.argmax(slopes))
        first = best if bends[best] > 0 else best - 1
        if first < 0 or bends[first] <= 0:
            return float(self.times[best]), float(slopes[best])
        t = self._solve(bend_row, 0.0, first)
        return t, float(slope_row @ (self._expm(self.generator * t) @ self.states[0]))

    def reaches(self, level: float) -> float:
        """The first instant at which y = level. Raises ValueError where it never does."""
        above = np.flatnonzero(self.states @ self.row >= level)
        if not above.size:
            raise ValueError(f"the response does not reach {level:.4g} within {self.times[-1]:.4g} s")
        return self._solve(self.row, level, int(above[0]) - 1) if above[0] else 0.0
