"""The frequency response of a process with its slope, dead time exact.

Its phase without jumps: `loopbook.loop.process_phase`. Its point at -180 degrees: `loopbook.loop.ultimate_point`.
"""

import numpy as np

from loopbook.numerics import horner
from loopbook.process.transfer_function import Process


def response(process: Process, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """G(i w) and dG(i w)/dw, both complex, shape of w [rad/s].

        dG/dw = i G (num'/num - den'/den - L)

    >>> g, slope = response(Process((1.0,), (1.0, 1.0)), np.array([1.0]))
    >>> complex(g[0]), complex(slope[0])
    ((0.5-0.5j), (-0.5+0j))
    """
    s = 1j * np.asarray(w, dtype=float)
    (num, dnum), (den, dden) = horner.with_slope(process.num, s), horner.with_slope(process.den, s)
    value = num / den * np.exp(-process.delay * s)
    return value, 1j * value * (dnum / num - dden / den - process.delay)
