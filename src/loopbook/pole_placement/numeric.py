"""Pole placement in numbers: R and S of A R + B S = P."""

from dataclasses import dataclass

import numpy as np

from loopbook.controllers.rst import NEAR, PlacementError, Polynomial, Rst, _row, with_zeros, zeros_of
from loopbook.numerics.real_numbers import positive, whole
from loopbook.plots.short_repr import ShortRepr

CONTAINED = 1e-9


@dataclass(frozen=True, repr=False)
class Placement(ShortRepr):
    """A solved pole placement. regulator: the `Rst`. condition: of the Sylvester matrix with columns scaled to 1; the
    relative error of the coefficients is at most about condition * 1e-16. residual: largest |A R + B S - P A_o B+|
    relative to the largest coefficient of A R. cancelled: the zeros of B that were.
    """

    regulator: Rst
    condition: float
    residual: float
    cancelled: np.ndarray

    def _repr_latex_(self) -> str:
        return self.regulator._repr_latex_()


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


def place_numerically(
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
    A factor that A (1 - z^-1)^integrators and B share is cancelled where P A_o contains it: every loop keeps that pole.
    Raises PlacementError where it does not, by name; where B has no delay or is zero; where P or A_o does not start
    with 1; where P(1) or B(1) is zero; where h is not positive. A long P makes R longer, never an error.

    >>> design = place_numerically([0, 0.5], [1, -0.8], with_zeros([0.3]), h=1.0)
    >>> [float(round(c, 9)) for c in (*design.regulator.R, *design.regulator.S, *design.regulator.T)]
    [1.0, -1.0, 3.0, -1.6, 1.4]
    """
    A, B, P, observer = _row(A, "A"), _row(B, "B"), _row(P, "P"), _row(observer, "observer")
    h = positive(h, "h", PlacementError, " s")
    integrators = whole(integrators, "integrators", PlacementError)
    if A[0] == 0:
        raise PlacementError(f"A = {A.tolist()} must have a term without delay")
    A, B = A / A[0], B / A[0]
    if B[0] != 0 or not B.any():
        what = "is zero: the input does not reach the output" if not B.any() else "has a term without delay"
        raise PlacementError(f"B = {B.tolist()} {what}; a sampled process starts with z^-1 or later")
    for name, p in (("P", P), ("observer", observer)):
        if p[0] != 1:
            raise PlacementError(f"{name} = {p.tolist()} must start with 1")
    fixed = with_zeros([1.0] * integrators) if integrators else np.ones(1)
    A_fixed = np.convolve(A, fixed)
    chosen = zeros_of(B)
    cancelled = chosen[well_damped(chosen, cancel_damping)] if cancel_damping is not None else chosen[:0]
    B_plus = with_zeros(cancelled.tolist())
    B_rest = _row(_quotient(B, B_plus), "B")
    wanted = np.convolve(P, observer)
    R_short, S, condition = _sylvester(*_without_common_factor(A_fixed, B_rest, wanted, fixed))
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


def _without_common_factor(
    A: np.ndarray, B: np.ndarray, wanted: np.ndarray, fixed: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The three without the factors 1 - p z^-1 that A and B share, which `wanted` must contain."""
    zeros, own = list(zeros_of(B)), list(zeros_of(fixed))
    shared: list[complex] = []
    for pole in zeros_of(A):
        near = [zero for zero in zeros if abs(zero - pole) < NEAR * max(1.0, abs(pole))]
        if not near:
            continue
        zeros.remove(near[0])
        rest = _quotient(wanted, with_zeros(shared)) if _in_pairs(shared) else wanted
        if not _vanishes(rest, pole):
            name = "the integrator" if any(abs(pole - z) < NEAR for z in own) else "A"
            at = f"{pole.real:.6g}" if abs(pole.imag) < 1e-12 else f"{pole:.6g}"
            raise PlacementError(
                f"{name} and B share the factor 1 - ({at}) z^-1, which P does not contain: every loop keeps a pole "
                "there; put it into P, cancel it in the process first, or leave out the integrator"
            )
        shared.append(pole)
    factor = with_zeros(shared)
    return _quotient(A, factor), _quotient(B, factor), _quotient(wanted, factor)


def _in_pairs(roots: list[complex]) -> bool:
    return abs(sum(root.imag for root in roots)) < NEAR


def _vanishes(p: np.ndarray, root: complex) -> bool:
    powers = np.asarray(root, dtype=complex) ** -np.arange(len(p))
    return bool(abs((p * powers).sum()) <= CONTAINED * np.abs(p * powers).sum())


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
