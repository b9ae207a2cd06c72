"""Least squares on the exact dead-time response, with intervals that admit what the residuals show.

    minimise sum_k ( y(t_k) - y0 - d t_k - K g(t_k; T, L) - ... )^2

y0 (rest), d (drift, only where the record before the step shows one), what is left of a start off rest, the effect of
further inputs and K enter linearly and are eliminated; the time constants and the dead time are searched from the best
points of a grid, so that the non-convex dead time cannot trap the search. Any of K, T1, T2, L may be fixed beforehand.
"""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.identification import intervals
from loopbook.identification.fit import Fit, Parameter
from loopbook.identification.models import RINGS, STRUCTURES, Structure
from loopbook.identification.normal_equations import linear
from loopbook.records.record import Record
from loopbook.records.steps import Steps, drifts, find_steps

CONFIDENCE = 0.95
NO_DELAY = 0.5  # of a sampling interval: a shorter dead time is none
ALIKE = 0.9  # ratio of two lags from which on the response hardly tells which is which
NUISANCES = ("rest", "drift", "start")


class FitProblem:
    """One structure on one record: residuals for given lags and dead time, the rest eliminated."""

    def __init__(self, record: Record, structure: Structure, steps: Steps, nuisance: str, fixed: Mapping[str, float]):
        self.record, self.structure, self.steps, self.nuisance, self.fixed = record, structure, steps, nuisance, fixed
        self.used = record.used
        self.time, self.y = record.time[self.used], record.y[self.used]
        self.length = float(record.time[-1] - steps.list[0][0])
        self.gain = fixed.get("Kv" if structure.integrating else "Kp", fixed.get("K"))
        self.others = {o.name: changes for o in record.others if (changes := _changes(record.time, o.values))}

    def columns(self, lags: tuple[float, ...], delay: float) -> np.ndarray:
        """What is eliminated beside the gain: rest, drift or start, further inputs; shape (n, m)."""
        found = [np.ones(len(self.time))]
        if self.nuisance == "drift":
            found.append(self.time)
        elif self.nuisance == "start":
            found += [np.exp(-(self.time - self.time[0]) / T) for T in lags or (self.length,)]
        found += [self.structure.response(self.time, steps, lags, delay) for steps in self.others.values()]
        return np.column_stack(found)

    def eliminated(self, lags: tuple[float, ...], delay: float) -> tuple[np.ndarray, np.ndarray]:
        """(residuals, coefficients), the gain being the last coefficient."""
        answer = self.structure.response(self.time, self.steps.list, lags, delay)
        columns = self.columns(lags, delay)
        if self.gain is not None:
            target = self.y - self.gain * answer
            coefficients = linear(columns, target)
            return target - columns @ coefficients, np.append(coefficients, self.gain)
        basis = np.column_stack([columns, answer])
        coefficients = linear(basis, self.y)
        return self.y - basis @ coefficients, coefficients

    def explained(self, residuals: np.ndarray) -> float:
        """100 (1 - |residual| / |y - mean|), in percent."""
        whole = float(np.linalg.norm(self.y - self.y.mean()))
        return 100 * (1 - float(np.linalg.norm(residuals)) / max(whole, 1e-300))

    def fitted(
        self, parameters: tuple[Parameter, ...], residuals: np.ndarray, coefficients: np.ndarray, **more: Any
    ) -> Fit:
        """The fit that these parameters are. coefficients: those of `eliminated`. more: what else a `Fit` holds."""
        whole = np.zeros(len(self.record.time))
        whole[self.used] = residuals
        effects = dict(zip(self.others, coefficients[-1 - len(self.others) : -1].tolist(), strict=True))
        return Fit(
            self.structure,
            parameters,
            rest=float(coefficients[0]),
            drift=float(coefficients[1]) if self.nuisance == "drift" else 0.0,
            residuals=whole,
            fit=self.explained(residuals),
            rmse=float(np.sqrt(np.mean(residuals**2))),
            correlation=intervals.correlation(residuals),
            nuisance=self.nuisance,
            effects=effects,
            **more,
        )

    def lags(self, theta: np.ndarray) -> tuple[float, ...]:
        """Time constants from the search variables: log T, then the ratio T2/T1 in (0, 1]."""
        if self.structure.lags == 0:
            return ()
        found = self.structure.numbers(float(np.exp(theta[0])), theta[1:-1])
        return (found[0], min(self.fixed["T2"], found[0])) if "T2" in self.fixed and len(found) == 2 else found

    def theta(self, lags: tuple[float, ...], delay: float) -> np.ndarray:
        """The search variables of lags and dead time, the inverse of `lags`."""
        others = lags[1:] if self.structure.parts == RINGS else tuple(T / lags[0] for T in lags[1:])
        return np.array([*([np.log(lags[0])] if lags else []), *others, delay])

    def pinned(self) -> dict[int, float]:
        """Search variables that are fixed, by their place."""
        T = self.fixed.get("T", self.fixed.get("T1"))
        found = {0: float(np.log(T))} if T and self.structure.lags else {}
        if "T2" in self.fixed and self.structure.lags == 2:
            found[1] = 0.5
        if "L" in self.fixed:
            found[self.structure.lags] = self.fixed["L"]
        return found

    def starts(self) -> np.ndarray:
        """A grid of search starts: dead times from none to half the record, lags from one sample to three records."""
        sampling = self.record.sampling
        delays = np.concatenate([[0.0], np.geomspace(min(sampling, 0.4 * self.length), 0.5 * self.length, 11)])
        logs = np.log(np.geomspace(max(sampling, self.length / 500), 3 * self.length, 12))
        axes = [*([logs] if self.structure.lags else []), *map(np.array, self.structure.axes), delays]
        pinned = self.pinned()
        grids = [np.array([pinned[i]]) if i in pinned else axis for i, axis in enumerate(axes)]
        return np.array(np.meshgrid(*grids, indexing="ij")).reshape(len(grids), -1).T

    def rough_cost(self, theta: np.ndarray) -> float:
        """The sum of squares with the rest (and a drift) alone beside the gain: enough to compare starts.

        Further inputs are not small beside it: with these nothing is left out.
        """
        if self.others:
            return float(np.sum(self.eliminated(self.lags(theta), float(theta[-1]))[0] ** 2))
        answer = self.structure.response(self.time, self.steps.list, self.lags(theta), float(theta[-1]))
        answer = answer - self._beside @ (self._beside.T @ answer)
        if self.gain is not None:
            return float(np.sum((self._resting - self.gain * answer) ** 2))
        size = float(answer @ answer)
        return float(self._resting @ self._resting) - (float(self._resting @ answer) ** 2 / size if size > 0 else 0.0)

    @cached_property
    def _beside(self) -> np.ndarray:
        columns = [np.ones(len(self.time)), *([self.time] if self.nuisance == "drift" else [])]
        return np.linalg.qr(np.column_stack(columns))[0]

    @cached_property
    def _resting(self) -> np.ndarray:
        return self.y - self._beside @ (self._beside.T @ self.y)

    def solve(self) -> tuple[tuple[float, ...], float]:
        """(lags, dead time) of the least squares."""
        from scipy.optimize import least_squares

        scale = float(np.std(self.y)) or 1.0
        starts, pinned = self.starts(), self.pinned()
        free = [i for i in range(starts.shape[1]) if i not in pinned]

        def residuals(theta: np.ndarray) -> np.ndarray:
            return self.eliminated(self.lags(theta), float(theta[-1]))[0] / scale

        def moved(part: np.ndarray, start: np.ndarray) -> np.ndarray:
            whole = start.copy()
            whole[free] = part
            return residuals(whole)

        if not free:
            return self.lags(starts[0]), float(starts[0][-1])
        costs = np.array([self.rough_cost(theta) for theta in starts])
        lags, s = self.structure.lags > 0, self.structure
        lower = np.array([*[np.log(self.record.sampling / 20)] * lags, *s.low, 0.0])[free]
        upper = np.array([*[np.log(30 * self.length)] * lags, *s.high, 0.9 * self.length])[free]
        found = []
        for i in _apart(costs, starts):
            start = starts[i]
            inside = np.clip(start[free], lower + 1e-9, upper - 1e-9)
            solved = least_squares(moved, inside, bounds=(lower, upper), args=(start,))
            found.append((solved.cost, i, solved.x))
        _, i, part = min(found, key=lambda f: f[0])
        theta = starts[i].copy()
        theta[free] = part
        return self.lags(theta), float(theta[-1])


def _apart(costs: np.ndarray, starts: np.ndarray) -> list[int]:
    """The three best starts that are not neighbours in all their variables."""
    chosen: list[int] = []
    for i in np.argsort(costs, kind="stable")[:12].tolist():
        if all(np.sum(~np.isclose(starts[i], starts[j])) > 1 for j in chosen) or starts.shape[1] == 1:
            chosen.append(i)
        if len(chosen) == 3:
            break
    return chosen


def _changes(time: np.ndarray, values: np.ndarray) -> list[tuple[float, float]]:
    """Every change of a further input as a step."""
    moves = np.flatnonzero(np.diff(values) != 0)
    return [(float(time[k + 1]), float(values[k + 1] - values[k])) for k in moves]


def fit_structure(
    record: Record,
    structure: Structure,
    steps: Steps | None = None,
    nuisance: str | None = None,
    fixed: Mapping[str, float] | None = None,
) -> Fit:
    """Fit one structure to a record; see the module for the problem that is solved.

    nuisance: of `NUISANCES`, None has it chosen (drift where the record before the first step shows one). fixed: values
    by name (K, T or T1, T2, L) that are not fitted. A dead time below half a sampling interval is none. Intervals are
    those of the linearised problem, see `intervals`: a model that leaves structure in its residuals, or a quantised
    signal, gets wider ones.
    """
    steps = steps or find_steps(record)
    nuisance = nuisance or ("drift" if drifts(record, steps) else "rest")
    fixed = dict(fixed or {})
    problem = FitProblem(record, structure, steps, nuisance, fixed)
    lags, delay = problem.solve()
    if 0 < delay < NO_DELAY * record.sampling and "L" not in fixed:
        problem = FitProblem(record, structure, steps, nuisance, {**fixed, "L": 0.0})
        lags, delay = problem.solve()
    return described(problem, lags, delay, fixed)


def described(problem: FitProblem, lags: tuple[float, ...], delay: float, fixed: Mapping[str, float]) -> Fit:
    """Everything that is said of a fit, from its optimum."""
    from scipy.special import stdtrit

    record, structure, steps = problem.record, problem.structure, problem.steps
    residuals, coefficients = problem.eliminated(lags, delay)
    gain = float(coefficients[-1])
    values = np.array([gain, *lags, delay])
    names = ["Kv" if structure.integrating else "Kp", *structure.names, "L"]

    def predicted(p: np.ndarray) -> np.ndarray:
        return p[0] * structure.response(problem.time, steps.list, tuple(p[1:-1]), p[-1])

    floors = [1e-12, *[0.1 if name == "zeta" else record.sampling for name in names[1:]]]
    moves = np.maximum(np.abs(values), floors) * 1e-4
    moves[-1] = max(moves[-1], record.sampling)  # the response bends at the dead time: look across a whole sample
    jacobian = np.column_stack(
        [(predicted(values + e) - predicted(values - e)) / (2 * e.sum()) for e in np.diag(moves)]
    )
    known = [i for i, name in enumerate(names) if {name, *_SAME.get(name, ())} & set(fixed)]
    free = [i for i in range(len(values)) if i not in known]
    twins = (
        [1, 2] if structure.common and len(lags) == 2 and lags[1] > ALIKE * lags[0] and not {1, 2} & set(known) else []
    )
    if twins:  # two lags that are one in the response: they move together, and one of them stands for both
        jacobian[:, 1] += jacobian[:, 2]
        free.remove(2)
    found, freedom = intervals.covariance(
        np.column_stack([jacobian[:, free], problem.columns(lags, delay)]), residuals, problem.y
    )
    covariance = np.zeros((len(values), len(values)))
    covariance[np.ix_(free, free)] = found[: len(free), : len(free)]
    if twins:
        covariance[2, :] = covariance[1, :]
        covariance[:, 2] = covariance[:, 1]
    spread = np.sqrt(np.maximum(np.diag(covariance), 0))
    quantile = float(stdtrit(freedom, 0.5 + CONFIDENCE / 2))  # of Student's distribution
    parameters = tuple(
        Parameter(*row) for row in zip(names, values.tolist(), (quantile * spread).tolist(), strict=True)
    )
    after = record.time[-1] - steps.list[-1][0] - delay
    return problem.fitted(
        parameters,
        residuals,
        coefficients,
        settled=float("inf") if structure.integrating else float(after / structure.span(lags)),
        covariance=covariance,
        answer=float(np.ptp(predicted(values))),
    )


_SAME = {"Kp": ("K",), "Kv": ("K",), "T": ("T1",), "T1": ("T",)}


def fit_all(
    record: Record, steps: Steps | None = None, nuisance: str | None = None, fixed: Mapping[str, float] | None = None
) -> tuple[Steps, dict[Structure, Fit]]:
    """Every structure fitted to one record; with parameters fixed, those that have them."""
    steps = steps or find_steps(record)
    chosen = [s for s in STRUCTURES if _has(s, fixed or {})]
    return steps, {structure: fit_structure(record, structure, steps, nuisance, fixed) for structure in chosen}


def _has(structure: Structure, fixed: Mapping[str, float]) -> bool:
    """Has the structure the parameters that are fixed?"""
    lags = set(structure.names) | ({"T1"} if structure.integrating else set())
    wanted = {name for name in fixed if name.startswith("T")}
    gain = {"K", "Kv"} if structure.integrating else {"K", "Kp"}
    return wanted <= lags and {name for name in fixed if name.startswith("K")} <= gain
