"""Where the zeros of p_0(s) + p_1(s) exp(-d_1 s) + ... lie, approximately: eigenvalues of the discretised equation.

The zeros are the exponents of the solutions of p_0(D) y(t) + p_1(D) y(t - d_1) + ... = 0. With x' = A x + B w,
y = C x + D w, w_j = y(t - d_j), the state is x and what y did in the last max d seconds; that is a polynomial through
Chebyshev points, whose movement is a matrix (D. Breda, S. Maset, R. Vermiglio, Stability of linear delay differential
equations, 2015, chapter 5). Its eigenvalues near the origin are zeros almost to rounding; s = s_0 + s' looks near s_0.
"""

from functools import cache

import numpy as np

from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.state_space import observer_form


@cache
def chebyshev(m: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The m + 1 Chebyshev points in [-1, 1] from 1 down, their barycentric weights, and their derivative matrix."""
    x = np.cos(np.pi * np.arange(m + 1) / m)
    weights = (-1.0) ** np.arange(m + 1)
    weights[[0, -1]] /= 2
    with np.errstate(divide="ignore"):
        matrix = (weights / weights[:, None]) / (x[:, None] - x)
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return x, weights, matrix


def _reading(m: int, at: float) -> np.ndarray:
    """The row that reads a polynomial through the Chebyshev points at one point."""
    x, weights, _ = chebyshev(m)
    hit = np.flatnonzero(x == at)
    if hit.size:
        return np.eye(m + 1)[hit[0]]
    row = weights / (at - x)
    return np.asarray(row / row.sum())


class DelaySpectrum:
    """Of f with its least delay 0, whose term has the highest power of s. It is realised once."""

    def __init__(self, f: ExponentialPolynomial):
        (_, first), *later = f.terms
        self.delays = np.array([delay for delay, _ in later])
        self.plant = observer_form(first, [[-c for c in p] for _, p in later])

    def near(self, centre: complex, points: int) -> np.ndarray:
        """Approximate zeros near `centre`, shape (order + points,); those far from it are no zeros at all."""
        plant, n = self.plant, len(self.plant.A)
        shift = complex(centre) if centre else 0.0  # y(t) = exp(s_0 t) v(t): v moves as y does, x' gets - s_0 x
        longest = float(self.delays.max())
        rows = np.array([_reading(points, 1 - 2 * d / longest) for d in self.delays])
        rows = rows * np.exp(-shift * self.delays)[:, None] if shift else rows
        now = plant.D[0] @ rows  # y(0) = C x + now . (y(0), y at the points before)
        present = np.concatenate([plant.C[0], now[1:]]) / (1 - now[0])
        history = plant.B @ rows
        size = n + points
        matrix = np.zeros((size, size), dtype=complex if shift else float)
        matrix[:n, :n], matrix[:n, n:] = plant.A, history[:, 1:]
        matrix[:n] += np.outer(history[:, 0], present)
        moving = chebyshev(points)[2] * (2 / longest)
        matrix[n:, n:] = moving[1:, 1:]
        matrix[n:] += np.outer(moving[1:, 0], present)
        matrix[:n, :n] -= shift * np.eye(n)
        return np.linalg.eigvals(matrix) + shift
