"""Where a Nyquist curve that touches the circle at one frequency touches it again.

At the first touch w the clearance |C + L|^2 - R^2 has a double zero, whatever the frequency x asked for. Divided by
(x - w)^2 it is a smooth function of x, which says the same of a second touch far away, close by, or grown out of the
first one: its smallest value is zero. The quotient is formed by divided differences of L along s = jx,

    L(x) = L(w) + L'(w) d + L[w, w, x] d^2,   d = j (x - w)

    (|C + L|^2 - R^2)/(x - w)^2 = |L'(w) + L[w, w, x] d|^2 - 2 Re(conj(C + L(w)) L[w, w, x])

so that no digit is lost where x comes close to w; far from w it is what it says.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from loopbook.process.transfer_function import Process
from loopbook.tuning.migo_branch import circle, smooth_branch

WIDTH = 1.1
TURN = 1.0  # what a search window may hold of the dead time's phase, in rad
SIDE, ZOOM, MOST = 10, 20, 60
SMALL, NEAR = 0.3, 0.5


def room_beside(process: Process, w: float, x: np.ndarray, M: float) -> np.ndarray:
    """w^2 (|C + L|^2 - R^2)/(x - w)^2 at the frequencies x [rad/s], for the settings that touch at w."""
    k, ki, kd = smooth_branch(process, np.array(w), M).tolist()
    C, R = circle(M)
    at, s = 1j * w, 1j * np.asarray(x, dtype=float)
    d = s - at
    above = _differences(np.convolve(process.num, [kd, k, ki]), at, s)
    below = _reciprocal(_differences((*process.den, 0.0), at, s))
    loop = _product(_product(above, below), _delay(process.delay, at, d))
    here, slope, there, _, second = loop
    beside = abs(slope + second * d) ** 2 - 2 * (np.conj(C + here) * second).real
    far = (abs(C + there) ** 2 - R**2) / np.maximum(abs(d), NEAR * w) ** 2
    return w**2 * np.where(abs(d) < NEAR * w, beside, far)


def least_room(process: Process, w: float, near: float, M: float, known: bool = False) -> tuple[float, float]:
    """The least value of `room_beside` in the valley that `near` lies in, and where: by zooming in, and a parabola.

    known: `near` is the lowest place for a touch close to w.
    """
    width = min(np.log(WIDTH), TURN / (process.delay * near) if process.delay else np.inf)
    centre, width = near, width / ZOOM if known else width
    for _ in range(MOST):
        x = centre * np.exp(np.linspace(-width, width, 2 * SIDE + 1))
        room = room_beside(process, w, x, M)
        i = int(room.argmin())
        if i in (0, 2 * SIDE):  # down the valley first
            centre = float(x[i])
            continue
        left, middle, right = room[i - 1 : i + 2]
        bend = left - 2 * middle + right
        shift = (left - right) / (2 * bend) if bend > 0 else 0.0
        centre = float(x[i] * np.exp(shift * width / SIDE))
        if known:
            return float(middle - (right - left) ** 2 / (8 * bend) if bend > 0 else middle), centre
        known, width = True, width / ZOOM
    return float(room.min()), centre


Differences = tuple[Any, Any, Any, Any, Any]
"""f(w), f'(w), f(x), f[w, x], f[w, w, x]."""


def _differences(p: Sequence[float] | np.ndarray, at: complex, s: np.ndarray) -> Differences:
    """Of a polynomial, by Horner's rule three times over."""
    value, slope, there, first, second = 0j, 0j, 0 * s, 0 * s, 0 * s
    for c in p:
        second = second * s + slope  # p[w, w, x] of what is done so far
        first = first * s + value
        slope = slope * at + value
        there = there * s + c
        value = value * at + c
    return value, slope, there, first, second


def _reciprocal(f: Differences) -> Differences:
    """Of 1/f, from f (1/f) = 1."""
    value, slope, there, first, second = f
    first_of = -first / (value * there)
    return 1 / value, -slope / value**2, 1 / there, first_of, -(slope * first_of + second / there) / value


def _product(f: Differences, g: Differences) -> Differences:
    return (
        f[0] * g[0],
        f[1] * g[0] + f[0] * g[1],
        f[2] * g[2],
        f[3] * g[2] + f[0] * g[3],
        f[4] * g[2] + f[1] * g[3] + f[0] * g[4],
    )


def _delay(delay: float, at: complex, d: np.ndarray) -> Differences:
    """Of exp(-L s)."""
    here, z = np.exp(-delay * at), -delay * d
    near = abs(z) < SMALL
    safe = np.where(near, 1.0, z)
    series = sum(np.where(near, z, 0.0) ** i / _factorial(i + 2) for i in range(12))
    second = np.where(near, series, (np.expm1(safe) - safe) / safe**2)  # (e^z - 1 - z)/z^2
    first = 1 + z * second
    return here, -delay * here, here * np.exp(z), -delay * here * first, delay**2 * here * second


def _factorial(n: int) -> float:
    return float(np.prod(np.arange(1.0, n + 1)))
