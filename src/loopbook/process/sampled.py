"""Sampling a process exactly: zero-order hold on the input, any dead time, whole samples or a fraction.

With the dead time L = (l + fraction) h, 0 <= fraction < 1, and x' = A x + B v of the rational part,

    x(k+1) = Phi x(k) + Gamma_0 u(k-l) + Gamma_1 u(k-l-1)

    Phi = exp(A h),   Gamma_0 = int_0^(h - tau) exp(A s) ds B,   Gamma_1 = exp(A (h - tau)) int_0^tau exp(A s) ds B

with tau = fraction h: inside one sampling interval first the older input acts, for tau seconds, then the newer one.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.numerics import polynomial_text
from loopbook.numerics.fixed_point import FixedPoint
from loopbook.numerics.real_numbers import real, real_array
from loopbook.numerics.state_space import StateSpace, observer_form
from loopbook.numerics.units import power_of_two
from loopbook.plots.curves import curves
from loopbook.plots.shown import shown_once
from loopbook.process.transfer_function import Process, ProcessError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LARGEST = 300.0
LOST = 1e5
MANY, FAST = 4, 4.0  # so few lags cancel only where one of them dies out within a few intervals
PLACES = 64
LEAST = 745.0  # exp(-LEAST) is the least number above zero


def held(plant: StateSpace, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """exp(A d) and int_0^d exp(A s) ds B for a constant input over `duration` d [s]."""
    from scipy.linalg import expm

    n, k = plant.B.shape
    unit = power_of_two(float(np.abs(plant.B).max(initial=0.0)) * duration)
    block = np.zeros((n + k, n + k))
    block[:n, :n], block[:n, n:] = plant.A * duration, plant.B / unit * duration
    result = expm(block)
    return result[:n, :n], result[:n, n:] * unit


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

    def __repr__(self) -> str:
        return f"SampledProcess({self.process!r}, h={self.h!r})"

    @cached_property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Phi (n, n), Gamma_0 (n,), Gamma_1 (n,)."""
        late, newer = held(self.plant, self.h - self.tau)
        if not self.tau:
            return late, newer[:, 0], np.zeros(len(late))
        early, older = held(self.plant, self.tau)
        return late @ early, newer[:, 0], late @ older[:, 0]

    @cached_property
    def polynomials(self) -> tuple[np.ndarray, np.ndarray]:
        """(B, A) with y = B/A u, coefficients of z^0, z^-1, ...; A starts with 1, B with the zeros of the delay."""
        B, A = self._rounded if self.exact is None else self.exact[:2]
        return np.concatenate([np.zeros(self.whole), B]), A

    @cached_property
    def _rounded(self) -> tuple[np.ndarray, np.ndarray]:
        A = np.atleast_1d(np.real(np.poly(np.exp(self.process.poles * self.h))))
        return _numerator(A, self._markov)[: len(A) + bool(self.tau)], A

    @cached_property
    def exact(self) -> "tuple[np.ndarray, np.ndarray, np.ndarray] | None":
        """`exact_polynomials`, where B's coefficients would cancel nearly all digits of what they are made of."""
        fastest = float(abs(self.process.poles).max(initial=0.0)) * self.h
        if self.process.order < 2 or (self.process.order < MANY and fastest < FAST):
            return None
        B, A = self._rounded
        added = _numerator(abs(A), abs(self._markov))[: len(B)]
        cancel = (abs(B) * LOST < added).any()
        return exact_polynomials(self.process, self.h, self.tau) if cancel else None

    @cached_property
    def _markov(self) -> np.ndarray:
        """What the newer and the older input do to the output after 0, 1, ... intervals, without whole dead times."""
        Phi, newer, older = self.matrices
        rows = np.zeros((2, len(Phi) + 1))
        for row, state in zip(rows, (newer, older), strict=True):
            for i in range(1, len(row)):
                row[i] = self.plant.C[0] @ state
                state = Phi @ state
        rows[1 if self.tau else 0, 0] = self.plant.D[0, 0]
        return rows

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

        return lfilter(self.num, self.den, real_array(u, "u", ProcessError))

    def latex(self) -> str:
        """B/A in LaTeX, in powers of z^-1."""
        return rf"\frac{{{polynomial_text.in_delays(list(self.num))}}}{{{polynomial_text.in_delays(list(self.den))}}}"

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def plot(self, steps: int | None = None) -> "Figure":
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


def _numerator(A: np.ndarray, markov: np.ndarray) -> np.ndarray:
    n = len(A) - 1
    B = np.zeros(n + 2)
    B[: n + 1] += np.convolve(A, markov[0])[: n + 1]
    B[1:] += np.convolve(A, markov[1])[: n + 1]
    return B


def exact_polynomials(process: Process, h: float, tau: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(B, A) as `SampledProcess.polynomials`, without whole samples of dead time, and z^(n + 1) B in powers of z - 1
    from (z - 1)^(n + 1) down, all correctly rounded.

    In fixed-point numbers with so many places that nothing is lost where the coefficients of many lags, sampled fast,
    cancel nearly all of each other. tau: the fraction of a sample [s] that the dead time has.
    """
    n, step, pace = process.order, Fraction(h), _pace(process, h)
    a = [Fraction(c) / Fraction(process.den[0]) for c in process.den]
    b = [Fraction(c) / Fraction(process.den[0]) for c in (*(0.0,) * (n + 1 - len(process.num)), *process.num)]
    rows = [[Fraction(0)] * (n + 1) for _ in range(n + 1)]
    for i in range(n):  # in units of h, x_i in units of pace^i: x_i' = x_(i+1) - a_i x_1 + (b_i - b_0 a_i) u
        rows[i][0] = -a[i + 1] * step ** (i + 1) / pace**i
        if i + 1 < n:
            rows[i][i + 1] += pace
        rows[i][n] = (b[i + 1] - b[0] * a[i + 1]) * step ** (i + 1) / pace**i
    input_size = max(abs(row[n]) for row in rows)
    scaled = [[*row[:n], row[n] / input_size if input_size else row[n]] for row in rows]
    decay = min(float(abs(process.poles.real).sum()) * h, LEAST)
    numbers = FixedPoint(PLACES * (n + 2) + math.ceil(1.5 * decay) + 4 * n * pace.bit_length())
    share = Fraction(tau) / step
    late, early = (
        numbers.exponential(numbers.matrix([[x * s for x in row] for row in scaled])) for s in (1 - share, share)
    )
    Phi = numbers.product(late[:n, :n], early[:n, :n])
    newer, older = late[:n, n], numbers.product(late[:n, :n], early[:n, n])
    A = numbers.characteristic(Phi)
    markov = np.zeros((2, n + 1), dtype=object)
    for row, state in zip(markov, (newer, older), strict=True):
        for i in range(1, n + 1):
            row[i] = int(state[0])
            state = numbers.product(Phi, state)
    at_once = b[0] / input_size if input_size else b[0]
    markov[1 if tau else 0, 0] = round(at_once * 2**numbers.bits)
    B = [0] * (n + 2)
    for shift, row in enumerate(markov):
        for i in range(n + 1):
            for j in range(n + 1 - i):
                B[i + j + shift] += A[i] * row[j]
    powers = [sum(B[i] * math.comb(n + 1 - i, k) for i in range(n + 2 - k)) for k in range(n + 1, -1, -1)]
    numerator, near_one = (
        np.array([float(Fraction(x, 4**numbers.bits) * (input_size or 1)) for x in row]) for row in (B, powers)
    )
    return numerator if tau else numerator[: n + 1], numbers.floats(np.array(A, dtype=object)), near_one


def _pace(process: Process, h: float) -> int:
    """A power of two not below the fastest pole's |p h|: in such steps the states are of one size."""
    return 2 ** max(0, math.ceil(math.log2(max(abs(process.poles) * h, default=1.0) or 1.0)))


def sample(process: Process, h: float) -> SampledProcess:
    """The process behind a zero-order hold, sampled every h seconds: exact, dead time included.

    h [s] > 0. Raises ProcessError otherwise, and where an unstable process outgrows all numbers within one interval.

    >>> B, A = sample(Process([1], [35, 12, 1], delay=2), 1.0).polynomials
    >>> [round(float(c), 4) for c in A]
    [1.0, -1.6856, 0.7097]
    >>> [round(float(c), 5) for c in B]
    [0.0, 0.0, 0.0, 0.01275, 0.01138]
    """
    h = real(h, "h", ProcessError, " s")
    if h <= 0:
        raise ProcessError(f"h = {h!r} s: a positive sampling interval is expected")
    growth = h * float(process.poles.real.max(initial=0.0))
    if growth > LARGEST:
        raise ProcessError(
            f"h = {h:g} s: between two samples the process grows by exp({growth:.4g}), more than a number can hold; "
            f"its fastest unstable pole is {growth / h:.4g} 1/s: sample faster"
        )
    ratio = process.delay / h
    whole = round(ratio) if abs(ratio - round(ratio)) < 1e-12 * max(ratio, 1) else math.floor(ratio)
    tau = max(process.delay - whole * h, 0.0)
    tau = 0.0 if tau < 1e-12 * h * max(ratio, 1) else tau
    return SampledProcess(process, h, observer_form(process.den, [process.num], h), whole, tau)
