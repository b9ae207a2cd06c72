"""A signal in continuous time: one polynomial per cell, each as accurate as double precision allows.

What an exact simulation returns. It can be evaluated at any time, integrated, squared, and asked where it crosses a
level or turns; nothing of that depends on a grid of time points.

    f(t) = sum_k c_ik P_k(x),   x = 2 (t - t_i)/(t_(i+1) - t_i) - 1,   t_i <= t < t_(i+1)      (P_k: Legendre)

The signal is zero before its first cell (the loop is at rest) and unknown after the last one, which is an error.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial import legendre

from derivations.errors import LoopbookError
from loopbook.numerics.legendre_series import keeps_sign, nodes_of, sampling, series, slopes_of

ROUNDED = 2 * float(np.finfo(float).eps)
QUIET, STILL, ROUNDING = 1e-13, 1e-11, 2e-15  # parts of a signal's largest value
DENSITIES = (2, 16, 128)  # nodes per coefficient of a cell


class HorizonError(LoopbookError):
    """A signal was asked beyond the time it is known for."""


@dataclass(frozen=True)
class Signal:
    """A piecewise polynomial of time.

    edges: cell boundaries t_0 < t_1 < ... [s], shape (m+1,). coefficients: Legendre coefficients, shape (m, p+1).
    At an edge the right-hand cell counts: a jump has happened. Raises HorizonError beyond the last edge.

    >>> ramp = Signal(np.array([0.0, 2.0]), np.array([[1.0, 1.0]]))
    >>> ramp([-1.0, 0.5, 2.0]), float(ramp.integral())
    (array([0. , 0.5, 2. ]), 2.0)
    """

    edges: np.ndarray
    coefficients: np.ndarray

    def __post_init__(self) -> None:
        if self.edges.shape != (len(self.coefficients) + 1,):
            raise ValueError(f"{len(self.coefficients)} cells need {len(self.coefficients) + 1} edges")

    def __repr__(self) -> str:
        return f"Signal({len(self.coefficients)} cells from {self.start:g} to {self.end:g} s)"

    @property
    def start(self) -> float:
        return float(self.edges[0])

    @property
    def end(self) -> float:
        return float(self.edges[-1])

    @cached_property
    def lengths(self) -> np.ndarray:
        """The length of each cell [s]."""
        return np.diff(self.edges)

    def __call__(self, times: Any) -> np.ndarray:
        t = np.asarray(times, dtype=float)
        if np.isnan(t).any():
            raise ValueError("a time is NaN")
        if t.size and t.max() > self.end * (1 + 1e-12):
            raise HorizonError(f"t = {t.max():g} s lies beyond the horizon, {self.end:g} s: ask for a longer one")
        cell = np.clip(np.searchsorted(self.edges, t, side="right") - 1, 0, len(self.coefficients) - 1)
        x = 2 * (np.maximum(t, self.start) - self.edges[cell]) / self.lengths[cell] - 1
        return np.where(t < self.start, 0.0, series(np.moveaxis(self.coefficients[cell], -1, 0), x))

    def delayed(self, delay: float) -> "Signal":
        """The same signal `delay` seconds later; cells that so late are shorter than any number tells are left out."""
        if not delay:
            return self
        edges = self.edges + delay
        kept = np.diff(edges) > 0
        return Signal(edges[np.append(True, kept)], self.coefficients[kept])

    def until(self, time: float) -> "Signal":
        """The signal cut off at `time`, which becomes its horizon."""
        if time > self.end * (1 + 1e-12):
            raise HorizonError(f"t = {time:g} s lies beyond the horizon, {self.end:g} s: ask for a longer one")
        inside = self.edges[self.edges < time * (1 - 1e-14)]
        return self.on(np.append(inside, time)) if time < self.end else self

    def on(self, edges: np.ndarray) -> "Signal":
        """The same signal on other cells, which must refine its own or cut it."""
        middle = (edges[:-1] + edges[1:]) / 2
        cell = np.searchsorted(self.edges, middle, side="right") - 1
        known = (cell >= 0) & (cell < len(self.coefficients))
        cell = np.clip(cell, 0, len(self.coefficients) - 1)
        rows = np.where(known[:, None], self.coefficients[cell], 0.0)
        cut = np.flatnonzero(known & ((edges[:-1] != self.edges[cell]) | (edges[1:] != self.edges[cell + 1])))
        if cut.size:
            nodes, to_coefficients = sampling(self.coefficients.shape[1])
            t = middle[cut, None] + np.diff(edges)[cut, None] / 2 * nodes
            x = 2 * (t - self.edges[cell[cut]][:, None]) / self.lengths[cell[cut]][:, None] - 1
            rows[cut] = series(rows[cut].T[:, :, None], x) @ to_coefficients.T
        return Signal(edges, rows)

    def __add__(self, other: "Signal | float") -> "Signal":
        if not isinstance(other, Signal):
            shifted = self.coefficients.copy()
            shifted[:, 0] += float(other)
            return Signal(self.edges, shifted)
        if self.edges.shape == other.edges.shape and (self.edges == other.edges).all():
            return Signal(self.edges, _padded(self.coefficients, other) + _padded(other.coefficients, self))
        end = min(self.end, other.end)
        edges = np.unique(np.concatenate([self.edges, other.edges]))
        edges = edges[edges <= end]
        keep = np.append(True, np.diff(edges) > 1e-13 * abs(end))
        edges = edges[keep]
        a, b = self.on(edges), other.on(edges)
        return Signal(edges, _padded(a.coefficients, b) + _padded(b.coefficients, a))

    def __mul__(self, factor: float) -> "Signal":
        return Signal(self.edges, float(factor) * self.coefficients)

    __rmul__ = __mul__

    def __neg__(self) -> "Signal":
        return self * -1.0

    def __sub__(self, other: "Signal | float") -> "Signal":
        return self + (-other)

    def __rsub__(self, other: float) -> "Signal":
        return (-self) + other

    def derivative(self) -> "Signal":
        """The derivative inside the cells; jumps at edges leave no trace."""
        slopes = self.coefficients @ slopes_of(self.coefficients.shape[1]).T
        return Signal(self.edges, slopes * (2 / self.lengths)[:, None])

    @property
    def _sides(self) -> tuple[np.ndarray, np.ndarray]:
        """The values at the left and at the right end of each cell."""
        signs = (-1.0) ** np.arange(self.coefficients.shape[1])
        return self.coefficients @ signs, self.coefficients.sum(axis=1)

    def _sorted_cells(self) -> tuple[tuple[np.ndarray, ...], np.ndarray]:
        """Where the zeros are: brackets (cell, from, to) with one simple zero each, and the cells that prove less.

        In all other cells there is none, or nothing but rounding. Between two nodes the value departs from that at the
        nearer one by at most sum |c_k| k(k+1)/2, the largest slope, times the distance; and the slope from its own
        value there by sum |c_k| (k-1)k(k+1)(k+2)/8, the largest second derivative. So each gap between nodes is proved
        free of zeros, or monotone, or neither; cells with a gap of neither kind are looked at with more nodes.
        """
        rows = self.coefficients
        size = np.abs(rows).sum(axis=1)
        loud = np.flatnonzero((np.abs(rows[:, 0]) <= size - np.abs(rows[:, 0])) & (size > QUIET * size.max(initial=0)))
        found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        for density in DENSITIES:
            if not loud.size:
                break
            nodes, to_values, to_slopes, steepest, sharpest = nodes_of(rows.shape[1], density)
            reach = (nodes[1] - nodes[0]) / 2
            values, slopes = rows[loud] @ to_values, rows[loud] @ to_slopes
            free = keeps_sign(values, np.abs(rows[loud]) @ steepest * reach)
            monotone = keeps_sign(slopes, np.abs(rows[loud]) @ sharpest * reach)
            proved = (free | monotone).all(axis=1)
            at, gap = np.nonzero(proved[:, None] & ~free & (values[:, :-1] * values[:, 1:] <= 0))
            found.append((loud[at], nodes[gap], nodes[gap + 1]))
            loud = loud[~proved]
        brackets = [np.concatenate(parts) for parts in zip(*found, strict=True)] if found else [np.zeros(0, int)] * 3
        return (brackets[0], brackets[1], brackets[2]), loud

    def _bracketed(self, cell: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """The zeros in the brackets, as x in [-1, 1], by Newton's method kept inside them."""
        c = np.moveaxis(self.coefficients[cell], -1, 0)
        slopes, rounding = slopes_of(len(c)) @ c, ROUNDED * np.abs(c).sum(axis=0)
        both = np.stack([c, slopes], axis=1)
        first, last = series(c, low), series(c, high)
        rising = last > first
        with np.errstate(divide="ignore", invalid="ignore"):
            x = low + (high - low) * first / (first - last)
        x = np.where((x > low) & (x < high), x, (low + high) / 2)
        for _ in range(60):
            value, slope = (series(c, x), series(slopes, x)) if x.size == 1 else series(both, x)
            above = (value > 0) == rising
            low, high = np.where(above, low, x), np.where(above, x, high)
            with np.errstate(divide="ignore", invalid="ignore"):
                newton = x - value / slope
            after = np.where((newton >= low) & (newton <= high), newton, (low + high) / 2)
            after = np.where(np.abs(value) <= rounding, x, after)
            moved, x = np.abs(after - x).max(initial=0.0), after
            if moved < 1e-15:
                break
        return x

    def roots(self, level: float = 0.0) -> np.ndarray:
        """All times where the signal equals `level` or jumps across it, ascending."""
        shifted = self - level
        brackets, unproved = shifted._sorted_cells()
        x = shifted._bracketed(*brackets) if brackets[0].size else np.zeros(0)
        found = [*(self.edges[brackets[0]] + (x + 1) / 2 * self.lengths[brackets[0]])]
        for i in unproved:
            row = shifted.coefficients[i]
            trimmed = legendre.legtrim(row, 1e-16 * np.abs(row).max())
            x = np.atleast_1d(legendre.legroots(trimmed))
            x = x[(abs(x.imag) < 1e-7) & (abs(x.real) <= 1 + 1e-10)].real
            slope = slopes_of(len(trimmed)) @ trimmed
            for _ in range(2):
                rise = legendre.legval(x, slope)
                safe = np.where(rise == 0, np.inf, rise)
                x = np.clip(x - np.clip(legendre.legval(x, trimmed) / safe, -1e-6, 1e-6), -1, 1)
            found.extend(self.edges[i] + (x + 1) / 2 * self.lengths[i])
        left, right = shifted._sides
        before = np.concatenate([[0.0 - level], right[:-1]])
        found.extend(self.edges[:-1][before * left < 0])
        roots = np.sort(np.array(found, dtype=float))
        return roots[np.append(True, np.diff(roots) > 1e-12 * self.end)] if roots.size else roots

    def extremes(self) -> tuple[np.ndarray, np.ndarray]:
        """Times and values of all candidates for a maximum or minimum: turning points and both sides of every edge.

        Within a cell where the signal moves by less than 1e-11 of its largest value, the edges stand for all of it;
        coefficients that are rounding of that value turn nothing.
        """
        return self._extremes

    @cached_property
    def _extremes(self) -> tuple[np.ndarray, np.ndarray]:
        size = np.abs(self.coefficients)
        largest = size.sum(axis=1).max(initial=0.0)
        lively = size[:, 1:].sum(axis=1) > STILL * largest
        told = np.where((size > ROUNDING * largest) & lively[:, None], self.coefficients, 0.0)
        turning = Signal(self.edges, told).derivative().roots()
        times = np.concatenate([turning, self.edges])
        order = np.argsort(times, kind="stable")
        t, values = times[order], self(times)[order]
        return np.concatenate([t, self.edges[1:]]), np.concatenate([values, self._sides[1]])

    def maximum(self) -> tuple[float, float]:
        """(time, value) of the largest value, the first of equal ones."""
        t, v = self.extremes()
        return _first(t, v, v)

    def minimum(self) -> tuple[float, float]:
        """(time, value) of the smallest value, the first of equal ones."""
        t, v = self.extremes()
        return _first(t, v, -v)

    def peak(self) -> tuple[float, float]:
        """(time, value) of the largest magnitude, the first of equal ones; the value keeps its sign."""
        t, v = self.extremes()
        return _first(t, v, np.abs(v))

    def integral(self) -> float:
        """The integral over all cells [unit s]."""
        return float(self.coefficients[:, 0] @ self.lengths)

    def integral_of_square(self) -> float:
        """The integral of the square, exact for the polynomials: sum of c_k^2 d/(2k+1)."""
        weights = 1 / (2 * np.arange(self.coefficients.shape[1]) + 1)
        return float((self.coefficients**2 @ weights) @ self.lengths)

    def integral_of_magnitude(self) -> float:
        """The integral of |f|, split where f changes sign."""
        edges = np.unique(np.concatenate([self.edges, self.roots()]))
        edges = edges[np.append(True, np.diff(edges) > 1e-14 * self.end)]
        edges[-1] = self.end
        pieces = self.on(edges)
        return float(np.abs(pieces.coefficients[:, 0]) @ pieces.lengths)


def _first(t: np.ndarray, v: np.ndarray, measure: np.ndarray) -> tuple[float, float]:
    top = np.flatnonzero(measure >= measure.max() - 1e-13 * np.abs(v).max())
    i = top[np.argmin(t[top])]
    return float(t[i]), float(v[i])


def _padded(rows: np.ndarray, other: Signal) -> np.ndarray:
    missing = other.coefficients.shape[1] - rows.shape[1]
    return np.pad(rows, ((0, 0), (0, max(missing, 0))))
