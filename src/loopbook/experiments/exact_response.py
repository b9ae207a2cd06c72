"""The step response of num/den as an experimenter reads it: its steepest tangent and where it first reaches a level.

With the state z = (x, 1) the response is y = c z, z' = M z, so y(t) = c e^(M t) z(0) and slopes are c M z, c M^2 z. A
coarse row of instants, doubling its spacing from the fastest lag to the slowest, brackets what is sought; matrix
exponentials inside the bracket find it. Time is counted in a unit of the process's own.
"""

import numpy as np

from loopbook.numerics import units
from loopbook.numerics.state_space import observer_form
from loopbook.process.transfer_function import Process

OCTAVE = 32  # instants per doubling of the spacing


class ExactResponse:
    """The unit step response of the rational part of a stable process, from t = 0 to the horizon [s]."""

    def __init__(self, process: Process, horizon: float):
        from scipy.linalg import expm

        self.time = units.characteristic_time(process.num, process.den, 0.0)
        num, den, self.gain = units.ratio_in_units(process.num, process.den, self.time)
        plant = observer_form(den, [num])
        n = len(plant.A)
        self.generator = np.zeros((n + 1, n + 1))
        self.generator[:n, :n], self.generator[:n, n:] = plant.A, plant.B
        self.row = np.append(plant.C[0], plant.D[0, 0])
        self._expm = expm
        end, times, states = horizon / self.time, [0.0], [np.append(np.zeros(n), 1.0)]
        spacing = min(1 / max(abs(process.poles) * self.time, default=1.0), end) / OCTAVE
        step = expm(self.generator * spacing)
        while times[-1] < end:
            for _ in range(OCTAVE):
                times.append(times[-1] + spacing)
                states.append(step @ states[-1])
            spacing, step = 2 * spacing, step @ step
        self.times, self.states = np.array(times), np.array(states)

    def _solved(self, row: np.ndarray, level: float, first: int) -> float:
        """The instant between samples first and first + 1 at which row z = level."""
        from scipy.optimize import brentq

        start, state = self.times[first], self.states[first]
        width = float(self.times[first + 1] - start)

        def gap(t: float) -> float:
            return float(row @ (self._expm(self.generator * t) @ state)) - level

        return float(start + brentq(gap, 0.0, width, xtol=1e-15 * width, rtol=1e-13))

    def _at(self, row: np.ndarray, t: float) -> float:
        return float(row @ (self._expm(self.generator * t) @ self.states[0]))

    def value(self, t: float) -> float:
        """y(t)."""
        return self.gain * self._at(self.row, t / self.time)

    def steepest(self) -> tuple[float, float]:
        """The instant of the largest slope, and the slope; a jump at t = 0 is none."""
        slope_row = self.row @ self.generator
        bend_row = slope_row @ self.generator
        slopes, bends = self.states @ slope_row, self.states @ bend_row
        best = int(np.argmax(slopes))
        first = best if bends[best] > 0 else best - 1
        if first < 0 or bends[first] <= 0 or first + 1 == len(bends):
            t, slope = float(self.times[best]), float(slopes[best])
        else:
            t = self._solved(bend_row, 0.0, first)
            slope = self._at(slope_row, t)
        return t * self.time, slope * self.gain / self.time

    def reaches(self, level: float) -> float:
        """The first instant at which y = level. Raises ValueError where it never does."""
        inside = level / self.gain
        above = np.flatnonzero(self.states @ self.row >= inside)
        if not above.size:
            end = self.times[-1] * self.time
            raise ValueError(f"the response does not reach {level:.4g} within {end:.4g} s")
        return self.time * self._solved(self.row, inside, int(above[0]) - 1) if above[0] else 0.0
