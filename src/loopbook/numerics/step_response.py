"""Step responses of rational transfer functions."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from loopbook.numerics import units
from loopbook.numerics.method_of_steps import DelayEquation, solve
from loopbook.numerics.signals import Signal
from loopbook.numerics.state_space import observer_form

AT_ONCE = 1e-9  # a horizon of nothing, in the system's own time


class Rational(Protocol):
    """num/den, coefficients from the highest power of s down."""

    @property
    def num(self) -> Sequence[float]: ...
    @property
    def den(self) -> Sequence[float]: ...


def open_loop_step(process: Rational, horizon: float) -> Signal:
    """The unit step response of num/den without its dead time, on [0, horizon]."""
    time = units.characteristic_time(process.num, process.den, 0.0)
    num, den, gain = units.ratio_in_units(process.num, process.den, time)
    plant = observer_form(den, [num])
    zero = np.zeros(2)
    row = np.vstack([np.zeros(plant.C.shape), plant.C])
    equation = DelayEquation(plant.A, 0 * plant.B[:, 0], plant.B[:, 0], row, zero, np.array([0, plant.D[0, 0]]), 0.0)
    y = solve(equation, horizon / time or AT_ONCE, time)[1]
    return Signal(y.edges * time, y.coefficients * gain)
