"""The step response of num/den as an experimenter reads it: its steepest tangent and where it first reaches a level.

Both are read off the response's polynomials (`signals`), to rounding, whatever the time constants are.
"""

from loopbook.numerics.step_response import open_loop_step
from loopbook.process.transfer_function import Process


class ExactResponse:
    """The unit step response of the rational part of a stable process, from t = 0 to the horizon [s]."""

    def __init__(self, process: Process, horizon: float):
        self._y = open_loop_step(process, horizon)

    def value(self, t: float) -> float:
        """y(t)."""
        return float(self._y(t))

    def steepest(self) -> tuple[float, float]:
        """The instant of the largest slope, and the slope; a jump at t = 0 is none."""
        return self._y.derivative().maximum()

    def reaches(self, level: float) -> float:
        """The first instant at which y = level. Raises ValueError where it never does."""
        found = self._y.roots(level)
        if not found.size:
            raise ValueError(f"the response does not reach {level:.4g} within {self._y.end:.4g} s")
        return float(found[0])
