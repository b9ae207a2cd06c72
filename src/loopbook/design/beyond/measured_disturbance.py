"""Feedforward from a disturbance that was recorded: its path to the output is identified beside the process.

y = P u + W w,    F = -W/P, or what can be built that is nearest to it
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from loopbook.design.beyond.offer import Offer, best_pid, integrated_error, vanished
from loopbook.design.evaluation import Evaluation
from loopbook.design.model import Model, from_fit
from loopbook.identification.choice import Identified, identify
from loopbook.loop.continuous import Loop
from loopbook.loop.feedforward import FeedforwardLoop, feedforward
from loopbook.loop.transfer import LoopError
from loopbook.records.record import Other, Record, RecordError

FILTER = 0.1  # of the process's lags: the lags of a feedforward that would differentiate


def disturbance_path(found: Identified, other: Other) -> Identified:
    """W from the disturbance to the output: identified on what the process's model leaves of the record.

    Raises RecordError where the record does not show it.
    """
    record, fit = found.record, found.chosen
    answer = fit.gain * fit.structure.response(record.time, found.steps.list, fit.lags, fit.delay)
    left = Record(record.time, other.values, record.y - answer, other.name, record.output_name,
                  source=record.source, left_out=record.left_out)  # fmt: skip
    return identify(left)


def feedforward_offers(found: Identified | None, model: Model, loops: list[Evaluation], Ms: float) -> list[Offer]:
    """One for each further input that moves in the record."""
    if found is None:
        return []
    return [_offer(found, other, model, loops, Ms) for other in found.record.others]


def _offer(found: Identified, other: Other, model: Model, loops: list[Evaluation], Ms: float) -> Offer:
    name = f"feedforward from {other.name}"
    pid = best_pid(loops, Ms)
    if pid is None:
        return Offer(name, refused=f"no PID keeps Ms = {Ms:g} to compare with")
    try:
        W = from_fit(disturbance_path(found, other).chosen, found.record.source or "the record")
    except RecordError as error:
        return Offer(name, refused=f"its way to the output is not seen: {error}")
    return compared(name, model, W, pid)


def compared(name: str, model: Model, W: Model, pid: Evaluation) -> Offer:
    """The PID with and without the feedforward, after a unit step of the disturbance."""
    P = model.process
    try:
        F = feedforward(P, W.process, FILTER * (sum(model.lags) or model.delay or 1.0))
        loop = FeedforwardLoop(P, pid.candidate.pid, W.process, F.transfer)
        by_itself = Loop(P, pid.candidate.pid, W.process)
        horizon = vanished(by_itself, W.lags, W.delay + model.delay)
        theirs, alone = (integrated_error(one, "disturbance", horizon) for one in (loop, by_itself))
    except LoopError as error:
        return Offer(name, refused=str(error))
    if not loop.is_stable:
        return Offer(name, refused="the feedforward or the disturbance's path is not stable by itself")
    static = -W.gain / model.gain
    wrong = [replace(W, gain=factor * W.gain) for factor in (0.7, 1.3)]
    others = [FeedforwardLoop(P, pid.candidate.pid, w.process, F.transfer) for w in wrong]
    worst = max(integrated_error(one, "disturbance", horizon) for one in others)
    rows = [("static gain", static), *_numbers("num", F.transfer.num), *_numbers("den", F.transfer.den)]
    said = f" {F.said[0].upper()}{F.said[1:]}." if F.said else ""
    return Offer(
        name,
        "a step of the disturbance",
        theirs,
        alone,
        (*rows, ("delay", F.transfer.delay)),
        (
            f"u = feedback + F w; at rest F is {static:.4g} per unit of w.{said}",
            f"With the disturbance's gain wrong by 30 % the integrated error is {worst:.4g} at most.",
        ),
    )


def _numbers(name: str, row: Sequence[float]) -> list[tuple[str, float]]:
    return [(f"{name} s^{len(row) - 1 - i}", float(np.real(v))) for i, v in enumerate(row)]
