"""A first-order model with dead time from two instants of a step response: 63.2 % and 28.3 % of the way.

    T = 1.5 (t1 - t2),   T0 = t1 - T                 (pid-article; derived in `derivations.experiments.two_point_fit`)

Both instants count from the step of the input.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

from derivations.experiments import two_point_fit as f
from loopbook.experiments.data import DataError, StepData

PARTS = (0.632, 0.283)
"""The parts of the way at t1 and t2, as printed; 1 - e^-1 and 1 - e^(-1/3) in three digits."""


@cache
def _formulas() -> Callable[..., Any]:
    import sympy

    rules = f.fit_283_632()
    return sympy.lambdify((f.t1, f.t2), [rules[f.T], rules[f.T0]], "math")


def fit(k: float, t1: float, t2: float) -> StepData:
    """The model from the gain k [y/u] and the instants t1 (63.2 %) and t2 (28.3 %) [s], counted from the step.

    A first-order process gives T0 = 0 up to the rounding of the instants; a dead time that comes out negative by less
    than a thousandth of t1 is taken as zero. Raises DataError where t2 is not between 0 and t1, or the response bends
    so that the dead time comes out negative: then it is faster at the start than one lag.

    >>> model = fit(3, 4.29, 2.1)
    >>> round(model.T, 3), round(model.L, 3)
    (3.285, 1.005)
    """
    if not 0 <= t2 < t1:
        raise DataError(
            f"two points: t1 = {t1!r} s (63.2 %) must come after t2 = {t2!r} s (28.3 %), both after the step"
        )
    T, T0 = _formulas()(t1, t2)
    if T0 + 1e-3 * t1 < 0:
        raise DataError(
            f"two points: the dead time comes out as {T0:.4g} s: the response is faster at first than a lag"
        )
    return StepData(k, T, max(T0, 0.0))


def equal_lags_instants(order: int, tau: float) -> tuple[float, float]:
    """The instants t1 (63.2 %) and t2 (28.3 %) [s] of ``order`` equal lags of tau [s] in a row.

    Their step response is the distribution function of Gamma with the shape ``order``; its inverse is the instant.
    Raises DataError for an order below 1 and a tau that is not positive.

    >>> [round(t, 4) for t in equal_lags_instants(2, 2.0)]
    [4.2914, 2.102]
    """
    from scipy.special import gammaincinv

    if order < 1 or not tau > 0:
        raise DataError(f"lags in a row: order = {order!r} must be at least 1, tau = {tau!r} s positive")
    t1, t2 = (tau * float(gammaincinv(order, part)) for part in PARTS)
    return t1, t2
