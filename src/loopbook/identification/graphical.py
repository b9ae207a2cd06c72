"""The documents' graphical rules on a record, each as its document defines it, beside the least-squares model.

tangent and 63 %     pid-report, section 5.2.1: `loopbook.experiments.step.estimate`
28.3 % and 63.2 %    pid-article, step-response method: T = 1.5 (t1 - t2), T0 = t1 - T
final tangent        pid-report, section 5.2.2, for integrating processes: `experiments.integrating_step.estimate`
"""

from dataclasses import dataclass, replace

import numpy as np

from loopbook.experiments import integrating_step, step, two_points
from loopbook.experiments.data import DataError
from loopbook.experiments.plant import ExperimentError, smooth
from loopbook.records.record import Record
from loopbook.records.steps import find_steps


@dataclass(frozen=True)
class GraphicalReading:
    """What one rule reads off a record.

    values: by name (Kp or Kv, T, L); empty where the rule refuses, with the reason.
    """

    rule: str
    source: str
    values: dict[str, float]
    reason: str = ""


def two_point(record: Record) -> dict[str, float]:
    """Kp, T and L from the instants at which 63.2 % and 28.3 % of the way are made, counted from the step.

    The final level is the mean of the last tenth of the record. Raises ExperimentError where the input is no single
    step or the output does not settle, DataError where the response is faster at first than a lag.
    """
    marks = step.estimate(record).marks  # refuses what has no final level
    way = (record.y - marks["before"]) / (marks["after"] - marks["before"])
    rising = np.maximum.accumulate(smooth(way, 5))
    t1, t2 = (float(np.interp(part, rising, record.time)) - marks["t0"] for part in two_points.PARTS)
    model = two_points.fit((marks["after"] - marks["before"]) / marks["du"], t1, t2)
    return {"Kp": model.Kp, "T": model.T, "L": model.L}


def first_step(record: Record) -> Record:
    """The part of a record up to its second step, with an input that rests between its steps: what a rule can read.

    Raises RecordError where there is no step.
    """
    steps = find_steps(record)
    first, *more = steps.list
    part = slice(0, int(np.searchsorted(record.time, more[0][0])) if more else None)
    time, y = record.time[part], record.y[part]
    u = float(record.u[: steps.before].mean()) + np.where(time >= first[0], first[1], 0.0)
    return replace(record, time=time, u=u, y=y)


def _falls(record: Record) -> bool:
    """Does the output move against the input?"""
    before = record.u == record.u[0]
    last = max(len(record.y) // 10, 1)
    return bool((record.y[-last:].mean() - record.y[before].mean()) * (record.u[-1] - record.u[0]) < 0)


def graphical_readings(record: Record) -> list[GraphicalReading]:
    """Every graphical rule on a record's first step, with the reason where it refuses.

    A process with a negative gain is read with the input turned round.
    """
    record = first_step(record)
    sign = -1.0 if _falls(record) else 1.0
    record = replace(record, u=sign * record.u)

    def tangent() -> dict[str, float]:
        data = step.estimate(record).data
        return {"Kp": data.Kp, "T": data.T, "L": data.L}

    def final_tangent() -> dict[str, float]:
        data = integrating_step.estimate(record).data
        return {"Kv": data.Kv, "L": data.L}

    rules = (
        ("tangent and 63 %", "pid-report, section 5.2.1", tangent),
        ("28.3 % and 63.2 %", "pid-article, step-response method", lambda: two_point(record)),
        ("final tangent", "pid-report, section 5.2.2", final_tangent),
    )
    found = []
    for rule, source, read in rules:
        try:
            values = {name: sign * v if name in ("Kp", "Kv") else v for name, v in read().items()}
            found.append(GraphicalReading(rule, source, values))
        except (ExperimentError, DataError) as error:
            found.append(GraphicalReading(rule, source, {}, error.reason))
    return found
