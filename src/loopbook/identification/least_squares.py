"""Least squares on the exact dead-time response, with intervals that admit what the residuals show.

    minimise sum_k ( y(t_k) - y0 - d t_k - K g(t_k; T, L) )^2

y0 (rest), d (drift, only where the record before the step shows one) and K enter linearly and are eliminated; the time
constants and the dead time are searched from the best points of a grid, so that the non-convex dead time cannot trap
the search.
"""

from dataclasses import dataclass

import numpy as np

from loopbook.identification import intervals
from loopbook.identification.models import STRUCTURES, Structure
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.records.record import Record
from loopbook.records.steps import Steps, find_steps

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Parameter:
    """An estimate with its half-width of the 95 % interval, in the parameter's unit."""

    name: str
    value: float
    half_width: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.value - self.half_width, self.value + self.half_width


@dataclass(frozen=True)
class Fit(ShownAsTable):
    """One fitted model.

    parameters: gain first (Kp or Kv), then time constants, then dead time L. residuals: shape (n,). fit: percentage
    100 (1 - |residual| / |y - mean|). rmse: root mean square residual. correlation: of neighbouring residuals.
    settled: how many time constants were recorded after the last step (infinite for integrating models).
    covariance: of (gain, lags, L).
    """

    structure: Structure
    parameters: tuple[Parameter, ...]
    rest: float
    drift: float
    residuals: np.ndarray
    fit: float
    rmse: float
    correlation: float
    settled: float
    covariance: np.ndarray

    @property
    def gain(self) -> float:
        return self.parameters[0].value

    @property
    def lags(self) -> tuple[float, ...]:
        return tuple(p.value for p in self.parameters[1:-1])

    @property
    def delay(self) -> float:
        return self.parameters[-1].value

    @property
    def process(self):
        """The model as a Process."""
        return self.structure.process(self.gain, self.lags, self.delay)

    def table(self) -> PlainTable:
        """The parameters with the half-widths of their 95 % intervals."""
        rows = [[p.name, p.value, p.half_width] for p in self.parameters]
        return PlainTable(["parameter", "value", "+- (95 %)"], rows)

    def __str__(self) -> str:
        said = f"explains {self.fit:.1f} % of the response (rms residual {self.rmse:.3g})"
        return f"{self.structure.name}, {said}\n{self.table()}"

    def parameter(self, name: str) -> Parameter:
        return next(p for p in self.parameters if p.name == name)


def _basis(record: Record, columns: np.ndarray, structure: Structure, steps: Steps, lags, delay) -> np.ndarray:
    return np.column_stack([columns, structure.response(record.time, steps.list, lags, delay)])


def _projected(y: np.ndarray, basis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Residuals and coefficients after the linear parameters are eliminated."""
    coefficients, *_ = np.linalg.lstsq(basis, y, rcond=None)
    return y - basis @ coefficients, coefficients


def _lags(structure: Structure, theta: np.ndarray) -> tuple[float, ...]:
    """Time constants from the search variables: log T, then the ratio T2/T1 in (0, 1]."""
    if structure.lags == 0:
        return ()
    first = float(np.exp(theta[0]))
    return (first,) if structure.lags == 1 else (first, first * float(theta[1]))


def _starts(structure: Structure, length: float, sampling: float) -> np.ndarray:
    """A grid of search starts: dead times from none to half the record, lags from one sample to three records."""
    delays = np.concatenate([[0.0], np.geomspace(sampling, 0.5 * length, 11)])
    logs = np.log(np.geomspace(max(sampling, length / 500), 3 * length, 12))
    ratios = (0.15, 0.6)
    grids = {0: [delays], 1: [logs, delays], 2: [logs, ratios, delays]}[structure.lags]
    return np.array(np.meshgrid(*grids, indexing="ij")).reshape(len(grids), -1).T


def fit_structure(record: Record, structure: Structure, steps: Steps | None = None) -> Fit:
    """Fit one structure to a record; see the module for the problem that is solved.

    Intervals are those of the linearised problem, see `intervals`: a model that leaves structure in its residuals, or a
    quantised signal, gets wider ones.
    """
    from scipy.optimize import least_squares

    steps = steps or find_steps(record)
    length = float(record.time[-1] - steps.list[0][0])
    columns = np.ones((len(record.time), 1))
    if _drifts(record, steps):
        columns = np.column_stack([columns, record.time])
    scale = float(np.std(record.y)) or 1.0

    def residuals(theta: np.ndarray) -> np.ndarray:
        basis = _basis(record, columns, structure, steps, _lags(structure, theta), theta[-1])
        return _projected(record.y, basis)[0] / scale

    starts = _starts(structure, length, record.sampling)
    costs = np.array([np.sum(residuals(theta) ** 2) for theta in starts])
    lower = [np.log(record.sampling / 20), 1e-3][: structure.lags] + [0.0]
    upper = [np.log(30 * length), 1.0][: structure.lags] + [0.9 * length]
    found = [
        least_squares(
            residuals, np.clip(starts[i], np.array(lower) + 1e-9, np.array(upper) - 1e-9), bounds=(lower, upper)
        )
        for i in np.argsort(costs, kind="stable")[:4]
    ]
    best = min(found, key=lambda result: result.cost)
    return _described(record, steps, structure, columns, _lags(structure, best.x), float(best.x[-1]))


def _drifts(record: Record, steps: Steps) -> bool:
    """Does the output drift before the first step, beyond three standard errors of the slope?"""
    n = steps.before
    if n < 10:
        return False
    t, y = record.time[:n] - record.time[:n].mean(), record.y[:n]
    slope = float(t @ (y - y.mean()) / (t @ t))
    sigma = max(float(np.std(y - y.mean() - slope * t)) * np.sqrt(n / (n - 2)), steps.noise)
    return abs(slope) > 4 * sigma / np.sqrt(t @ t) and abs(slope) * np.ptp(record.time) > 0.02 * np.ptp(record.y)


def _described(record, steps, structure, columns, lags, delay) -> Fit:
    """Everything that is said of a fit, from its optimum."""
    from scipy.special import stdtrit

    basis = _basis(record, columns, structure, steps, lags, delay)
    residuals, coefficients = _projected(record.y, basis)
    gain = float(coefficients[-1])
    values = np.array([gain, *lags, delay])

    def predicted(p: np.ndarray) -> np.ndarray:
        return p[0] * structure.response(record.time, steps.list, tuple(p[1:-1]), p[-1])

    moves = np.maximum(np.abs(values), [1e-12, *[record.sampling] * (len(values) - 1)]) * 1e-4
    moves[-1] = max(moves[-1], record.sampling)  # the response bends at the dead time: look across a whole sample
    jacobian = [(predicted(values + e) - predicted(values - e)) / (2 * e.sum()) for e in np.diag(moves)]
    jacobian = np.column_stack([*jacobian, columns])
    covariance, freedom = intervals.covariance(jacobian, residuals, record.y)
    spread = np.sqrt(np.maximum(np.diag(covariance)[: len(values)], 0))
    quantile = float(stdtrit(freedom, 0.5 + CONFIDENCE / 2))  # of Student's distribution
    names = ["Kv" if structure.integrating else "Kp", *(["T"] if len(lags) == 1 else ["T1", "T2"][: len(lags)]), "L"]
    parameters = tuple(
        Parameter(*row) for row in zip(names, values.tolist(), (quantile * spread).tolist(), strict=True)
    )
    after = record.time[-1] - steps.list[-1][0] - delay
    return Fit(
        structure,
        parameters,
        rest=float(coefficients[0]),
        drift=float(coefficients[1]) if columns.shape[1] > 1 else 0.0,
        residuals=residuals,
        fit=100 * (1 - float(np.linalg.norm(residuals) / max(np.linalg.norm(record.y - record.y.mean()), 1e-300))),
        rmse=float(np.sqrt(np.mean(residuals**2))),
        correlation=intervals.correlation(residuals),
        settled=float("inf") if structure.integrating else float(after / sum(lags)),
        covariance=covariance[: len(values), : len(values)],
    )


def fit_all(record: Record) -> tuple[Steps, dict[Structure, Fit]]:
    """Every structure fitted to one record."""
    steps = find_steps(record)
    return steps, {structure: fit_structure(record, structure, steps) for structure in STRUCTURES}
