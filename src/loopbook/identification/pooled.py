"""Several records of one process: one model for all, one record held back to try it on, and whether they agree.

    minimise sum over records r of |P_r (y_r - K g_r(T, L))|^2 / sigma_r^2

P_r takes each record's own rest (and drift) away, sigma_r is its noise, so that a quiet record counts for more. Each
record is fitted alone as well; the parameters then differ from the common ones by

    Q = sum over r of (p_r - p)' C_r^-1 (p_r - p)

which for records of one process is chi-square distributed with (records - 1) times as many degrees as parameters.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from loopbook.identification import intervals
from loopbook.identification.choice import Identified, identify
from loopbook.identification.fit import Fit, Parameter
from loopbook.identification.least_squares import CONFIDENCE, FitProblem
from loopbook.identification.models import Structure
from loopbook.records.record import Record, RecordError

UNLIKELY = 0.001  # probability of so large a Q where the records are of one process
SLACK = 0.02  # of a parameter: what no two records of a real process agree on better than
AS_GOOD = 3.0  # percent: the common model may explain so much less of the held-back record than its own


class PooledProblem:
    """One structure on several records: residuals for given shape and dead time, each record's rest eliminated."""

    def __init__(self, found: Sequence[Identified], structure: Structure, fixed: Mapping[str, float]):
        self.structure = structure
        self.parts = [FitProblem(f.record, structure, f.steps, _nuisance(f), fixed) for f in found]
        self.weights = [1 / max(f.chosen.rmse, 1e-9 * float(np.ptp(f.record.y)), 1e-300) for f in found]
        self.gain = self.parts[0].gain

    def kept(self, part: FitProblem, lags: tuple[float, ...], delay: float) -> tuple[np.ndarray, np.ndarray]:
        """(y, response), what the record's own rest, drift and further inputs could make taken away."""
        answer = self.structure.response(part.time, part.steps.list, lags, delay)
        q = np.linalg.qr(part.columns(lags, delay))[0]
        return part.y - q @ (q.T @ part.y), answer - q @ (q.T @ answer)

    def eliminated(self, lags: tuple[float, ...], delay: float) -> tuple[np.ndarray, float]:
        """(weighted residuals of all records, the gain)."""
        kept = [self.kept(part, lags, delay) for part in self.parts]
        y = np.concatenate([w * one[0] for w, one in zip(self.weights, kept, strict=True)])
        answer = np.concatenate([w * one[1] for w, one in zip(self.weights, kept, strict=True)])
        gain = self.gain if self.gain is not None else float(answer @ y) / max(float(answer @ answer), 1e-300)
        return y - gain * answer, gain

    def solve(self, starts: Sequence[Fit]) -> tuple[tuple[float, ...], float]:
        """Shape and dead time, searched from what each record alone says."""
        from scipy.optimize import least_squares

        first, s = self.parts[0], self.structure
        length = max(part.length for part in self.parts)
        tick = min(part.record.sampling for part in self.parts)
        low = np.array([*[np.log(tick / 20)] * (s.lags > 0), *s.low, 0.0])
        high = np.array([*[np.log(30 * length)] * (s.lags > 0), *s.high, 0.9 * length])
        found = []
        for fit in starts:
            begin = np.clip(first.theta(fit.lags, fit.delay), low + 1e-9, high - 1e-9)
            solved = least_squares(
                lambda theta: self.eliminated(first.lags(theta), float(theta[-1]))[0], begin, bounds=(low, high)
            )
            found.append((solved.cost, tuple(solved.x)))
        best = np.array(min(found)[1])
        return first.lags(best), float(best[-1])

    def covariance(self, values: np.ndarray) -> tuple[np.ndarray, float]:
        """Of (gain, shape, dead time) and the degrees of freedom, from the linearised problem."""
        tick = min(part.record.sampling for part in self.parts)
        floors = [1e-12, *[0.1 if name == "zeta" else tick for name in (*self.structure.names, "L")]]
        moves = np.maximum(np.abs(values), floors) * 1e-4
        moves[-1] = max(moves[-1], tick)

        def answers(p: np.ndarray) -> np.ndarray:
            lags, delay = tuple(p[1:-1]), float(p[-1])
            kept = [w * self.kept(part, lags, delay)[1] for w, part in zip(self.weights, self.parts, strict=True)]
            return p[0] * np.concatenate(kept)

        jacobian = np.column_stack(
            [(answers(values + e) - answers(values - e)) / (2 * e.sum()) for e in np.diag(moves)]
        )
        residuals = self.eliminated(tuple(values[1:-1]), float(values[-1]))[0]
        return intervals.covariance(jacobian, residuals, residuals)


def _nuisance(found: Identified) -> str:
    return found.chosen.nuisance if found.chosen.nuisance != "start" else "rest"


def identify_together(
    records: Sequence[Record], fixed: Mapping[str, float] | None = None, hold: bool = True
) -> Identified:
    """One model of several records of one process, tried on the last one, which is held back.

    The structure is the one that most records ask for, the richer where they are divided. Two records are pooled
    without one being held back, and hold = False pools all. The result stands on the first record, its reasons say what
    the others brought: whether they agree, and how the held-back one is explained.
    Raises RecordError where a record gives no model by itself, named.
    """
    if len(records) < 2:
        raise RecordError("records to be pooled are two at least")
    found = [_alone(record, fixed) for record in records]
    pool, held = (found[:-1], found[-1]) if hold and len(found) > 2 else (found, None)
    structure = _structure(pool)
    singles = [f.fits[structure] for f in pool if structure in f.fits]
    if len(singles) < len(pool):
        raise RecordError(
            f"the records ask for different structures ({', '.join(sorted({f.chosen.structure.name for f in pool}))}) "
            "and have none in common: they are not of one process, or of different working points"
        )
    problem = PooledProblem(pool, structure, dict(fixed or {}))
    lags, delay = problem.solve(singles)
    gain = problem.eliminated(lags, delay)[1]
    values = np.array([gain, *lags, delay])
    covariance, freedom = problem.covariance(values)
    common = _fit(problem, pool[0], values, covariance, freedom)
    words = [*_agreement(pool, singles, values), *([_validation(held, structure, values)] if held else [])]
    names = ", ".join(f.record.source or f"record {i + 1}" for i, f in enumerate(pool))
    reasons = (f"One model of {len(pool)} records together ({names}): {common.structure.name}.", *words)
    warnings = tuple(text for text in words if "do not agree" in text or "worse than" in text)
    return replace(
        pool[0], fits={structure: common}, criteria={structure: 0.0}, chosen=common, reasons=reasons,
        warnings=(*warnings, *[w for w in pool[0].warnings if "gain is uncertain" not in w]), directions=None,
    )  # fmt: skip


def _alone(record: Record, fixed: Mapping[str, float] | None) -> Identified:
    try:
        return identify(record, fixed)
    except RecordError as error:
        raise RecordError(f"{record.source or 'a record'}: {error}") from None


def _structure(found: Sequence[Identified]) -> Structure:
    chosen = [f.chosen.structure for f in found]
    return max(chosen, key=lambda s: (chosen.count(s), s.lags))


def _fit(problem: PooledProblem, first: Identified, values: np.ndarray, covariance: np.ndarray, freedom: float) -> Fit:
    """The common model as a fit of the first record."""
    from scipy.special import stdtrit

    part = problem.parts[0]
    lags, delay = tuple(values[1:-1].tolist()), float(values[-1])
    widths = float(stdtrit(freedom, 0.5 + CONFIDENCE / 2)) * np.sqrt(np.maximum(np.diag(covariance), 0))
    names = ("Kv" if problem.structure.integrating else "Kp", *problem.structure.names, "L")
    parameters = tuple(Parameter(n, float(v), float(w)) for n, v, w in zip(names, values, widths, strict=True))
    answer = problem.structure.response(part.time, part.steps.list, lags, delay)
    columns = part.columns(lags, delay)
    beside = np.linalg.lstsq(columns, part.y - values[0] * answer, rcond=None)[0]
    residuals = part.y - values[0] * answer - columns @ beside
    return part.fitted(
        parameters,
        residuals,
        np.append(beside, values[0]),
        settled=first.chosen.settled,
        covariance=covariance,
        answer=float(np.ptp(values[0] * answer)),
    )


def _agreement(found: Sequence[Identified], singles: Sequence[Fit], values: np.ndarray) -> list[str]:
    """A word on whether the records are of one process."""
    from scipy.stats import chi2

    size = np.abs(values) * SLACK
    size[-1] = max(size[-1], max(f.record.sampling for f in found) / 2)
    off = [np.array([p.value for p in fit.parameters]) - values for fit in singles]
    spreads = [fit.covariance + np.diag(size**2) for fit in singles]
    Q = sum(float(d @ np.linalg.pinv(C) @ d) for d, C in zip(off, spreads, strict=True))
    degrees = (len(singles) - 1) * len(values)
    chance = float(chi2.sf(Q, degrees))
    if chance > UNLIKELY:
        return [
            f"The records agree: their own models differ as noise makes them differ (Q = {Q:.1f}, {degrees} degrees)."
        ]
    far = np.array([np.abs(d) / np.sqrt(np.diag(C)) for d, C in zip(off, spreads, strict=True)])
    name = singles[0].parameters[int(far.max(axis=0).argmax())].name
    told = [
        f"{f.record.source or f'record {i + 1}'} {fit.parameter(name).value:.3g} ± {fit.parameter(name).half_width:.2g}"
        for i, (f, fit) in enumerate(zip(found, singles, strict=True))
    ]
    return [
        f"The records do not agree (Q = {Q:.0f}, {degrees} degrees): {name} is {', '.join(told)}. Were they made at "
        "different working points? Then design for each and schedule the gain."
    ]


def _validation(held: Identified, structure: Structure, values: np.ndarray) -> str:
    """How the common model explains the record that was held back, beside the model made for it."""
    problem = FitProblem(held.record, structure, held.steps, _nuisance(held), {})
    lags, delay = tuple(values[1:-1].tolist()), float(values[-1])
    answer = values[0] * structure.response(problem.time, held.steps.list, lags, delay)
    columns = problem.columns(lags, delay)
    left = problem.y - answer
    left = left - columns @ np.linalg.lstsq(columns, left, rcond=None)[0]
    explained, own = problem.explained(left), held.chosen.fit
    name = held.record.source or "the last record"
    verdict = "as well as" if own - explained <= AS_GOOD else "worse than"
    return (
        f"{name} was held back: the common model explains {explained:.1f} % of it, {verdict} a model made for it "
        f"({own:.1f} %)."
    )
