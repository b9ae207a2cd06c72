"""The smooth optimum as a function of its touching frequency, and how clear of the circle a Nyquist curve stays.

What `loopbook.tuning.migo` searches with: k, ki and kd from `derivations.loop.robustness.smooth_branch`, and the
clearance |C + L(i w)| - R on grids that see every approach to the circle.
"""

import math
from collections.abc import Callable, Iterable
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from loopbook.lazy import late
from loopbook.printed.store import kept_for, lambda_text, run_text
from loopbook.process.frequency_response import response
from loopbook.process.transfer_function import Process

d = late("derivations.loop.robustness")

M_DEFAULT = 1.4
TOLERANCE = 1e-7  # of the distance to the circle: what rounding may take off it


@cache
def circle(M: float) -> tuple[float, float]:
    """Centre distance C and radius R of the joint circle around -C, for M > 1.

    >>> circle(2.0)
    (1.25, 0.75)
    """
    if not M > 1:
        raise ValueError(f"M = {M}: a loop's largest sensitivity exceeds 1, so M must")
    above_centre, below_centre, above_radius, below_radius = _circle()(Fraction(M))
    return -float(above_centre / below_centre), float(above_radius / below_radius)


@cache
def _circle() -> Callable[..., tuple[Fraction, ...]]:
    return run_text(_circle_text(), "math")


@kept_for()
def _circle_text() -> str:
    """Numerator and denominator of centre and radius, whole polynomials, so that fractions stay exact."""
    import sympy

    joint = d.joint_circle()
    parts = [part for e in (joint.centre, joint.radius) for part in sympy.fraction(sympy.cancel(e))]
    return lambda_text([d.M], parts, "math")


@cache
def _branch_functions() -> list[Callable[..., np.ndarray]]:
    """k, ki and kd of the smooth branch as NumPy functions of (w, a, b, r, da, db, C, R)."""
    return [run_text(text, "numpy") for text in _branch_texts()]


@kept_for()
def _branch_texts() -> list[str]:
    found = d.smooth_branch()
    arguments = (d.w, d.a, d.b, d.r, d.da, d.db, d.C, d.R)
    return [lambda_text(arguments, e, "numpy", cse=True) for e in (found.k, found.k_i.subs(d.k_d, 0), found.k_d)]


def smooth_branch(process: Process, w: np.ndarray, M: float = M_DEFAULT) -> np.ndarray:
    """k, ki and kd, shape (3, *w.shape), for touching frequencies w [rad/s]."""
    w = np.asarray(w, dtype=float)
    g, slope = response(process, w)
    arguments = (w, g.real, g.imag, abs(g), slope.real, slope.imag, *circle(M))
    k, ki_of_pi, kd = (f(*arguments) for f in _branch_functions())
    return np.array([k, ki_of_pi + w**2 * kd, kd])


def clearance(process: Process, gains: Iterable[Any], w: np.ndarray, M: float = M_DEFAULT) -> np.ndarray:
    """|C + L(i w)| - R: negative inside the circle. gains: (k, ki, kd), each a number or broadcastable against w."""
    k, ki, kd = gains
    C, R = circle(M)
    return abs(C + process(1j * w) * (k + 1j * (kd * w - ki / w))) - R


def kd_limit(process: Process, M: float) -> float:
    """The largest kd where the loop gain tends to kd b0/a0 and that, or its turning by dead time, points at the circle:
    |L| <= (M-1)/M. 0 where derivative action lets the gain grow without end; inf where nothing limits it.
    """
    last = process.num[0] / process.den[0]
    if process.relative_degree > 1 or (not process.delay and last > 0):
        return math.inf
    C, R = circle(M)
    return (C - R) / abs(last) if process.relative_degree else 0.0


def _grid(process: Process, scale: float, gains: np.ndarray, M: float, density: int) -> np.ndarray:
    """Frequencies dense enough to see every approach to the circle: 1.5 % apart, 0.2 rad apart in dead-time phase.

    density: so many times as dense.

    It ends where |L| has faded below the circle's near end for all the gains (or 150 dead-time radians, where it
    does not fade: `kd_limit` decides there).
    """
    coarse = scale * np.logspace(-3, 2.5, 850 * density)
    if not process.delay:
        return coarse
    k, ki, kd = (np.max(abs(x)) for x in gains)
    far = np.logspace(-1, 4, 300) / process.delay
    size = abs(process(1j * far)) * np.hypot(k, kd * far + ki / far)
    C, R = circle(M)
    loud = np.flatnonzero(size >= C - R)
    end = min(far[loud[-1]] if loud.size else 0.0, 2000 / process.delay)
    if math.isfinite(kd_limit(process, M)):
        end = 150 / process.delay
    fine = np.arange(0.2 / density, 1 + end * process.delay, 0.2 / density) / process.delay
    return np.union1d(coarse, fine)


def deepest(
    process: Process, scale: float, gains: np.ndarray, M: float, density: int = 1
) -> tuple[np.ndarray, np.ndarray]:
    """The smallest clearance of each column of gains, shape (3, n), and the frequency where it occurs, (n,).

    The frequency is inf where the limit of the loop gain at high frequency decides.
    """
    w = _grid(process, scale, gains, M, density)
    g = process(1j * w)
    C, R = circle(M)
    k, ki, kd = (x[:, None] for x in gains)
    room = abs(C + g * (k + 1j * (kd * w - ki / w))) - R
    at = room.argmin(axis=1)
    depth, where = room[np.arange(len(at)), at], w[at]
    limit = kd_limit(process, M)
    beyond = gains[2] > limit
    return np.where(beyond, -1.0, depth), np.where(beyond, math.inf, where)
