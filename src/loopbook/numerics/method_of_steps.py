"""Linear differential equations with one delayed feedback, solved to rounding by the method of steps.

Between two multiples of the dead time L the delayed signal is known, so each segment [kL, (k+1)L) is an ordinary linear
equation (`numerics.collocation`). It is solved there through the Radau points of a few cells. The cells are the same in
every segment, hence the delayed values are those stored one segment earlier: nothing is interpolated. A cell whose last
Legendre coefficients are not yet at rounding level is halved, and the solution repeated: the result does not depend on
any grid that a caller chooses. Where the horizon holds many dead times, the rest is done in cells longer than one
(`numerics.long_cells`).
"""

import numpy as np

from loopbook.numerics.collocation import (
    DEGREE,
    DelayEquation,
    ResponseError,
    cell_operator,
    graded_mesh,
    outputs,
    radau,
)
from loopbook.numerics.long_cells import RESOLVED, ROUNDED, continued, smooth_from
from loopbook.numerics.signals import Signal

MANY = 256
MOST_VALUES = 12_000_000

__all__ = ["DelayEquation", "ResponseError", "solve"]


def _march(system: DelayEquation, mesh: np.ndarray, segments: int) -> tuple[np.ndarray, np.ndarray]:
    """Values of all outputs at every start and node: shape (segments, cells, m, p + 1); and x at the end."""
    n, size = len(system.A), len(system.C) * (DEGREE + 1)
    keys = [float(f"{length:.13g}") for length in np.diff(mesh)]
    maps = {key: outputs(system, cell_operator(system, key, segments > 1)) for key in set(keys)}
    along = [maps[key] for key in keys]
    rows = np.empty((segments, len(keys), size + n))
    known = np.zeros(n + (DEGREE + 1) * (segments > 1) + 1)
    x, before, v, known[-1] = known[:n], np.zeros(n), known[n:-1], 1.0
    for k in range(segments):
        for i, operator in enumerate(along):
            x[:] = before
            if k:
                v[:] = rows[k - 1, i, : DEGREE + 1]
            np.dot(operator, known, out=rows[k, i])
            before = rows[k, i, size:]
    return rows[:, :, :size].reshape(segments, len(keys), len(system.C), DEGREE + 1), before


def solve(system: DelayEquation, horizon: float, unit: float = 1.0) -> list[Signal]:
    """The outputs on [0, horizon], one `Signal` each, accurate to rounding.

    horizon > 0, in units of `unit` [s], which only messages name. Raises ResponseError for an algebraic loop, a horizon
    that is not positive, one that holds too many dead times to be stored, and a response that overflows.
    """
    if not (np.isfinite(horizon) and horizon > 0):
        raise ResponseError(f"horizon = {horizon * unit!r} s: a positive number of seconds is expected")
    system = system.balanced()
    if not system.delay:
        system = system.closed()
    segments = max(1, int(np.ceil(horizon / system.delay * (1 - 1e-12)))) if system.delay else 1
    smooth = smooth_from(system) if segments > MANY else None
    short = segments if smooth is None else min(segments, smooth)
    mesh, coefficients, x, scale = _short_cells(system, horizon, short, unit)
    lengths, coefficients = np.tile(np.diff(mesh), short), coefficients.reshape(-1, *coefficients.shape[2:])
    if short == segments:
        starts = np.arange(segments)[:, None] * system.delay + mesh[:-1]
        edges = np.append(starts.ravel(), segments * system.delay if system.delay else horizon)
    else:
        span = horizon - short * system.delay
        lengths, coefficients = continued(system, lengths, coefficients, x, scale, span)
        edges = np.append(0.0, np.cumsum(lengths))
    return [Signal(edges, coefficients[:, j]) for j in range(len(system.C))]


def _short_cells(
    system: DelayEquation, horizon: float, segments: int, unit: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The mesh of each dead time, coefficients (segments, cells, m, p + 1), x at the end, the size of each output."""
    mesh = graded_mesh(system.A, system.delay or horizon)
    best, stalled = np.inf, 0
    for _ in range(30):
        if segments * (len(mesh) - 1) * (DEGREE + 1) * len(system.C) > MOST_VALUES:
            raise ResponseError(
                f"the horizon {horizon * unit:g} s holds {segments} dead times of {system.delay * unit:g} s in "
                f"{len(mesh) - 1} cells each, more than can be stored: shorten the horizon, or leave out a dead time "
                "as short as that"
            )
        with np.errstate(over="ignore", invalid="ignore"):
            values, x = _march(system, mesh, segments)
        if not np.isfinite(values).all():
            raise ResponseError(
                f"the response grows beyond all numbers before t = {horizon * unit:g} s: the loop is unstable"
            )
        coefficients = values @ radau()[2].T
        scale = np.abs(values).max(axis=(0, 1, 3))
        tail = np.abs(coefficients[..., -2:]).max(axis=(0, 3)) / np.where(scale > 0, scale, 1.0)
        rough = tail.max(axis=1) > RESOLVED
        stalled = stalled + 1 if tail.max() > best / 4 else 0
        best = min(best, tail.max())
        if not rough.any() or (stalled == 2 and best < ROUNDED):
            return mesh, coefficients, x.copy(), scale
        if stalled == 5:
            raise ResponseError(f"rounding limits the response to a relative error of {best:.1e}: scale the problem")
        halves = (mesh[:-1] + mesh[1:])[rough] / 2
        mesh = np.sort(np.append(mesh, halves))
    raise ResponseError(f"the response could not be resolved: relative error about {best:.1e}")
