"""The first page: what was recorded, what to enter into which controller, how to switch on, what to watch."""

import math
from pathlib import Path

from loopbook.controllers.pid_forms import FormError, PidStandard
from loopbook.controllers.settings import PidSettings
from loopbook.design.start_state import start_formulas
from loopbook.design.study import Study
from loopbook.design.words import Units, as_plain_text
from notebook_reports.display import Table, number

LEFT = ["left", "left"]
MOST_CAUTIONS = 2


def recorded(study: Study) -> Table:
    """The record, its rest, the model, the noise and the limits, in a line each."""
    found, units, limits = study.identified, Units(study.identified), study.actuator
    rows = [["process", _process(study)]]
    marks = [""]
    if found is not None:
        u0, y0 = study.rest
        rows = [
            ["record", f"{as_plain_text(Path(study.data).name)}: {as_plain_text(study.line)}"],
            ["at rest", f"{units.u} = {units.input(u0)}, {units.y} = {units.output(y0)}"],
            *rows,
            ["noise", f"{units.output(study.conditions.noise, 2)} (standard deviation)"],
        ]
        marks = ["", "", "", ""]
    low, high = (units.input(v, 6) if math.isfinite(v) else "none" for v in limits.pair)
    confirm = "" if limits.confirmed else " (from the record: to be confirmed)"
    none = not any(map(math.isfinite, limits.pair))
    rows.append([f"limits of {units.u}", "none given" if none else f"{low} to {high}{confirm}"])
    marks.append("" if limits.confirmed and not none else "note")
    return Table(["", "What was recorded" if found else "What was given"], rows, "", LEFT, (), marks)


def _process(study: Study) -> str:
    found = study.identified
    explains = f", explains {found.chosen.fit:.1f} % of the response" if found else ""
    text = f"${study.model.latex()}${explains}"
    if found and (fit := found.directions):
        text += (
            f"; not the same both ways: $T$ = {number(fit.up.lags[0], 3)} s up, {number(fit.down.lags[0], 3)} s down"
        )
    return text


def entered(study: Study) -> Table:
    """The regulator's numbers in the form of each kind of controller."""
    s, pid, units = study.program.settings, study.recommendation.chosen.candidate.pid, Units(study.identified)
    times = [f"$T_i$ = {number(pid.Ti, 4)} s"] if math.isfinite(pid.Ti) else ["no integral action"]
    filter = [f"$T_d$ = {number(pid.Td, 4)} s", f"filter $T_f$ = {number(pid.Tf, 3)} s"] if pid.Td else ["$T_d$ = 0"]
    weight = f"set-point weight $b$ = {number(pid.b, 3)}"
    parallel = pid.parallel()
    p, i, d = (number(v, 4) for v in (parallel.P, parallel.I, parallel.D))
    rows = [
        ["standard (ISA, ideal)", ", ".join([f"$K$ = {number(pid.K, 4)}", *times, *filter, weight])],
        ["parallel", f"$P$ = {p}, $I$ = {i} per s, $D$ = {d} s"],
        *([["series (interacting)", series]] if (series := _series(pid)) else []),
        ["proportional band", f"{number(100 / abs(pid.K), 4)} %, where both signals are in % of their ranges"],
        ["PID library (Arduino)", _library(pid, s, study.limits)],
    ]
    low, high = (units.input(v, 6) if math.isfinite(v) else "none" for v in study.limits)
    acts = (
        "reverse acting (more measurement, less output)"
        if pid.K > 0
        else "direct acting (more measurement, more output)"
    )
    rows.append(
        [
            "each of them",
            f"every {number(float(s.h), 4)} s, limits {low} to {high}, {acts}, derivative on the measurement",
        ]
    )
    return Table(["", f"What to enter: {study.recommendation.chosen.candidate.name}"], rows, "", LEFT)


def _series(pid: PidStandard) -> str:
    if not pid.Td:
        return f"as standard: $K$ = {number(pid.K, 4)}" + (
            f", $T_i$ = {number(pid.Ti, 4)} s" if pid.Ti < math.inf else ""
        )
    try:
        series = pid.series()
    except FormError:
        return ""  # complex zeros: no series form is equal
    return f"$K$ = {number(series.K, 4)}, $T_i$ = {number(series.Ti, 4)} s, $T_d$ = {number(series.Td, 4)} s"


def _library(pid: PidStandard, settings: PidSettings, limits: tuple[float, float]) -> str:
    parallel = pid.parallel()
    gains = ", ".join(f"{abs(v):.5g}" for v in (parallel.P, parallel.I, parallel.D))
    on = ", P_ON_M" if pid.b == 0 else ""
    calls = [f"`SetTunings({gains}{on})`", f"`SetSampleTime({max(round(1000 * float(settings.h)), 1)})`"]
    if all(map(math.isfinite, limits)):
        calls.append(f"`SetOutputLimits({limits[0]:g}, {limits[1]:g})`")
    return ", ".join([*calls, "`DIRECT`" if pid.K > 0 else "`REVERSE`"])


def switched_on(study: Study) -> Table:
    """How to start without a bump, step by step."""
    units, program = Units(study.identified), study.program
    u0, y0 = study.rest
    start = program.start
    x, I = (f"`{text}`" for text in start_formulas())
    here = f"; at the record's rest {number(start['x'], 5)} and {number(start['I'], 5)}" if study.identified else ""
    at = f" at about {units.input(u0)} until {units.y} stands still near {units.output(y0)}" if study.identified else ""
    step = units.output(abs(study.steps[0]) / 2, 2)
    rows = [
        ["1  by hand", f"Hold {units.u}{at or ' until the output stands still'}."],
        ["2  numbers", "Enter the numbers above, and the limits that the actuator really has."],
        ["3  set-point", "Put it where the measurement stands."],
        ["4  start", "A controller with bumpless transfer starts by itself. A program of your own starts with "
                     f"{x} and {I}{here}."],
        ["5  automatic", f"Switch over: {units.u} must stay where it is. Then step the set-point by {step} at most."],
    ]  # fmt: skip
    return Table(["", "How to switch on"], rows, "", LEFT)


def watched(study: Study) -> Table:
    """What the running program should do, and what to mind."""
    units, run, e = Units(study.identified), study.running, study.running.expected
    settles = (
        f"within 2 % after {number(e['settling'], 3)} s"
        if e["settling"] is not None
        else "not settled in the time simulated"
    )
    step = units.output(run.reference, 3)
    peak = units.input(run.peak_input, 3)
    rows = [[f"set-point step of {step}",
             f"overshoot {number(run.overshoot, 3)} %, {settles}, {units.u} moves by up to {peak}"]]  # fmt: skip
    if run.input_noise:
        share = number(100 * run.at_limit, 2)
        rows.append(
            [
                "noise",
                f"{units.u} moves by {units.input(run.input_noise, 2)} (standard deviation), "
                f"{share} % of the samples at a limit",
            ]
        )
    holds = []
    if e["gain_margin"]:
        holds.append(f"a gain up to {number(e['gain_margin'], 3)} times the model's")
    if e["delay_margin"]:
        holds.append(f"{number(e['delay_margin'], 3)} s more dead time")
    rows.append(
        [
            "robustness",
            f"$M_s$ = {number(e['Ms'], 3) if e['Ms'] else '–'}"
            + (f"; stable for {' or '.join(holds)}" if holds else ""),
        ]
    )
    rows.append(["back to manual if", f"{units.u} swings and the swings grow, or it stays at a limit"])
    marks = [""] * len(rows)
    told = [text for text in study.cautions if not text.startswith("Limits")]  # the first table says that
    for text in told[:MOST_CAUTIONS]:
        rows.append(["mind", as_plain_text(text)])
        marks.append("note")
    if len(told) > MOST_CAUTIONS:
        rows.append(["mind", f"{len(told) - MOST_CAUTIONS} more on the following pages"])
        marks.append("note")
    return Table(["", "What to watch"], rows, "", LEFT, (), marks)
