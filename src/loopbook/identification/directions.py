"""A process that is faster one way than the other: heating and cooling, filling and draining.

One lag with dead time whose time constant is T_up while the output rises and T_down while it falls. Between two changes
of the (delayed) input the output moves one way only, so each piece is an exponential and the response is exact.
"""

from dataclasses import dataclass

import numpy as np

from loopbook.identification import intervals
from loopbook.identification.fit import Fit, Parameter
from loopbook.identification.least_squares import FitProblem
from loopbook.identification.models import FIRST_ORDER
from loopbook.identification.normal_equations import linear
from loopbook.records.record import Record
from loopbook.records.steps import Steps

CLEARLY_DIFFERENT = 1.25  # ratio of the time constants below which they are one
SMALL = 0.2  # of the highest step: smaller ones do not count as a direction


@dataclass(frozen=True)
class Directions:
    """up, down: the same gain and dead time with the time constant of each direction of the output."""

    up: Fit
    down: Fit

    @property
    def worse(self) -> Fit:
        """The direction that is harder to hold stable: the faster one has the higher gain at high frequencies."""
        return min((self.up, self.down), key=lambda fit: fit.lags[0])

    @property
    def milder(self) -> Fit:
        return self.down if self.worse is self.up else self.up


def response(
    time: np.ndarray, steps: list[tuple[float, float]], T_up: float, T_down: float, delay: float, sign: float
) -> np.ndarray:
    """Response of gain 1 from rest at the times, shape (n,); sign: of the gain, which says what rising is.

    >>> import numpy as np
    >>> response(np.array([0.0, 1.0, 2.0]), [(0.0, 1.0)], 1.0, 9.0, 1.0, 1.0).round(3).tolist()
    [0.0, 0.0, 0.632]
    """
    instants = np.array([instant + delay for instant, _ in steps])
    targets = np.cumsum([height for _, height in steps])
    states, constants, x = [], [], 0.0
    for i, target in enumerate(targets):
        states.append(x)
        T = T_up if sign * (target - x) > 0 else T_down
        constants.append(T)
        if i + 1 < len(instants):
            x = target + (x - target) * np.exp(-(instants[i + 1] - instants[i]) / T)
    at = np.searchsorted(instants, time, side="right") - 1
    last = np.maximum(at, 0)
    decay = np.exp(-np.maximum(time - instants[last], 0) / np.array(constants)[last])
    return np.where(at < 0, 0.0, targets[last] + (np.array(states)[last] - targets[last]) * decay)


def fit_directions(record: Record, steps: Steps, symmetric: Fit) -> tuple[Directions, int] | None:
    """Both directions fitted together, and how many parameters that took; None where the input goes one way only.

    symmetric: the first-order fit to start from.
    """
    from scipy.optimize import least_squares
    from scipy.special import stdtrit

    heights = np.array([height for _, height in steps.list])
    large = heights[np.abs(heights) > SMALL * np.abs(heights).max()]
    if steps.course or not ((large > 0).any() and (large < 0).any()):
        return None
    problem = FitProblem(record, FIRST_ORDER, steps, symmetric.nuisance, {})
    sign = 1.0 if symmetric.gain > 0 else -1.0
    T, L, scale = symmetric.lags[0], symmetric.delay, float(np.std(problem.y)) or 1.0

    def basis(theta: np.ndarray) -> np.ndarray:
        T_up, T_down, delay = np.exp(theta[0]), np.exp(theta[1]), theta[2]
        answer = response(problem.time, steps.list, T_up, T_down, delay, sign)
        return np.column_stack([problem.columns((np.sqrt(T_up * T_down),), delay), answer])

    def residuals(theta: np.ndarray) -> np.ndarray:
        columns = basis(theta)
        return (problem.y - columns @ linear(columns, problem.y)) / scale

    bounds = ([np.log(record.sampling / 20)] * 2 + [0.0], [np.log(30 * problem.length)] * 2 + [0.9 * problem.length])
    starts = [np.array([np.log(T * a), np.log(T / a), L]) for a in (0.6, 1.7)]
    clipped = [np.clip(s, np.array(bounds[0]) + 1e-9, np.array(bounds[1]) - 1e-9) for s in starts]
    best = min((least_squares(residuals, s, bounds=bounds) for s in clipped), key=lambda found: found.cost)
    columns = basis(best.x)
    coefficients = np.linalg.lstsq(columns, problem.y, rcond=None)[0]
    left = problem.y - columns @ coefficients
    gain, (T_up, T_down), delay = float(coefficients[-1]), np.exp(best.x[:2]).tolist(), float(best.x[2])
    if gain * sign <= 0:
        return None

    def predicted(p: np.ndarray) -> np.ndarray:
        return p[0] * response(problem.time, steps.list, p[1], p[2], p[3], sign)

    values = np.array([gain, T_up, T_down, delay])
    moves = np.maximum(np.abs(values), [1e-12, *[record.sampling] * 3]) * 1e-4
    moves[-1] = max(moves[-1], record.sampling)
    jacobian = [(predicted(values + e) - predicted(values - e)) / (2 * e.sum()) for e in np.diag(moves)]
    covariance, freedom = intervals.covariance(np.column_stack([*jacobian, columns[:, :-1]]), left, problem.y)
    widths = float(stdtrit(freedom, 0.975)) * np.sqrt(np.maximum(np.diag(covariance)[:4], 0))

    def one(which: int) -> Fit:
        keep = [0, which, 3]
        names = ("Kp", "T", "L")
        parameters = tuple(Parameter(n, float(values[i]), float(widths[i])) for n, i in zip(names, keep, strict=True))
        return problem.fitted(
            parameters,
            left,
            coefficients,
            settled=float((record.time[-1] - steps.list[-1][0] - delay) / values[which]),
            covariance=covariance[np.ix_(keep, keep)],
            answer=float(np.ptp(predicted(values))),
        )

    return Directions(one(1), one(2)), 4 + columns.shape[1]
