"""The frequency response of a process with its slope, its phase without jumps, and the point at -180 degrees.

Dead time enters exactly. Frequencies in rad/s, angles in rad.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from loopbook.numerics import horner
from loopbook.process.transfer_function import Process
from loopbook.refusal import Refusal


class NoSuchFrequency(Refusal):
    """The phase never gets to the angle asked for."""


@dataclass(frozen=True)
class FrequencyPoint:
    """The process where its phase is -180 degrees: K180 = |G| [y/u], w180 [rad/s], T180 = 2 pi/w180 [s]."""

    K180: float
    w180: float

    @property
    def T180(self) -> float:
        return 2 * math.pi / self.w180


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


def phase(process: Process, w: np.ndarray) -> np.ndarray:
    """The angle of G(i w) without jumps, shape of w: 0 (or -90 degrees an integrator) at w = 0.

    Each zero and pole turns by its own angle, which needs no unwrapping; a negative gain is taken as positive.

    >>> np.degrees(phase(Process((1.0,), (1.0, 1.0, 0.0)), np.array([1.0])))
    array([-135.])
    """
    return _phase_function(process)(np.asarray(w, dtype=float))


def _phase_function(process: Process) -> Callable:
    """The phase as a function of w, its roots found once."""

    def turning(roots: np.ndarray) -> Callable:
        at_zero = abs(roots) < 1e-12 * max(1.0, abs(roots).max(initial=0.0))
        inverse, whole = 1j / roots[~at_zero], math.pi / 2 * int(at_zero.sum())
        return lambda w: np.angle(1 - w[..., None] * inverse).sum(-1) + whole

    up, down, delay = turning(process.zeros), turning(process.poles), process.delay
    return lambda w: up(w) - down(w) - delay * w


def frequency_at(process: Process, angle: float) -> float:
    """The lowest frequency [rad/s] at which the phase is `angle` [rad], to rounding.

    Raises NoSuchFrequency where the phase never gets there.

    >>> round(frequency_at(Process((1.0,), (1.0, 3.0, 3.0, 1.0)), -math.pi), 9)
    1.732050808
    """
    from scipy.optimize import brentq

    corners = [abs(x) for x in (*process.poles, *process.zeros) if abs(x) > 0]
    corners += [1 / process.delay] if process.delay else []
    low, high = math.log10(min(corners, default=1.0)) - 4, math.log10(max(corners, default=1.0)) + 4
    grid, turned = np.logspace(low, high, 400), _phase_function(process)
    below = np.flatnonzero(turned(grid) <= angle)
    if not below.size or below[0] == 0:
        span = np.degrees(turned(grid[[0, -1]]))
        raise NoSuchFrequency(
            f"the phase of the process runs from {span[0]:.0f} to {span[1]:.0f} degrees and does not pass "
            f"{math.degrees(angle):.0f} degrees"
        )
    a, b = grid[below[0] - 1], grid[below[0]]
    return float(brentq(lambda w: float(turned(np.array(w))) - angle, a, b, xtol=1e-15, rtol=1e-14))


def ultimate(process: Process) -> FrequencyPoint:
    """The ultimate point: the lowest frequency at which the phase is -180 degrees.

    Raises NoSuchFrequency for a process that never lags so far, such as one of first or second order without dead time.

    >>> point = ultimate(Process((1.0,), (1.0, 3.0, 3.0, 1.0)))
    >>> round(point.K180, 9), round(point.T180, 6)
    (0.125, 3.627599)
    """
    w = frequency_at(process, -math.pi)
    return FrequencyPoint(float(abs(process(1j * w))), w)
