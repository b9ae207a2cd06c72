"""Pole placement with numbers: the RST regulator R u = T r - S y of a sampled process, and its quality.

The numeric twin of `derivations.pole_placement`, for processes of any order whose coefficients are measured numbers.
All polynomials are in z^-1, coefficients ascending: [1, a1, a2] is 1 + a1 z^-1 + a2 z^-2.

    y = B/A u        A D R' + B' S = P A_o        R = R' D B+,   T = t0 A_o,   t0 = P(1)/B'(1)

P wanted poles, A_o observer polynomial (poles that a reference does not excite), D = (1 - z^-1)^integrators, B = B+ B'
with B+ the zeros to be cancelled. Then y = t0 B'/P r.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

Polynomial = Sequence[float] | np.ndarray
NEAR = 1e-8


class PlacementError(ValueError):
    """The polynomial equation has no solution or no meaning; the message names the factor or the polynomial."""


def _row(p: Polynomial, name: str) -> np.ndarray:
    row = np.atleast_1d(np.asarray(p, dtype=float))
    if row.ndim != 1 or not row.size or not np.isfinite(row).all():
        raise PlacementError(f"{name} = {p!r}: finite coefficients of z^0, z^-1, z^-2, ... are expected")
    last = np.flatnonzero(row)
    return row[: last[-1] + 1] if last.size else row[:1]


def zeros_of(p: Polynomial) -> np.ndarray:
    """The z where p0 + p1 z^-1 + ... = 0, without the z at infinity of leading zeros (delays)."""
    return np.roots(np.trim_zeros(np.asarray(p, dtype=float), "f")).astype(complex)


def with_zeros(zeros: Sequence[complex]) -> np.ndarray:
    """The polynomial (1 - z1 z^-1)(1 - z2 z^-1)... with real coefficients.

    >>> with_zeros([0.5, 0.5])
    array([ 1.  , -1.  ,  0.25])
    """
    return np.atleast_1d(np.real(np.poly(np.asarray(zeros, dtype=complex))))


@dataclass(frozen=True)
class Rst:
    """R u = T r - S y; coefficients of z^0, z^-1, ...; R starts with 1 (it is scaled to). h: sampling interval [s].

    observer: A_o of the anti-windup form (see `derivations.rst_law`); (1,) sets v from the inputs alone.
    """

    R: tuple[float, ...]
    S: tuple[float, ...]
    T: tuple[float, ...]
    h: float
    observer: tuple[float, ...] = (1.0,)

    def __post_init__(self):
        lead = _row(self.R, "R")[0]
        if lead == 0:
            raise PlacementError(f"R = {self.R} has no term without delay: u(k) would not appear in its own equation")
        for name in ("R", "S", "T"):
            object.__setattr__(self, name, tuple((_row(getattr(self, name), name) / lead).tolist()))
        observer = _row(self.observer, "observer")
        if observer[0] != 1:
            raise PlacementError(f"observer = {self.observer} must start with 1")
        if (abs(zeros_of(observer)) >= 1).any():
            raise PlacementError(f"observer = {self.observer} is not stable: the anti-windup form would not be either")
        object.__setattr__(self, "observer", tuple(observer.tolist()))

    @cached_property
    def poles(self) -> np.ndarray:
        """The regulator's own poles, zeros of R. One outside the unit circle: unstable by itself."""
        return zeros_of(self.R)

    @property
    def is_stable(self) -> bool:
        """No pole outside the unit circle, and on it at most the simple pole of one integrator at z = 1."""
        outside = self.poles[abs(self.poles) > 1 - NEAR]
        return len(outside) <= 1 and bool((abs(outside - 1) < 1e-6).all())

    def feedback(self, z):
        """S/R at complex z."""
        inverse = 1 / np.asarray(z)
        return np.polyval(self.S[::-1], inverse) / np.polyval(self.R[::-1], inverse)

    def controller(self, low: float = -np.inf, high: float = np.inf) -> "RstController":
        """A controller that runs it, with the output limited to [low, high] and no windup."""
        return RstController(self, low, high)


class RstController:
    """An `Rst` that runs: u = controller.step(y, reference), once per sampling instant.

    Built from `derivations.rst_law.law`. In saturation the limited output is what the recursion remembers.
    """

    def __init__(self, regulator: Rst, low: float = -np.inf, high: float = np.inf):
        from derivations.rst_law import law
        from loopbook.recursion import recursion

        if not low < high:
            raise ValueError(f"limits [{low}, {high}]: the lower one must be below the upper one")
        self.regulator, self.low, self.high = regulator, low, high
        rows = {"r": regulator.R, "s": regulator.S, "t": regulator.T, "o": regulator.observer}
        values = {f"{letter}_{i}": c for letter, row in rows.items() for i, c in enumerate(row)}
        self._terms = recursion(law(*(len(row) - 1 for row in rows.values())), values).terms
        self.reset()

    def reset(self) -> None:
        """Forget everything: all signals were zero."""
        longest = 1 + max((delay for _, delay, _ in self._terms), default=0)
        self._past = {name: deque([0.0] * longest, maxlen=longest) for name in ("r", "u", "v", "y")}

    def step(self, y: float, reference: float) -> float:
        """u(k) from y(k) and r(k)."""
        past = self._past
        past["y"].appendleft(float(y))
        past["r"].appendleft(float(reference))
        # u(k) and v(k) are not known yet: their newest stored sample is that of k - 1
        v = sum(gain * past[name][delay if name in "ry" else delay - 1] for name, delay, gain in self._terms)
        u = min(max(v, self.low), self.high)
        past["v"].appendleft(v)
        past["u"].appendleft(u)
        return u


@dataclass(frozen=True)
class Placement:
    """A solved pole placement. regulator: the `Rst`. condition: of the Sylvester matrix with columns scaled to 1; the
    relative error of the coefficients is at most about condition * 1e-16. residual: largest |A R + B S - P A_o B+|
    relative to the largest coefficient of A R. cancelled: the zeros of B that were.
    """

    regulator: Rst
    condition: float
    residual: float
    cancelled: np.ndarray


def well_damped(zeros: np.ndarray, damping: float) -> np.ndarray:
    """Which z = exp(s h) inside the unit circle have a damping ratio of s of at least `damping`.

    zeta = -cos(arg ln z); 1 on the positive real axis, small near the circle and for negative real z, whose
    cancellation makes u ring.

    >>> well_damped(np.array([0.5, -0.9, 1.2]), 0.3)
    array([ True, False, False])
    """
    zeros = np.asarray(zeros, dtype=complex)
    with np.errstate(divide="ignore"):
        s = np.log(zeros)
    zeta = np.where(zeros == 0, 1.0, -np.cos(np.angle(s)))
    return (abs(zeros) < 1) & (zeta >= damping)


def place(
    B: Polynomial,
    A: Polynomial,
    P: Polynomial,
    h: float,
    *,
    observer: Polynomial = (1.0,),
    integrators: int = 1,
    cancel_damping: float | None = None,
) -> Placement:
    """The regulator of least order that gives the loop the poles of P and A_o.

    B, A: sampled process (`sampling.sample(...).polynomials`), B with its delays as leading zeros. P, observer: wanted
    polynomials starting with 1 (`with_zeros`). h [s]. integrators: how many the regulator has. cancel_damping: cancel
    the zeros of B at least so well damped (see `well_damped`); None cancels none.
    Raises PlacementError where A (1 - z^-1)^integrators and B share a factor, by name; where B has no delay or is zero;
    where P or A_o does not start with 1; where P(1) or B(1) is zero. A long P makes R longer, never an error.

    >>> design = place([0, 0.5], [1, -0.8], with_zeros([0.3]), h=1.0)
    >>> [float(round(c, 9)) for c in (*design.regulator.R, *design.regulator.S, *design.regulator.T)]
    [1.0, -1.0, 3.0, -1.6, 1.4]
    """
    A, B, P, observer = _row(A, "A"), _row(B, "B"), _row(P, "P"), _row(observer, "observer")
    if A[0] == 0:
        raise PlacementError(f"A = {A.tolist()} must have a term without delay")
    A, B = A / A[0], B / A[0]
    if B[0] != 0 or not B.any():
        what = "is zero: the input does not reach the output" if not B.any() else "has a term without delay"
        raise PlacementError(f"B = {B.tolist()} {what}; a sampled process starts with z^-1 or later")
    for name, p in (("P", P), ("observer", observer)):
        if p[0] != 1:
            raise PlacementError(f"{name} = {p.tolist()} must start with 1")
    fixed = with_zeros(np.ones(integrators)) if integrators else np.ones(1)
    A_fixed = np.convolve(A, fixed)
    _refuse_common_factor(A, fixed, B)
    chosen = zeros_of(B)
    cancelled = chosen[well_damped(chosen, cancel_damping)] if cancel_damping is not None else chosen[:0]
    B_plus = with_zeros(cancelled)
    B_rest = _row(_quotient(B, B_plus), "B")
    wanted = np.convolve(P, observer)
    R_short, S, condition = _sylvester(A_fixed, B_rest, wanted)
    if abs(B_rest.sum()) <= NEAR * abs(B_rest).sum() or P.sum() == 0:
        raise PlacementError("P(1)/B(1) gives no static gain: P has a pole at z = 1 or B a zero there")
    gain = P.sum() / B_rest.sum()
    R = np.convolve(np.convolve(R_short, fixed), B_plus)
    regulator = Rst(tuple(R), tuple(S), tuple(gain * observer), h, tuple(observer))
    total = _added(np.convolve(A, R), np.convolve(B, S))
    left = _added(total, -np.convolve(wanted, B_plus))
    return Placement(regulator, condition, float(abs(left).max() / abs(np.convolve(A, R)).max()), cancelled)


def _added(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    total = np.zeros(max(len(p), len(q)))
    total[: len(p)] += p
    total[: len(q)] += q
    return total


def _quotient(p: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """p/factor, exact division in z^-1."""
    if len(factor) == 1:
        return p
    delays = int(np.flatnonzero(p)[0])
    quotient, _ = np.polydiv(p[delays:], factor)
    return np.concatenate([np.zeros(delays), np.atleast_1d(quotient)])


def _refuse_common_factor(A: np.ndarray, fixed: np.ndarray, B: np.ndarray) -> None:
    zeros = zeros_of(B)
    for name, p in (("the integrator", fixed), ("A", A)):
        for pole in zeros_of(p):
            close = abs(zeros - pole) < NEAR * max(1.0, abs(pole)) if zeros.size else np.zeros(0, bool)
            if close.any():
                at = f"{pole.real:.6g}" if abs(pole.imag) < 1e-12 else f"{pole:.6g}"
                raise PlacementError(
                    f"{name} and B share the factor 1 - ({at}) z^-1: every loop keeps a pole there, and it cannot be "
                    "placed; cancel it in the process first, or leave out the integrator"
                )


def _sylvester(A: np.ndarray, B: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """R (starting with 1) and S with A R + B S = wanted, and the condition number."""
    n_s = len(A) - 2
    n_r = max(len(B) - 2, len(wanted) - len(A))
    size = n_r + n_s + 1
    matrix = np.zeros((size, size))
    for j in range(n_r):
        matrix[j : j + len(A), j] = A[: size - j]  # row i: the coefficient of z^-(i+1)
    for j in range(n_s + 1):
        column = np.zeros(size + 1)
        column[j : j + len(B)] = B[: size + 1 - j]
        matrix[:, n_r + j] = column[1:]
    right = _added(wanted, -A)
    right = np.pad(right, (0, max(size + 1 - len(right), 0)))[1 : size + 1]
    if not size:
        return np.ones(1), np.zeros(1), 1.0
    scale = np.linalg.norm(matrix, axis=0)
    scaled = matrix / scale
    solution = np.linalg.solve(scaled, right)
    solution += np.linalg.solve(scaled, right - scaled @ solution)
    solution /= scale
    return np.append(1.0, solution[:n_r]), np.append(solution[n_r:], [0.0] * (n_s < 0)), float(np.linalg.cond(scaled))
