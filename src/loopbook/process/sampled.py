"""Sampling a process exactly: zero-order hold on the input, any dead time, whole samples or a fraction.

With the dead time L = (l + fraction) h, 0 <= fraction < 1, and x' = A x + B v of the rational part,

    x(k+1) = Phi x(k) + Gamma_0 u(k-l) + Gamma_1 u(k-l-1)

    Phi = exp(A h),   Gamma_0 = int_0^(h - tau) exp(A s) ds B,   Gamma_1 = exp(A (h - tau)) int_0^tau exp(A s) ds B

with tau = fraction h: inside one sampling interval first the older input acts, for tau seconds, then the newer one.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.numerics import polynomial_text
from loopbook.numerics.state_space import StateSpace, observer_form
from loopbook.plots.curves import curves
from loopbook.plots.shown import shown_once
from loopbook.process.transfer_function import Process, ProcessError


def held(plant: StateSpace, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """exp(A d) and int_0^d exp(A s) ds B for a constant input over `duration` d [s]."""
    from scipy.linalg import expm

    n, k = plant.B.shape
    block = np.zeros((n + k, n + k))
    block[:n, :n], block[:n, n:] = plant.A, plant.B
    result = expm(block * duration)
    return result[:n, :n], result[:n, n:]


@dataclass(frozen=True)
class SampledProcess:
    """A process seen at the sampling instants kh. Make it with `sample`.

    plant: state space of the rational part. whole, tau: dead time = whole h + tau, 0 <= tau < h. h: interval [s].

    >>> sampled = sample(Process([1], [1, 0], delay=1.5), 1.0)
    >>> sampled.whole, sampled.tau, sampled.num
    (1, 0.5, array([0. , 0. , 0.5, 0.5]))
    """

    process: Process
    h: float
    plant: StateSpace
    whole: int
    tau: float

    @cached_property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Phi (n, n), Gamma_0 (n,), Gamma_1 (n,)."""
        late, newer = held(self.plant, self.h - self.tau)
        early, older = held(self.plant, self.tau)
        return late @ early, newer[:, 0], late @ older[:, 0]

    @cached_property
    def polynomials(self) -> tuple[np.ndarray, np.ndarray]:
        """(B, A) with y = B/A u, coefficients of z^0, z^-1, ...; A starts with 1, B with the zeros of the delay."""
        Phi, newer, older = self.matrices
        n = len(Phi)
        A = np.atleast_1d(np.real(np.poly(np.exp(self.process.poles * self.h))))
        D = float(self.plant.D[0, 0])
        markov = np.zeros((2, n + 1))
        for row, gamma in zip(markov, (newer, older), strict=True):
            state = gamma
            for i in range(1, n + 1):
                row[i] = self.plant.C[0] @ state
                state = Phi @ state
        markov[1 if self.tau else 0, 0] = D
        B = np.zeros(n + 2)
        B[: n + 1] += np.convolve(A, markov[0])[: n + 1]
        B[1:] += np.convolve(A, markov[1])[: n + 1]
        if not self.tau:
            B = B[: n + 1]
        return np.concatenate([np.zeros(self.whole), B]), A

    @property
    def num(self) -> np.ndarray:
        """B: the coefficients of z^0, z^-1, ..., those of the dead time first."""
        return self.polynomials[0]

    @property
    def den(self) -> np.ndarray:
        """A: the coefficients of z^0, z^-1, ...; the first is 1."""
        return self.polynomials[1]

    def response(self, u: Any) -> np.ndarray:
        """y(k) to the inputs u(k), each held for h seconds, from rest; arrays of one length.

        >>> sample(Process([1], [1, 0], delay=0.5), 1.0).response([1, 1, 1])
        array([0. , 0.5, 1.5])
        """
        from scipy.signal import lfilter

        return lfilter(self.num, self.den, np.asarray(u, dtype=float))

    def latex(self) -> str:
        """B/A in LaTeX, in powers of z^-1."""
        return rf"\frac{{{polynomial_text.in_delays(list(self.num))}}}{{{polynomial_text.in_delays(list(self.den))}}}"

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def plot(self, steps: int | None = None) -> Any:
        """The unit step response at the sampling instants as a matplotlib figure."""
        slow = float(sum(1 / abs(p.real) for p in self.process.poles if p.real))
        steps = steps or int((self.process.delay * 2 + 7 * slow) / self.h) or 40
        t = self.h * np.arange(steps + 1)
        points = {"o at the instants": (t, self.response(np.ones(steps + 1)))}
        return shown_once(curves({"output $y$": points}, f"Unit step response, sampled every {self.h:g} s"))

    def __call__(self, z: Any) -> Any:
        """The pulse transfer function at complex z."""
        B, A = self.polynomials
        inverse = 1 / np.asarray(z)
        return np.polyval(B[::-1], inverse) / np.polyval(A[::-1], inverse)


def sample(process: Process, h: float) -> SampledProcess:
    """The process behind a zero-order hold, sampled every h seconds: exact, dead time included.

    h [s] > 0. Raises ProcessError otherwise.

    >>> B, A = sample(Process([1], [35, 12, 1], delay=2), 1.0).polynomials
    >>> [round(float(c), 4) for c in A]
    [1.0, -1.6856, 0.7097]
    >>> [round(float(c), 5) for c in B]
    [0.0, 0.0, 0.0, 0.01275, 0.01138]
    """
    if not (math.isfinite(h) and h > 0):
        raise ProcessError(f"h = {h!r} s: a positive sampling interval is expected")
    ratio = process.delay / h
    whole = round(ratio) if abs(ratio - round(ratio)) < 1e-12 * max(ratio, 1) else math.floor(ratio)
    tau = max(process.delay - whole * h, 0.0)
    tau = 0.0 if tau < 1e-12 * h * max(ratio, 1) else tau
    return SampledProcess(process, h, observer_form(process.den, [process.num]), whole, tau)
