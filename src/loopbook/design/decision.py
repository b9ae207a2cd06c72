"""The decision: recommended for the aim, and able to run; slower where the rules at their own speed ask too much."""

import math
from dataclasses import replace
from typing import Any

from loopbook.design import recommendation, selection, speed
from loopbook.design.evaluation import Evaluation, Robustness
from loopbook.design.model import ModelError
from loopbook.identification.intervals import quantum
from loopbook.records.record import RecordError

FASTEST_PEAK = 2.5  # Ms of a loop whose speed the user chose: beyond, it is refused
SLOWER = (0.75, 0.5, 0.25, 0.0)  # speeds that are tried where no rule gives what can be run


def conditions(study: Any) -> selection.Conditions:
    """What a program for this study has to live with."""
    found = study.identified
    noise, step, span, logged = 0.0, 0.0, 0.0, 0.0
    if found is not None:
        noise, step = found.chosen.noise, quantum(found.record.y)
        span, logged = float(found.record.u.max() - found.record.u.min()), found.record.sampling
    return selection.Conditions(study.model, study.milder, noise, step, span, logged, study.rest, study.limits, study.h,
                      study.time_constant, *study.steps)  # fmt: skip


def curve(study: Any) -> list[tuple[speed.Speed, Evaluation]]:
    """From slow to fast the PI and the PID that do best after a load step."""
    found = []
    for value in speed.CURVE:
        knob = speed.at_speed(study.model, value)
        loops = [e for e in study.at_speed(knob, "MIGO") if e.stable]
        for kind in (False, True):
            of_kind = [e for e in loops if bool(e.candidate.pid.Td) is kind]
            if of_kind:
                found.append((knob, min(of_kind, key=lambda e: e.iae_load)))
    return found


def decide(study: Any) -> tuple[recommendation.Recommendation, selection.Selected]:
    """The recommendation and its program. Raises RecordError where no regulator can be recommended."""
    aim = recommendation.AIMS.get(study.aim)
    if aim is None:
        raise recommendation.AimError(f"aim = {study.aim!r}: one of {', '.join(recommendation.AIMS)}")
    pool, tried = study.at_knob or study.evaluations, []
    spread = study.spread_of([e for e in pool if e.stable and aim.admits(e, e.Ms)])

    def attempt(
        loops: list[Evaluation], spread: dict[str, Robustness]
    ) -> tuple[recommendation.Recommendation, selection.Selected | None]:
        found = recommendation.recommend(loops, study.aim, spread)
        tried.extend([*found.admitted, *([found.chosen] if found.compromise else [])])
        admits = lambda e: aim.admits(e, recommendation.worst_peak(e, study.spread_of([e])[e.candidate.name]))  # noqa: E731
        ordered = found.admitted or ((found.chosen,) if study.knob else ())
        limit = math.inf if study.knob else aim.Ms
        chosen = selection.select(ordered, admits, limit, study.conditions)
        return found, chosen

    first: recommendation.Recommendation | None = None
    chosen: selection.Selected | None = None
    if any(e.stable for e in pool):
        first, chosen = attempt(pool, spread)
    found, passed_over = first, []
    if chosen is None and not study.knob:
        for value in SLOWER:
            loops = [e for e in study.at_speed(speed.at_speed(study.model, value), "PID") if e.stable]
            if loops:
                found, chosen = attempt(loops, study.spread_of(loops))
            if chosen is not None:
                passed_over = [f"The rules at their own speed ask too much here; this one is at the speed {value:g}."]
                break
    if chosen is None:
        chosen, found = selection.least_shaking([e for e in tried if e.stable], study.conditions), first or found
    if chosen is None or found is None:
        raise RecordError(_none(study, [e for e in tried if e.stable]))
    if study.knob and not chosen.running.Ms <= FASTEST_PEAK:
        raise ModelError(
            f"a closed loop of {study.knob.closed:.3g} s is faster than the process allows: with "
            f"{chosen.chosen.candidate.name} Ms would be {chosen.running.Ms:.2f} (2 is the usual limit); "
            f"the fast end of the knob, --speed 1, is {speed.at_speed(study.model, 1.0).closed:.3g} s"
        )
    reasons = [
        r for r in found.reasons if chosen.chosen.candidate.name == found.chosen.candidate.name or "Next" not in r
    ]
    if chosen.chosen.candidate.name != found.chosen.candidate.name:
        reasons = [
            f"{chosen.chosen.candidate.name} keeps {aim.keeps} and can be run.",
            *chosen.chosen.candidate.notes,
        ]
    if study.milder is not None:
        reasons.append("The process is not the same both ways: designed for the faster way, checked on the slower one.")
    compromise = found.compromise or chosen.compromise
    decided = replace(
        found, chosen=chosen.chosen, reasons=(*reasons, *passed_over, *chosen.reasons), compromise=compromise
    )
    return decided, chosen


def _none(study: Any, stable: list[Evaluation]) -> str:
    """Why no regulator can be recommended."""
    if not stable:
        return "no regulator can be recommended: no rule gives a stable loop with this process"
    against = selection.objection(stable[0], *selection.build(stable[0], study.conditions), study.conditions, math.inf)
    if study.knob:
        return (
            f"no regulator can be recommended: for a closed loop of {study.knob.closed:.3g} s "
            f"{against or 'too much is asked'}; ask for a slower one (--closed-loop, --speed)"
        )
    return (
        f"no regulator can be recommended: with {stable[0].candidate.name} {against or 'too much is asked'}; "
        "the record does not determine the process well enough, or the measurement is too noisy"
    )
