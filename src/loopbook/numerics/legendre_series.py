"""Legendre series on [-1, 1]: values at many points, and between which of them a series keeps its sign."""

from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre


def series(c: np.ndarray, x: np.ndarray) -> np.ndarray:
    """A Legendre series with coefficients of its own for every x; c: shape (p+1, ...).

    A single x is summed in Python's numbers, which are faster than arrays of one.
    """
    if x.size == 1 and c.size == len(c):
        return np.full(x.shape, _clenshaw(c.ravel().tolist(), x.item()))
    return _clenshaw(c, x)


def _clenshaw(c: Any, x: Any) -> Any:
    after = last = 0 * x
    for k in range(len(c) - 1, 0, -1):
        after, last = c[k] + (2 * k + 1) / (k + 1) * x * after - (k + 1) / (k + 2) * last, after
    return c[0] + x * after - 0.5 * last


def keeps_sign(values: np.ndarray, departure: np.ndarray) -> np.ndarray:
    """Between which neighbouring nodes a function keeps its sign that departs so far at most from the nearer value."""
    same = values[:, :-1] * values[:, 1:] > 0
    return same & (np.minimum(np.abs(values[:, :-1]), np.abs(values[:, 1:])) > departure[:, None])


@cache
def nodes_of(count: int, density: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Equally spaced nodes, matrices from Legendre coefficients to values and slopes there, and max |P_k'|, |P_k''|."""
    nodes, k = np.linspace(-1, 1, density * count + 1), np.arange(count)
    values = legendre.legvander(nodes, count - 1)
    slopes = values[:, : max(count - 1, 1)] @ legendre.legder(np.eye(count)) if count > 1 else np.zeros_like(values)
    return nodes, values.T, slopes.T, k * (k + 1) / 2, (k - 1) * k * (k + 1) * (k + 2) / 8


@cache
def slopes_of(count: int) -> np.ndarray:
    """The matrix from Legendre coefficients to those of the derivative, as many."""
    matrix = np.zeros((count, count))
    matrix[: max(count - 1, 1)] = legendre.legder(np.eye(count))
    return matrix


@cache
def sampling(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss nodes and the matrix from values there to Legendre coefficients, exact below degree `count`."""
    nodes = legendre.leggauss(count)[0]
    return nodes, np.linalg.inv(legendre.legvander(nodes, count - 1))
