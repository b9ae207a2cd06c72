"""Step responses of rational transfer functions."""

import numpy as np

from loopbook.numerics.method_of_steps import DelayEquation, solve
from loopbook.numerics.signals import Signal
from loopbook.numerics.state_space import observer_form
from loopbook.process.transfer_function import Process


def open_loop_step(process: Process, horizon: float) -> Signal:
    """The unit step response of num/den without its dead time, on [0, horizon]."""
    plant = observer_form(process.den, [process.num])
    zero = np.zeros(2)
    row = np.vstack([np.zeros(plant.C.shape), plant.C])
    equation = DelayEquation(plant.A, 0 * plant.B[:, 0], plant.B[:, 0], row, zero, np.array([0, plant.D[0, 0]]), 0.0)
    return solve(equation, max(horizon, 1e-9))[1]
