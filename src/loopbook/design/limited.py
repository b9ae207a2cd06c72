"""The chosen regulator as it will run: sampled, within the actuator's limits, anti-windup on."""

import numpy as np

from loopbook.controllers.pid import Pid
from loopbook.design.model import Model
from loopbook.design.program import SampledProgram
from loopbook.response.simulation import Simulation, simulate

SAMPLES = 20000


def run(model: Model, program: SampledProgram, horizon: float, reference: float, load: float) -> Simulation:
    """A reference step at t = 0 and a load step at half the horizon, both from rest.

    horizon [s]; reference [y]; load [u], added to the process input. The controller's own limits hold the output;
    the dead time is exact. A horizon of more than 20,000 samples is cut short.
    """
    h = float(program.settings.h)
    steps = max(int(min(horizon / h, SAMPLES)), 2)
    loads = np.where(np.arange(steps + 1) >= steps // 2, load, 0.0)
    limits = (float(program.settings.u_low), float(program.settings.u_high))
    return simulate(model.process, Pid(program.settings), h, steps, reference=reference, load=loads, limits=limits)
