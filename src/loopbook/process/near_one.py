"""A sampled process in powers of z - 1: what fast sampling needs, which brings all that matters near z = 1.

    B(z^-1) = z^-(n + 1 + whole) N(z - 1),      A(z^-1) = z^-n Prod (z - 1 - (exp(p_i h) - 1))

In powers of z^-1 the coefficients of a process sampled 100 times in its time constant cancel all but a few digits of
each other. exp(A h) - 1 and exp(p h) - 1 are formed without that difference, and N from them as a continuous process's
numerator from its state space.
"""

import numpy as np

from loopbook.numerics.state_space import StateSpace
from loopbook.process.sampled import SampledProcess


def moved(plant: StateSpace, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """exp(A d) - 1 and int_0^d exp(A s) ds B, both without cancellation."""
    from scipy.linalg import expm

    n = len(plant.A)
    block = np.zeros((2 * n, 2 * n))
    block[:n, :n], block[:n, n:] = plant.A * duration, np.eye(n)
    mean = expm(block)[:n, n:]  # int_0^1 exp(A d s) ds
    return plant.A * duration @ mean, duration * (mean @ plant.B)


def numerator_near_one(sampled: SampledProcess) -> np.ndarray:
    """N: coefficients of (z - 1)^(n + 1), ..., (z - 1)^0, without whole samples of dead time.

    >>> from loopbook.process.sampled import sample
    >>> from loopbook.process.transfer_function import Process
    >>> numerator_near_one(sample(Process([2], [1, 0, 0]), 1e-6)) * 1e12       # h^2 (z + 1)/z^2, times z^3
    array([0., 1., 3., 2.])
    """
    plant, h, tau = sampled.plant, sampled.h, sampled.tau
    change, newer = moved(plant, h - tau)
    older = np.zeros_like(newer)
    if tau:
        early, of_early = moved(plant, tau)
        older = of_early + change @ of_early
        change = change + early + change @ early
    A = np.atleast_1d(np.real(np.poly(np.expm1(sampled.process.poles * h))))
    direct = A * plant.D[0, 0]
    of_newer, of_older = (_numerator(A, change, plant.C[0], column[:, 0]) for column in (newer, older))
    total = np.append(of_newer, 0.0) + np.append(0.0, of_newer)  # times z = 1 + (z - 1)
    total[1:] += of_older
    total[1:] += direct
    if not tau:
        total[:-1] += direct
    return total


def zeros_near_one(sampled: SampledProcess) -> np.ndarray:
    """The z where B = 0, those at infinity left out; exact relative to their distance from 1."""
    N = numerator_near_one(sampled) if sampled.exact is None else sampled.exact[2]
    return 1 + np.roots(np.trim_zeros(N, "f")).astype(complex)


def _numerator(A: np.ndarray, change: np.ndarray, row: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Of row (d - change)^-1 column over A(d): coefficients of d^n, ..., d^0; the first is zero."""
    markov = np.zeros(len(A))
    for i in range(1, len(A)):
        markov[i] = row @ column
        column = change @ column
    return np.convolve(A, markov)[: len(A)]
