"""A process identified while its regulator was at work, from set-point steps: prediction error with a noise model.

    minimise sum_k ( A(q) (y(t_k) - y0 - K g(t_k; T, L)) )^2,   A(q) = 1 + a1 q^-1 + ... + ap q^-p

In closed loop the input holds the noise of the past, so that least squares on the response alone are biased by whatever
of the noise is not white. A, an autoregression of what the model leaves, makes the prediction errors white, and with
that the estimate is consistent with the regulator in the loop; A and the model are found in turn.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from loopbook.identification import intervals
from loopbook.identification.fit import Fit
from loopbook.identification.least_squares import FitProblem, described
from loopbook.identification.models import STRUCTURES, Structure
from loopbook.records.record import Record, RecordError
from loopbook.records.steps import Steps, noise_level

LONGEST = 8  # lags of the noise model
TURNS = 3
FOLLOWS = 0.9  # of the input's own news explained by set-point and measurement
CONTINUAL = 0.3  # of the samples: an input that changes less often is stepped by hand
LEAST_STEP = 4.0  # of the noise: a smaller change of the set-point does not move the loop
UNEVEN = 0.2  # of the sampling interval


def recognised(record: Record) -> bool:
    """Is the input made from set-point and measurement, sample by sample?

    What the input's own past does not say of its next change is explained by set-point and measurement together.
    """
    if record.setpoint is None or len(record.u) < 40:
        return False
    u, y, r = record.u, record.y, record.setpoint
    change = np.diff(u)
    if np.mean(change != 0) < CONTINUAL:
        return False
    k = np.arange(3, len(u))
    past = np.column_stack([np.ones(len(k)), *[change[k - 1 - i] for i in (1, 2)]])
    both = np.column_stack([past, *[x[k - i] for x in (y, r) for i in range(4)]])
    news, left = (_spread(change[k - 1], columns) for columns in (past, both))
    return news > 1e-6 * float(np.ptp(u)) and left**2 <= (1 - FOLLOWS) * news**2


def _spread(target: np.ndarray, columns: np.ndarray) -> float:
    """Root mean square of what the columns leave, the few largest (limits, hand) set aside."""
    left = target - columns @ np.linalg.lstsq(columns, target, rcond=None)[0]
    kept = np.abs(left) <= np.quantile(np.abs(left), 0.97)
    left = target[kept] - columns[kept] @ np.linalg.lstsq(columns[kept], target[kept], rcond=None)[0]
    return float(np.sqrt(np.mean(left**2)))


def closed_steps(record: Record) -> tuple[Steps, int]:
    """The input as it was, from before the first set-point step, and how many set-point steps there are.

    Raises RecordError where the set-point does not move, or by less than the noise: then only load moves the loop, and
    the input shows the regulator, not the process.
    """
    setpoint = record.setpoint
    assert setpoint is not None, "asked for of records with a set-point"
    noise = noise_level(record.y)
    moves = np.flatnonzero(np.abs(np.diff(setpoint)) > 0)
    if not len(moves) or float(np.ptp(setpoint)) < LEAST_STEP * noise:
        raise RecordError(
            "the record was made in closed loop and its set-point stands still: only load moves it, and the input "
            "shows the regulator and not the process; step the set-point, or put the regulator in manual and step the "
            "input"
        )
    if np.ptp(np.diff(record.time)) > UNEVEN * record.sampling:
        raise RecordError(
            "the record was made in closed loop and its samples are not evenly spaced, which its noise model needs; "
            "log at a fixed interval, or put the regulator in manual and step the input"
        )
    changes = np.flatnonzero(np.diff(record.u) != 0)
    listed = [(float(record.time[k + 1]), float(record.u[k + 1] - record.u[k])) for k in changes]
    apart = 1 + int(np.sum(np.diff(moves) > 3))
    before = max(int(moves[0]) + 1, 1)
    notes = [] if before >= 5 else [f"Only {before} samples before the first step: the loop was taken to be at rest."]
    return Steps(listed, before, noise, tuple(notes), True), apart


class _Filtered:
    """A structure whose response goes through A(q)."""

    def __init__(self, structure: Structure, a: np.ndarray):
        self._structure, self._a = structure, a

    def __getattr__(self, name: str) -> Any:
        return getattr(self._structure, name)

    def response(self, *where: Any) -> np.ndarray:
        return whitened(self._structure.response(*where), self._a)


def whitened(values: np.ndarray, a: np.ndarray) -> np.ndarray:
    """A(q) of samples, shape (n,) or (n, m); the first p, which need a past, are left out."""
    p, n = len(a) - 1, len(values)
    return sum((a[i] * values[p - i : n - i] for i in range(p + 1)), np.zeros_like(values[p:]))


class PredictionError(FitProblem):
    """A `FitProblem` whose residuals are prediction errors. a: of the noise model, shape (p + 1,), a[0] = 1."""

    def __init__(
        self,
        record: Record,
        structure: Structure,
        steps: Steps,
        nuisance: str,
        fixed: Mapping[str, float],
        a: np.ndarray,
    ):
        super().__init__(record, structure, steps, nuisance, fixed)
        self.plain, self.a = FitProblem(record, structure, steps, nuisance, fixed), a
        self.y = whitened(self.y, a)
        self.structure = _Filtered(structure, a)  # type: ignore[assignment]
        self.begin: np.ndarray | None = None

    def columns(self, lags: tuple[float, ...], delay: float) -> np.ndarray:
        return whitened(self.plain.columns(lags, delay), self.a)

    def starts(self) -> np.ndarray:
        return super().starts() if self.begin is None else self.begin[None, :]

    def rough_cost(self, theta: np.ndarray) -> float:
        return float(np.sum(self.eliminated(self.lags(theta), float(theta[-1]))[0] ** 2))

    def fitted(self, parameters: Any, residuals: np.ndarray, coefficients: np.ndarray, **more: Any) -> Fit:
        """The fit, its residuals those of the response, its rms that of the prediction error."""
        lags, delay = tuple(p.value for p in parameters[1:-1]), parameters[-1].value
        answer = self.plain.structure.response(self.plain.time, self.steps.list, lags, delay)
        basis = np.column_stack([self.plain.columns(lags, delay), answer])
        plain = self.plain.fitted(parameters, self.plain.y - basis @ coefficients, coefficients, **more)
        rms, settled = float(np.sqrt(np.mean(residuals**2))), plain.settled
        if self.record.setpoint is not None and not self.plain.structure.integrating:
            last = self.record.time[np.flatnonzero(np.diff(self.record.setpoint))[-1] + 1]
            settled = float((self.record.time[-1] - last - delay) / self.plain.structure.span(lags))
        return replace(plain, rmse=rms, correlation=intervals.correlation(residuals), settled=settled)


def noise_model(residuals: np.ndarray) -> np.ndarray:
    """A(q) of what a model leaves: the order by the Bayesian criterion, the coefficients by least squares."""
    n = len(residuals)
    centred = residuals - residuals.mean()
    best, found = np.inf, np.ones(1)
    for p in range(min(LONGEST, n // 10) + 1):
        target = centred[LONGEST:]
        past = (
            np.column_stack([centred[LONGEST - i : n - i] for i in range(1, p + 1)])
            if p
            else np.zeros((len(target), 0))
        )
        phi = np.linalg.lstsq(past, target, rcond=None)[0] if p else np.zeros(0)
        variance = float(np.mean((target - past @ phi) ** 2))
        value = len(target) * np.log(max(variance, 1e-300)) + p * np.log(len(target))
        if value < best:
            best, found = value, np.concatenate([[1.0], -phi])
    return found


def fit_closed(record: Record, structure: Structure, steps: Steps, fixed: Mapping[str, float] | None = None) -> Fit:
    """One structure on a closed-loop record, model and noise model in turn."""
    fixed = dict(fixed or {})
    a, begin = np.ones(1), None
    for _turn in range(TURNS):
        problem = PredictionError(record, structure, steps, "rest", fixed, a)
        problem.begin = begin
        lags, delay = problem.solve()
        begin = problem.theta(lags, delay)
        coefficients = problem.eliminated(lags, delay)[1]
        answer = structure.response(problem.plain.time, steps.list, lags, delay)
        left = problem.plain.y - np.column_stack([problem.plain.columns(lags, delay), answer]) @ coefficients
        last, a = a, noise_model(left)
        if len(last) == len(a) and np.abs(last - a).max() < 0.01:
            break
    return described(problem, lags, delay, fixed)


def fit_all_closed(record: Record, steps: Steps, fixed: Mapping[str, float] | None = None) -> dict[Structure, Fit]:
    """Every structure of lags on a closed-loop record."""
    return {structure: fit_closed(record, structure, steps, fixed) for structure in STRUCTURES}
