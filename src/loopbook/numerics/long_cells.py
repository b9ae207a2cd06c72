"""Cells longer than the dead time: the method of steps goes on where the corners of the start have worn off.

A step at t = 0 leaves a corner at every multiple of the dead time L, each smoother than the one before. When they can
no longer be told from a polynomial, a cell may span many of them. The delayed signal of a cell [a, a + d] with d > L is
then known from the cells before where t - L < a, and otherwise it is the cell's own polynomial, read L earlier: one
more linear equation for the values at the nodes.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from loopbook.numerics.collocation import (
    DEGREE,
    MOST_CELLS,
    DelayEquation,
    ResponseError,
    cell_operator,
    outputs,
    radau,
)

RESOLVED = 3e-14
ROUNDED = 1e-9
WORN_OFF = 32
PATIENCE = 4
NOTHING = 1e-17


def smooth_from(system: DelayEquation) -> int | None:
    """After how many dead times the corners have worn off; None where they never do.

    What acts at once around the loop, D_0, repeats each jump D_0 times as large.
    """
    again = abs(float(system.D[0]))
    if again >= 1:
        return None
    return WORN_OFF + (int(np.ceil(np.log(NOTHING) / np.log(again))) if again else 0)


@dataclass(frozen=True)
class _Cell:
    """forward: (x at the start, v at the start and at nodes that lie in the past, 1) -> outputs at the start and the
    nodes, x at the end. past: which nodes those are, as times after the cell's start [s]. readings: by the length of
    the cell before, what its coefficients are multiplied with to read it there.
    """

    forward: np.ndarray
    past: np.ndarray
    readings: dict[float, np.ndarray] = field(default_factory=dict)


def _cell(system: DelayEquation, length: float) -> _Cell:
    n, nodes, to_coefficients = len(system.A), radau()[0], radau()[2]
    plain = outputs(system, cell_operator(system, length))
    after = (nodes + 1) / 2 * length - system.delay
    past, own = np.flatnonzero(after < 0), np.flatnonzero(after >= 0)
    given = np.concatenate([np.arange(n + 1), n + 1 + past, [n + DEGREE + 1]])
    reading = legendre.legvander(2 * after[own] / length - 1, DEGREE) @ to_coefficients
    fed_back = plain[: DEGREE + 1]
    inner = np.linalg.solve(np.eye(len(own)) - reading @ fed_back[:, n + 1 + own], reading @ fed_back[:, given])
    return _Cell(plain[:, given] + plain[:, n + 1 + own] @ inner, np.append(-system.delay, after[past]))


def continued(
    system: DelayEquation,
    lengths: np.ndarray,
    coefficients: np.ndarray,
    x: np.ndarray,
    scale: np.ndarray,
    span: float,
) -> tuple[np.ndarray, np.ndarray]:
    """More cells after those of the given lengths, over `span` seconds: all lengths, and all coefficients.

    coefficients: shape (cells, m, p + 1). x: the state at their end. scale: how large each output has been, to which
    the last coefficients of a cell are compared. Raises ResponseError where the response overflows or does not let
    itself be resolved.
    """
    cells = cache(lambda length: _cell(system, length))
    known = _Known(lengths.tolist(), list(coefficients))
    length, done, wait = 2 * system.delay, 0.0, 0
    while done < span:
        if len(known.rows) > MOST_CELLS:
            raise ResponseError("the horizon holds too many periods of the fastest mode: shorten it")
        tried = length
        values, x, length = _accepted(cells, system, known, x, scale, tried)
        known.lengths.append(length)
        known.rows.append(values @ radau()[2].T)
        scale = np.maximum(scale, np.abs(values).max(axis=1))
        done, wait = done + length, PATIENCE if length < tried else wait - 1
        length = 2 * length if wait <= 0 else length
    return np.array(known.lengths), np.array(known.rows)


def _accepted(
    cells: Callable[[float], _Cell],
    system: DelayEquation,
    known: "_Known",
    x: np.ndarray,
    scale: np.ndarray,
    length: float,
) -> tuple[np.ndarray, np.ndarray, float]:
    """The longest of `length`, length/2, ... whose last coefficients are rounding: values, x at its end, length.

    Where halving no longer helps, rounding is reached as far as it can be.
    """
    before: tuple[float, tuple[np.ndarray, np.ndarray, float]] | None = None
    last_rows, outputs_size = radau()[2][-2:].T, len(system.C) * (DEGREE + 1)
    while True:
        cell = cells(length)
        with np.errstate(over="ignore", invalid="ignore"):
            all_values = cell.forward @ np.concatenate([x, known.fed_back(cell), [1.0]])
            values = all_values[:outputs_size].reshape(-1, DEGREE + 1)
            tail = float((np.abs(values @ last_rows).max(axis=1) / np.where(scale > 0, scale, 1.0)).max())
        found = values, all_values[outputs_size:], length
        if tail <= RESOLVED:
            return found
        if before is not None and before[0] < ROUNDED and tail > before[0] / 4:
            return before[1]
        if not np.isfinite(tail) and length < system.delay:
            raise ResponseError("the response grows beyond all numbers before the horizon: the loop is unstable")
        if length < system.delay / 64:
            raise ResponseError(f"rounding limits the response to a relative error of {tail:.1e}: scale the problem")
        before, length = (tail, found), length / 2


@dataclass(frozen=True)
class _Known:
    """The cells so far: their lengths [s] and coefficients."""

    lengths: list[float]
    rows: list[np.ndarray]

    def fed_back(self, cell: _Cell) -> np.ndarray:
        """Output 0 at the times of `cell.past`, counted from the end [s]."""
        times, last = cell.past, self.lengths[-1]
        if -times[0] <= last:  # all in the cell before
            if last not in cell.readings:
                cell.readings[last] = legendre.legvander(2 * (times + last) / last - 1, DEGREE)
            return cell.readings[last] @ self.rows[-1][0]
        starts, first = [0.0], len(self.rows)
        while starts[-1] > times[0]:
            first -= 1
            starts.append(starts[-1] - self.lengths[first])
        edges = np.array(starts[::-1])
        rows = np.array([row[0] for row in self.rows[first:]])
        i = np.searchsorted(edges[1:-1], times, side="right")
        x = 2 * (times - edges[i]) / np.diff(edges)[i] - 1
        return (legendre.legvander(x, DEGREE) * rows[i]).sum(axis=1)
