"""One cell of a linear differential equation with a delayed input, as a matrix: Radau collocation of degree 24.

    x'(t) = A x(t) + b v(t) + e             x(0) = 0
    o(t)  = C x(t) + D v(t) + f             outputs; output number 0 is fed back:
    v(t)  = o_0(t - L),  0 for t < L        (for L = 0 the loop is closed algebraically)

Polynomials through the Radau points of a cell are an L-stable collocation whose error falls faster than any power of
the cell's length. The equation is linear, so what a cell does is one matrix.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics.state_space import balancing

DEGREE = 24
REACH = 8.0
MOST_CELLS = 200_000
MANY_STATES = 9  # beyond, p systems of n cost less than one of p n
SLIVER = 0.02  # of the cell before: a last cell so short joins it


class ResponseError(LoopbookError):
    """A response that cannot be computed as asked: the message says why and what can be asked instead."""


@dataclass(frozen=True)
class DelayEquation:
    """The matrices of the module's equation: A (n, n), b, e (n,), C (m, n), D, f (m,), delay L [s] >= 0."""

    A: np.ndarray
    b: np.ndarray
    e: np.ndarray
    C: np.ndarray
    D: np.ndarray
    f: np.ndarray
    delay: float

    def balanced(self) -> "DelayEquation":
        """The same equation in units of x and v in which the loop's matrix has rows and columns of one size."""
        n = len(self.A)
        if not n:
            return self
        loop = np.block([[self.A, self.b[:, None]], [self.C[:1], self.D[:1, None]]])
        scale = balancing(loop)
        x, v = scale[:n], scale[n]
        out = np.ones(len(self.C))
        out[0] = 1 / v
        return DelayEquation(
            self.A * x / x[:, None],
            self.b * v / x,
            self.e / x,
            self.C * x * out[:, None],
            self.D * v * out,
            self.f * out,
            self.delay,
        )

    def closed(self) -> "DelayEquation":
        """The same equation with v eliminated, for L = 0. Raises ResponseError for an algebraic loop."""
        gap = 1 - self.D[0]
        if abs(gap) < 1e-12:
            raise ResponseError(
                "algebraic loop: process and regulator both act at once and their gains at infinite frequency multiply "
                "to -1, so that the loop has no solution; give one of them a pole or a dead time"
            )
        row, constant = self.C[0] / gap, self.f[0] / gap
        zero = np.zeros_like
        return DelayEquation(
            self.A + np.outer(self.b, row),
            zero(self.b),
            self.e + self.b * constant,
            self.C + np.outer(self.D, row),
            zero(self.D),
            self.f + self.D * constant,
            0.0,
        )


@cache
def radau() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radau points in (-1, 1], their Butcher matrix for [0, 1], and values at -1 and the points -> coefficients."""
    from numpy.polynomial import legendre
    from scipy.special import roots_jacobi

    nodes = np.append(roots_jacobi(DEGREE - 1, 1, 0)[0], 1.0)
    powers = legendre.legvander(nodes, DEGREE)
    start = legendre.legvander(np.array([-1.0]), DEGREE)
    integrals = [powers[:, 1] - start[:, 1]]
    for k in range(1, DEGREE):
        integrals.append((powers[:, k + 1] - powers[:, k - 1]) / (2 * k + 1))
    integrals[0] = nodes + 1
    butcher = np.linalg.solve(powers[:, :DEGREE].T, np.array(integrals)).T / 2
    return nodes, butcher, np.linalg.inv(np.vstack([start, powers]))


def graded_mesh(A: np.ndarray, length: float) -> np.ndarray:
    """Cells on [0, length]: as long as the fastest mode that has not yet died out allows."""
    modes = np.linalg.eigvals(A) if len(A) else np.zeros(0)
    modes = modes[abs(modes) > 0]
    edges, step = [0.0], 0.0
    while length - edges[-1] > SLIVER * (step or length):
        alive = abs(modes[-modes.real * edges[-1] < 40])
        step = REACH / alive.max() if alive.size else length
        if len(edges) > MOST_CELLS:
            raise ResponseError(f"a horizon of {length:g} s holds too many periods of the fastest mode: shorten it")
        edges.append(edges[-1] + step)
    edges[-1] = length
    return np.array(edges)


def cell_operator(system: DelayEquation, length: float, driven: bool = True) -> np.ndarray:
    """X at the nodes as a linear map of (x at the start, v at the nodes, 1): shape (p, n, n + p + 1).

    driven: False leaves v out, where there is none: shape (p, n, n + 1).
    """
    _, a, _ = radau()
    n, p = len(system.A), DEGREE
    integral = length * a
    right = np.zeros((p, n, n + p * driven + 1))
    right[:, :, :n] = np.eye(n)
    if driven:
        right[:, :, n:-1] = integral[:, None, :] * system.b[:, None]
    right[:, :, -1] = integral.sum(axis=1)[:, None] * system.e
    if n > MANY_STATES:
        return _node_by_node(system.A, length, right)
    matrix = np.eye(p * n) - (integral[:, None, :, None] * system.A[:, None, :]).reshape(p * n, p * n)
    return np.linalg.solve(matrix, right.reshape(p * n, right.shape[2])).reshape(right.shape)


@cache
def _triangular_butcher() -> tuple[np.ndarray, np.ndarray]:
    """(T, Q): the Butcher matrix is Q T Q^H, T upper triangular, Q unitary (Schur)."""
    from scipy.linalg import schur

    return schur(radau()[1], output="complex")


def _node_by_node(A: np.ndarray, length: float, right: np.ndarray) -> np.ndarray:
    """X - length (a x A) X = right, from the last row of the triangular form of a up: p systems of n unknowns."""
    T, Q = _triangular_butcher()
    X = np.tensordot(Q.conj().T, right, axes=1)
    AX = np.zeros_like(X)
    for i in reversed(range(DEGREE)):
        known = X[i] + length * np.tensordot(T[i, i + 1 :], AX[i + 1 :], axes=1)
        X[i] = np.linalg.solve(np.eye(len(A)) - length * T[i, i] * A, known)
        AX[i] = A @ X[i]
    return np.tensordot(Q, X, axes=1).real


def outputs(system: DelayEquation, G: np.ndarray) -> np.ndarray:
    """Each output at the start and the nodes of a cell, then x at its end, as a map of x, of v there, and of 1.

    Of x and 1 alone where G is of a cell that is not driven.
    """
    n, p, driven = len(system.A), DEGREE, G.shape[2] > len(system.A) + 1
    states = np.zeros((p + 1, n, G.shape[2] + driven))
    states[0, :, :n] = np.eye(n)
    states[1:, :, :n], states[1:, :, -1] = G[:, :, :n], G[:, :, -1]
    if driven:
        states[1:, :, n + 1 : -1] = G[:, :, n:-1]
    values = (system.C @ states).transpose(1, 0, 2)
    for q in range(p + 1 if driven else 0):
        values[:, q, n + q] += system.D
    values[:, :, -1] += system.f[:, None]
    return np.vstack([values.reshape(-1, states.shape[2]), states[-1]])
