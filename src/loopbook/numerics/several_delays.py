"""The step response of a quotient of exponential polynomials, several dead times in it, to rounding.

    (p_0 + p_1 exp(-d_1 s) + ...) Y = (n_0 exp(-e_0 s) + n_1 exp(-e_1 s) + ...) U,    u a unit step at t = 0

With the state x of 1/p_0 this is  x' = A x + B w,  y = C x + D w,  where w are the y(t - d_j) and the steps at e_i.
The corners of the response lie at e_i + sums of the d_j, each smoother than the ones that it comes from; cells end
there until they have worn off. In a cell, x and y are the polynomials through the Radau points (`collocation`); a
delayed y is known from the cells before, or is the cell's own polynomial read earlier. A cell that is not resolved to
rounding is halved.
"""

import heapq
from bisect import bisect_right

import numpy as np
from numpy.polynomial import legendre

from loopbook.numerics.collocation import DEGREE, ResponseError, radau
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial, characteristic_time_of
from loopbook.numerics.legendre_series import series
from loopbook.numerics.long_cells import NOTHING, RESOLVED, ROUNDED, WORN_OFF
from loopbook.numerics.signals import Signal
from loopbook.numerics.state_space import observer_form
from loopbook.numerics.units import size

SAME_TIME, BESIDE = 1e-12, 1e-9
MOST_CORNERS, MOST_CELLS, KEPT = 20_000, 100_000, 256


def step_response(num: ExponentialPolynomial, den: ExponentialPolynomial, horizon: float) -> Signal:
    """y for a unit step of u at t = 0 from rest, on [0, horizon] s.

    Raises ResponseError where y would precede u, where u is differentiated (y would be an impulse), where a delayed
    derivative is of a higher order than those without delay, and where the response overflows or cannot be stored.

    >>> E = ExponentialPolynomial.of
    >>> y = step_response(E([1.0], 2.0), E([3.0, 1.0]), 5.0)                     # exp(-2 s)/(3 s + 1)
    >>> [float(v) for v in y([1.9, 5.0]).round(9)]
    [0.0, 0.632120559]
    """
    if not (np.isfinite(horizon) and horizon > 0):
        raise ResponseError(f"horizon = {horizon!r} s: a positive number of seconds is expected")
    if num.is_zero:
        return Signal(np.array([0.0, horizon]), np.zeros((1, 1)))
    first = den.delays[0]
    time = characteristic_time_of(num, den)
    above, below = num.delayed(-first).in_units(time), den.delayed(-first).in_units(time)
    _refuse(above, below, time)
    gain, scale = (max(size(p) for _, p in f.terms) for f in (above, below))
    y = _March(above.in_units(1.0, gain), below.in_units(1.0, scale)).until(horizon / time, time)
    return Signal(y.edges * time, y.coefficients * (gain / scale))


def _refuse(num: ExponentialPolynomial, den: ExponentialPolynomial, time: float) -> None:
    if num.delays[0] < -SAME_TIME * max(map(abs, num.delays)):
        raise ResponseError(f"the output precedes the input by {-num.delays[0] * time:.6g} s: no such system exists")
    if len(den.terms[0][1]) - 1 < den.degree:
        raise ResponseError("a delayed term has a higher derivative than the one without delay: it cannot be solved")
    if num.degree > den.degree:
        raise ResponseError("more zeros than poles: the step is differentiated and the output an impulse")


class _March:
    def __init__(self, num: ExponentialPolynomial, den: ExponentialPolynomial):
        (_, first), *later = den.terms
        self.delays = [delay for delay, _ in later]
        self.starts = [max(delay, 0.0) for delay in num.delays]
        rows = [[-c for c in p] for _, p in later] + [list(p) for _, p in num.terms]
        plant = observer_form(first, rows)
        k = len(later)
        self.A, self.C = plant.A, plant.C[0]
        self.B, self.D = plant.B[:, :k], plant.D[0, :k]
        self.steps, self.jumps = plant.B[:, k:], plant.D[0, k:]
        self.longest = max([*self.delays, *self.starts], default=0.0)
        self._factors: dict[float, tuple[np.ndarray, np.ndarray]] = {}

    def _corners(self, horizon: float) -> np.ndarray:
        """Where y or one of its derivatives jumps by more than nothing, ascending."""
        todo = [(start, 0, 1.0) for start in self.starts]
        heapq.heapify(todo)
        found: list[float] = []
        last: dict[tuple[int, int], float] = {}
        while todo:
            at, order, strength = heapq.heappop(todo)
            key = (round(at / (SAME_TIME * max(horizon, self.longest))), order)
            if at >= horizon or last.get(key, 0.0) >= strength:
                continue
            last[key] = strength
            found.append(at)
            if len(found) > MOST_CORNERS:
                raise ResponseError("the response has more corners than can be stored: shorten the horizon")
            for delay, again in zip(self.delays, np.abs(self.D).tolist(), strict=True):
                if again and strength * again > NOTHING:
                    heapq.heappush(todo, (at + delay, order, strength * again))
                if order < WORN_OFF:
                    heapq.heappush(todo, (at + delay, order + 1, strength))
        return np.unique(np.array([*found, 0.0]))

    def until(self, horizon: float, unit: float) -> Signal:
        corners = self._corners(horizon)
        gaps = np.append(True, np.diff(corners) > SAME_TIME * max(horizon, self.longest))
        corners = np.append(corners[gaps], horizon)
        corners = corners[(corners < horizon * (1 - SAME_TIME)) | (corners == horizon)]
        edges, rows, largest = [0.0], list[np.ndarray](), 0.0
        x, length, stalled, before = np.zeros(len(self.A)), horizon, 0, np.inf
        while edges[-1] < horizon:
            a = edges[-1]
            end = float(corners[np.searchsorted(corners, a, side="right")])
            cut = length < (end - a) * (1 - 1e-9)
            h = length if cut else end - a
            with np.errstate(over="ignore", invalid="ignore"):
                coefficients, after = self._cell(a, h, x, edges, rows)
            if not np.isfinite(coefficients).all():
                raise ResponseError(f"the response grows beyond all numbers before t = {horizon * unit:g} s")
            scale = max(largest, float(np.abs(coefficients).sum()))
            tail = float(np.abs(coefficients[-2:]).max()) / scale if scale else 0.0
            if tail > RESOLVED and not (tail > before / 4 and tail < ROUNDED and stalled >= 2):
                stalled, before = (stalled + 1 if tail > before / 4 else 0), tail
                if h < SAME_TIME * horizon:
                    raise ResponseError(f"the response could not be resolved at t = {a * unit:.6g} s")
                length = h / 2
                continue
            stalled, before, largest = 0, np.inf, scale
            edges.append(a + h if cut else end)
            rows.append(coefficients)
            x = after
            length = 2 * h if cut else max(length, h)
            if len(rows) > MOST_CELLS:
                raise ResponseError(f"the horizon {horizon * unit:g} s holds more than can be stored: shorten it")
        return Signal(np.array(edges), np.array(rows))

    def _cell(
        self, a: float, h: float, x: np.ndarray, edges: list[float], rows: list[np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Legendre coefficients of y in [a, a + h], and x at its end."""
        nodes, butcher, to_coefficients = radau()
        n, p = len(self.A), DEGREE
        after = (nodes + 1) / 2 * h
        on = np.array([a + h / 2 >= start for start in self.starts], dtype=float)
        known = np.zeros((len(self.delays), p + 1))
        for j, delay in enumerate(self.delays):
            past = np.append(0.0, after) < delay
            known[j, past] = _past(a + np.append(0.0, after)[past] - delay, a + h / 2 - delay, edges, rows)
        forcing = self.B @ known[:, 1:] + (self.steps @ on)[:, None]
        start = float(self.C @ x + self.D @ known[:, 0] + self.jumps @ on)
        right = np.empty((p, n + 1))
        right[:, :n] = x + h * (butcher @ forcing.T)
        right[:, n] = self.D @ known[:, 1:] + float(self.jumps @ on)
        operator, of_start = self._operator(h)
        solved = (operator @ (right.ravel() + of_start * start)).reshape(p, n + 1)
        return to_coefficients @ np.append(start, solved[:, n]), solved[-1, :n]

    def _operator(self, h: float) -> tuple[np.ndarray, np.ndarray]:
        """The inverse of the cell's equations for (x, y) at the nodes, and what y at the start brings into them."""
        key = float(f"{h:.13g}")
        if key in self._factors:
            return self._factors[key]
        nodes, butcher, to_coefficients = radau()
        n, p = len(self.A), DEGREE
        integral = h * butcher
        matrix = np.zeros((p, n + 1, p, n + 1))
        matrix[:, :n, :, :n] = -integral[:, None, :, None] * self.A[None, :, None, :]
        diagonal = np.arange(p)
        for i in range(n + 1):
            matrix[diagonal, i, diagonal, i] += 1.0
        matrix[diagonal, n, diagonal, :n] -= self.C
        of_start = np.zeros((p, n + 1))
        after = (nodes + 1) / 2 * h
        for delay, b, d in zip(self.delays, self.B.T, self.D, strict=True):
            own = after >= delay
            if not own.any():
                continue
            reading = np.zeros((p, p + 1))
            reading[own] = legendre.legvander(2 * (after[own] - delay) / h - 1, p) @ to_coefficients
            by_state = integral @ reading
            matrix[:, :n, :, n] -= b[None, :, None] * by_state[:, None, 1:]
            matrix[:, n, :, n] -= d * reading[:, 1:]
            of_start[:, :n] += by_state[:, :1] * b
            of_start[:, n] += d * reading[:, 0]
        if len(self._factors) > KEPT:
            self._factors.clear()
        found = np.linalg.inv(matrix.reshape(p * (n + 1), p * (n + 1))), of_start.ravel()
        self._factors[key] = found
        return found


def _past(t: np.ndarray, middle: float, edges: list[float], rows: list[np.ndarray]) -> np.ndarray:
    """y at past times, on the side of a corner on which `middle` lies; zero before t = 0."""
    found = np.zeros(len(t))
    towards = t + (middle - t) * BESIDE
    begun = np.flatnonzero(towards >= 0)
    if not begun.size:
        return found
    first = bisect_right(edges, float(towards[begun].min())) - 1
    last = min(bisect_right(edges, float(towards[begun].max())) - 1, len(rows) - 1)
    for i in range(first, last + 1):
        here = begun[(towards[begun] >= edges[i]) & ((towards[begun] < edges[i + 1]) | (i == last))]
        x = 2 * (t[here] - edges[i]) / (edges[i + 1] - edges[i]) - 1
        found[here] = series(rows[i], x)
    return found
