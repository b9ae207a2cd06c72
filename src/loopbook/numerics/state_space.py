"""State space with one denominator for several inputs: what an exact simulation runs on.

The realisation is the observer form, which shares the poles between the inputs (an integrator stands once), followed
by a diagonal scaling that balances rows and columns.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loopbook.numerics.units import characteristic_time, in_units, octaves, power_of_two


@dataclass(frozen=True)
class StateSpace:
    """x' = A x + B w, y = C x + D w with several inputs w and one output. Shapes (n, n), (n, k), (1, n), (1, k)."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray


def balancing(matrix: np.ndarray) -> np.ndarray:
    """Powers of 2, shape (n,), with which M * scale / scale[:, None] has rows and columns of similar size.

    Entries below 1e-40 of the largest count as zero: to balance them would scale everything else out of range.
    """
    from scipy.linalg.lapack import dgebal

    size = np.abs(matrix).max(initial=0.0)
    kept = np.where(np.abs(matrix) > 1e-40 * size, matrix, 0.0)
    scale: np.ndarray = dgebal(kept, scale=1, permute=0)[3]
    return scale


def _as_if_no_integrator(a: np.ndarray) -> np.ndarray:
    """The denominator with its poles at zero moved to where its slowest other pole lies: what tells how to scale them.

    An integrator's own row is zero, which balances with anything.
    """
    if a[-1]:
        return a
    slowest = 2.0 ** min(octaves(a.tolist()), default=0.0)
    last = int(np.flatnonzero(a)[-1])
    return np.append(a[: last + 1], a[last] * slowest ** np.arange(1, len(a) - last))


def observer_form(den: Sequence[float], nums: Sequence[Sequence[float]], span: float = 0.0) -> StateSpace:
    """The outputs of several proper transfer functions nums[j]/den added up, with n = degree of den states.

    den, nums: descending coefficients; each num at most as long as den. span [s]: what happens in so short a time is to
    be exact in each number: no state is taken slower than that. Raises ValueError for an improper function.
    """
    n = len(den) - 1
    if any(len(num) > n + 1 for num in nums):
        raise ValueError("an improper transfer function has no state space")
    time = characteristic_time((1.0,), den, span)
    a = np.array(in_units(den, time))
    rows = np.array([(0.0,) * (n + 1 - len(num)) + in_units(num, time) for num in nums]) / a[0]
    a = a / a[0]
    D = rows[:, :1].T
    B = (rows[:, 1:] - rows[:, :1] * a[1:]).T
    A = np.eye(n, k=1)
    A[:, :1] -= a[1:, None] if n else 0.0
    C = np.eye(1, n)
    if n:
        loop = A
        if not a[-1]:
            loop = A.copy()
            loop[:, 0] = -_as_if_no_integrator(a)[1:]
        scale = balancing(loop)
        if span:
            steps = np.maximum(scale[1:] / scale[:-1], power_of_two(time / span))
            scale = scale[0] * np.cumprod(np.append(1.0, steps))
        A, B, C = A * scale / scale[:, None], B / scale[:, None], C * scale
    return StateSpace(A / time, B / time, C, D)
