"""A cascade from two outputs: an inner loop around the part of the process that a second measurement shows.

    y1 = P1 u,   y = P2 y1;    P1 from u to y1, P2 from the model's y1 to y

P2 is identified from the first model's own answer, not from the measured y1: its noise is not that of the input.
"""

import numpy as np

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design.beyond.offer import Offer, best_pid, integrated_error, vanished
from loopbook.design.evaluation import Evaluation
from loopbook.design.model import Model, from_fit
from loopbook.identification.choice import Identified, identify
from loopbook.loop.cascade import CascadeLoop
from loopbook.loop.continuous import Loop
from loopbook.loop.transfer import LoopError
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record, RecordError

NAME = "cascade"
INNER_MS = 1.7
INNER_SPEED = (0.25, 0.5, 1.0, 1.5)  # closed loop over the inner dead time or a tenth of its lags
OUTER_SPEED = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0)  # closed loop over what is late for the outer loop


def two_parts(found: Identified, inner: np.ndarray, name: str) -> tuple[Identified, Identified]:
    """(from the input to the inner measurement, from there to the output). inner: its samples, shape (n,).

    Raises RecordError where the record does not show one of them.
    """
    record = found.record
    first = identify(
        Record(record.time, record.u, inner, record.input_name, name, source=record.source, others=record.others)
    )
    fit = first.chosen
    answer = fit.gain * fit.structure.response(record.time, first.steps.list, fit.lags, fit.delay)
    second = identify(
        Record(
            record.time,
            fit.rest + answer,
            record.y,
            name,
            record.output_name,
            source=record.source,
            others=record.others,
        )
    )
    return first, second


def cascade_offer(found: Identified, inner: np.ndarray, name: str, loops: list[Evaluation], Ms: float) -> Offer:
    """A cascade with the inner measurement, beside the best PID from the input."""
    try:
        first, second = two_parts(found, inner, name)
    except RecordError as error:
        return Offer(NAME, refused=f"{name} shows no part of the process: {error}")
    source = found.record.source or "the record"
    return compared(from_fit(first.chosen, source), from_fit(second.chosen, source), loops, Ms)


def compared(P1: Model, P2: Model, loops: list[Evaluation], Ms: float) -> Offer:
    """The fastest cascade of PI regulators beside the best PID, after a load step at the process's input."""
    pid = best_pid(loops, Ms)
    if pid is None:
        return Offer(NAME, refused=f"no PID keeps Ms = {Ms:g} to compare with")
    if P1.integrating or not (P1.of_lags and P2.of_lags):
        return Offer(NAME, refused="the inner part is to be lags and a dead time")
    inner = _inner(P1)
    if inner is None:
        return Offer(NAME, refused=f"no inner PI keeps Ms = {INNER_MS:g}")
    for regulator in _outer(P1, P2):
        loop = CascadeLoop(P1.process, P2.process, inner, regulator)
        try:
            if not loop.is_stable or loop.margins().Ms.value > Ms:
                continue
        except LoopError:
            continue
        return _offer(loop, P1.process * P2.process, pid)
    return Offer(NAME, refused=f"no outer PI keeps Ms = {Ms:g}")


def _offer(loop: CascadeLoop, whole: Process, pid: Evaluation) -> Offer:
    inner, regulator = loop.inner_regulator, loop.outer_regulator
    by_itself = Loop(whole, pid.candidate.pid)
    error = integrated_error(loop, "inner load", vanished(loop.outer, (), whole.delay))
    alone = integrated_error(by_itself, "load", vanished(by_itself, (), whole.delay))
    bears = [loop.inner.margins(), loop.margins()]
    return Offer(
        NAME,
        "a load step at the input",
        error,
        alone,
        (("inner K", inner.K), ("inner Ti", inner.Ti), ("outer K", regulator.K), ("outer Ti", regulator.Ti)),
        (
            f"Inner PI K = {inner.K:.4g}, Ti = {inner.Ti:.4g} s; outer PI K = {regulator.K:.4g}, "
            f"Ti = {regulator.Ti:.4g} s; Ms = {bears[0].Ms.value:.2f} inside, {bears[1].Ms.value:.2f} outside.",
            f"The inner loop bears {bears[0].delay:.3g} s more dead time, the outer one {bears[1].delay:.3g} s.",
        ),
    )


def _inner(P1: Model) -> PidStandard | None:
    """The fastest SIMC PI of the inner process that keeps its Ms."""
    T = P1.lags[0]
    late = P1.delay + sum(P1.lags[1:]) / 2
    for speed in INNER_SPEED:
        closed = speed * max(late, T / 10)
        regulator = PidStandard((T + late / 3) / (P1.gain * (closed + late)), min(T, 4 * (closed + late)))
        loop = Loop(P1.process, regulator)
        if loop.is_stable and loop.margins().Ms.value <= INNER_MS:
            return regulator
    return None


def _outer(P1: Model, P2: Model) -> list[PidStandard]:
    """PIs of the outer process by SIMC, from fast to slow; the closed inner loop counts as late by its dead time."""
    inner = P1.delay + (sum(P1.lags[1:]) / 2 or P1.lags[0] / 10)
    late = 2 * inner + P2.delay + sum(P2.lags[1:]) / 2
    found = []
    for speed in OUTER_SPEED:
        wait = late * (1 + speed)
        if P2.integrating:
            found.append(PidStandard(1 / (P2.gain * wait), 4 * wait))
        else:
            T = P2.lags[0] + (P2.lags[1] / 2 if len(P2.lags) > 1 else 0.0)
            found.append(PidStandard(T / (P2.gain * wait), min(T, 4 * wait)))
    return found
