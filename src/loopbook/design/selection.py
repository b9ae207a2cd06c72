"""From the loops that keep what the aim asks to the one that can run: quiet enough, not absurd, sampled in time."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from loopbook.controllers.settings import SettingError
from loopbook.design.candidates import filtered
from loopbook.design.evaluation import Evaluation, evaluate
from loopbook.design.model import Model
from loopbook.design.program import SampledProgram, sampled_program
from loopbook.design.running import Running

FILTERS = (10.0, 5.0, 3.0, 2.0)  # N, from the usual one to the heaviest
QUIET = 0.05  # standard deviation of u, as a share of the input's range in the record
LOUDEST = 0.25  # of the same: beyond, there is no regulator to recommend
KICK = 0.1  # of the same: what one step of a quantised measurement may do to u
MOST_GAIN = 50.0  # K Kp, or K Kv times the dead time and lags: more is nothing that a record can support
FINER = (1, 2, 5)  # how much faster a loop is sampled that loses its robustness by sampling


@dataclass(frozen=True)
class Conditions:
    """What a program has to live with.

    model, milder: of the process (the other direction, where there is one). noise, quantum [y]: of the measurement.
    span [u]: the input's range in the record, 0 where there is none. logged [s]: the record's sampling interval.
    rest: (u, y). limits of u. h [s]: given, or 0. time_constant [s]. reference [y], load [u]: the steps.
    """

    model: Model
    milder: Model | None
    noise: float
    quantum: float
    span: float
    logged: float
    rest: tuple[float, float]
    limits: tuple[float, float]
    h: float
    time_constant: float
    reference: float
    load: float


@dataclass(frozen=True)
class Selected:
    """A loop with its program. reasons: why not the first one, or what it lacks. compromise: does it lack something?"""

    chosen: Evaluation
    program: SampledProgram
    running: Running
    reasons: tuple[str, ...]
    compromise: bool


def horizon(chosen: Evaluation, model: Model, time_constant: float) -> float:
    """A time [s] in which the loop settles twice: after a reference and after a load step."""
    return 2 * max(1.5 * chosen.settling, 10 * model.delay, 2 * time_constant)


def build(e: Evaluation, c: Conditions, Ms: float = math.inf) -> tuple[SampledProgram, Running]:
    """The program of a loop and what it does; sampled so fast, where h is not given, that its Ms stays below Ms."""
    time = horizon(e, c.model, c.time_constant)
    for finer in FINER:
        program = sampled_program(e, c.time_constant, c.h, c.limits, c.rest, c.logged, finer)
        running = Running(c.model, program, time, c.reference, c.load, c.noise, c.rest, c.milder)
        if c.h or not running.Ms > Ms:
            break
    return program, running


def objection(e: Evaluation, program: SampledProgram, running: Running, c: Conditions, Ms: float) -> str:
    """What speaks against running the program, "" for nothing. Ms: what the aim allows."""
    gain = abs(e.candidate.pid.K * c.model.gain)
    if c.model.integrating:
        gain *= sum(c.model.lags) + c.model.delay + float(program.settings.h)
    if gain > MOST_GAIN:
        return f"its gain times the process's is {gain:.3g}"
    if not c.h and running.Ms > Ms:
        return f"sampled every {float(program.settings.h):g} s its Ms is {running.Ms:.2f}"
    if not c.span:
        return ""
    shake = running.input_noise / c.span
    if shake > QUIET:
        return f"the measurement's noise would shake the input by {100 * shake:.0f} % of its range (standard deviation)"
    kick = program.gains["p_2"] * c.quantum / c.span
    if abs(kick) > KICK:
        percent = f"{100 * abs(kick):.0f} %"
        return f"one step of the measurement ({c.quantum:.3g}) would kick the input by {percent} of its range"
    return ""


def select(
    ordered: Sequence[Evaluation],
    admits: Callable[[Evaluation], bool],
    Ms: float,
    c: Conditions,
) -> Selected | None:
    """The first loop, in the order given, that nothing speaks against; heavier filters are tried before the next rule.

    admits: does a loop with another filter still keep what the aim asks? None where all are objected to.
    """
    reasons: list[str] = []
    for e in ordered:
        why = ""
        for N in FILTERS if e.candidate.pid.Td else FILTERS[:1]:
            now = e if N == FILTERS[0] else evaluate(c.model, filtered(e.candidate, N))
            if not now.stable or (now is not e and not admits(now)):
                continue
            try:
                program, running = build(now, c, Ms)
            except SettingError as error:
                why = why or str(error)
                continue
            if (
                not c.h
                and now.candidate.pid.Td
                and now.candidate.pid.Tf < float(program.settings.h)
                and N != FILTERS[-1]
            ):
                continue
            against = objection(now, program, running, c, Ms)
            if not against:
                note = [
                    f"The derivative's filter is heavier than usual (N = {N:g}): the measurement's noise asks for it."
                ]
                return Selected(now, program, running, (*reasons, *(note if now is not e else [])), False)
            why = why or against
        reasons.append(f"{e.candidate.name} was passed over: {why or 'with a heavier filter it loses its robustness'}.")
    return None


def least_shaking(tried: Sequence[Evaluation], c: Conditions) -> Selected | None:
    """Of loops that are all objected to, the one that shakes the input least; None where even that is too much."""
    best = None
    for e in tried:
        try:
            program, running = build(e, c)
        except SettingError:
            continue
        if objection(e, program, running, c, math.inf).startswith("its gain"):
            continue
        shake = running.input_noise / c.span if c.span else 0.0
        if best is None or shake < best[0]:
            best = shake, e, program, running
    if best is None or best[0] > LOUDEST:
        return None
    shake, e, program, running = best
    return Selected(e, program, running, (f"Mind: {objection(e, program, running, c, math.inf)}.",), True)
