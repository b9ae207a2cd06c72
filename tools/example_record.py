"""The record that the design notebook reads when it is given none: made from a known process, so that it can be judged.

G(s) = 2.4 e^(-8 s) / ((1 + 40 s)(1 + 12 s))   from a valve in % to a temperature in degrees, white noise of 0.15
"""

import numpy as np

from loopbook.process.transfer_function import Process

PROCESS = Process((2.4,), (480.0, 52.0, 1.0), 8.0)
STEPS = ((30.0, 10.0), (330.0, -5.0))
REST = (40.0, 55.0)
NOISE = 0.15


def text(seed: int = 7) -> str:
    """The CSV file, as a logger would write it: one sample every 2 s, one decimal for u, two for y."""
    t = np.arange(0.0, 601.0, 2.0)
    u, y = np.full(len(t), REST[0]), np.full(len(t), REST[1])
    for instant, height in STEPS:
        u[t >= instant] += height
        y += height * PROCESS.step(t - instant)
    y += np.random.default_rng(seed).normal(0.0, NOISE, len(t))
    rows = [f"{a:.0f},{b:.1f},{c:.2f}" for a, b, c in zip(t, u, y, strict=True)]
    return "\n".join(["time [s],valve [%],temperature [°C]", *rows]) + "\n"
