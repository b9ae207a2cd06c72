"""A controller that runs into its limits: the two outputs of pid-report, figure 4.6."""

import numpy as np

from loopbook.controllers.pid import Pid
from loopbook.controllers.settings import PidSettings


def saturated_sine(h: float, seconds: float = 8.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(t [s], v, u) of a PI controller, K = 2, Ti = 2 s, limits -1 and 1, for the error sin t; samples every h [s]."""
    pid = Pid(PidSettings(K=2.0, Ti=2.0, h=h, u_low=-1.0, u_high=1.0))
    t = np.arange(0, seconds, h)
    pairs = [(pid.step(-e, 0.0), pid.v) for e in np.sin(t).tolist()]
    u, v = np.array(pairs).T
    return t, v, u
