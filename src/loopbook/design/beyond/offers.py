"""What a study offers beyond its PID, and what it looked at: read from the records, compared with the best PID."""

from pathlib import Path
from typing import Any

import numpy as np

from loopbook.design.beyond.cascade import cascade_offer
from loopbook.design.beyond.measured_disturbance import feedforward_offers
from loopbook.design.beyond.offer import Offer
from loopbook.design.beyond.scheduling import NAME as SCHEDULING
from loopbook.design.beyond.scheduling import schedule_offer
from loopbook.design.beyond.smith import smith_offer
from loopbook.design.model import Model, from_identified
from loopbook.design.words import as_plain_text
from loopbook.identification.choice import identify
from loopbook.loop.transfer import LoopError
from loopbook.records.reading import read_record
from loopbook.records.record import RecordError
from notebook_reports.display import Table, number


def offers(study: Any) -> list[Offer]:
    """The predictor always; a feedforward for each further input that moves; a cascade where an inner measurement is
    named; a schedule where records of other operating points are.
    """
    Ms, loops, found = study.recommendation.aim.Ms, study.evaluations, study.identified
    looked = [smith_offer(study.model, loops, Ms), *feedforward_offers(found, study.model, loops, Ms)]
    if study.inner and found is not None:
        record = read_record(study.data, study.time, study.input, study.inner, study.interval)
        inner = np.interp(found.record.time, record.time, record.y)
        looked.append(cascade_offer(found, inner, study.inner, loops, Ms))
    if study.points and found is not None:
        looked.append(_scheduled(study, Ms))
    return looked


def _scheduled(study: Any, Ms: float) -> Offer:
    points: list[tuple[float, Model]] = [(study.rest[1], study.model)]
    for name in (part.strip() for part in study.points.split(";") if part.strip()):
        path = Path(study.data).parent / name
        try:
            found = identify(read_record(path, study.time, study.input, study.output, study.interval))
        except RecordError as error:
            return Offer(SCHEDULING, refused=f"{name}: {error}")
        points.append((found.chosen.rest, from_identified(found)))
    try:
        return schedule_offer(points, Ms)
    except LoopError as error:
        return Offer(SCHEDULING, refused=str(error))


def beyond_table(study: Any) -> Table:
    """What was looked at, what is offered, with the number."""
    rows, marks = [], []
    for offer in study.beyond:
        entered = ", ".join(f"{as_plain_text(name)} = {number(value, 4)}" for name, value in offer.numbers)
        verdict = offer.verdict[0].upper() + offer.verdict[1:]
        says = " ".join(as_plain_text(text) for text in (f"{verdict}.", *(offer.says if offer.offered else ())))
        rows.append([as_plain_text(offer.what), says, entered if offer.offered else ""])
        marks.append("good" if offer.offered else "")
    heads = ["structure", "beside the best PID", "to enter"]
    return Table(heads, rows, "Beyond one PID", ["left", "left", "left"], (), marks)
