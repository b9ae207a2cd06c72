"""The design report's tables."""

import math
from collections.abc import Sequence

from loopbook.code import regulator_from_json
from loopbook.code.precision import cost
from loopbook.design.candidates import Refused
from loopbook.design.evaluation import Evaluation, Robustness
from loopbook.design.program import GAINS, SampledProgram
from loopbook.design.recommendation import Recommendation
from loopbook.design.study import Study
from loopbook.design.words import as_plain_text
from loopbook.identification.fit import Parameter
from loopbook.identification.graphical import graphical_readings
from loopbook.records.record import RecordError
from notebook_reports.display import Table, number


def _shown(value: float, digits: int = 3) -> str:
    return "–" if value is None or math.isnan(value) else number(value, digits)


def assumptions(study: Study) -> Table:
    """What the record was taken to be, or where the model comes from."""
    if study.identified is None:
        return Table(
            ["", "what was given"],
            [["1", f"A model: {as_plain_text(study.model.source)}. Nothing was fitted."]],
            "The model",
        )
    found = study.identified
    rows = [[str(i + 1), as_plain_text(text)] for i, text in enumerate((*found.record.assumptions, *found.steps.notes))]
    return Table(["", "what was assumed"], rows, "How the record was read", ["right", "left"])


def fits(study: Study) -> Table:
    """Every fitted structure with its parameters and 95 % intervals; the chosen one is marked."""
    if study.identified is None:
        return Table(["model"], [["given, not fitted"]], "Models")
    found = study.identified
    rows, marks = [], []
    for structure, fit in found.fits.items():
        values = [_estimate(p, found.record.sampling) for p in fit.parameters]
        numbers = (number(fit.fit, 4), number(fit.rmse, 3), number(found.criteria[structure], 3))
        rows.append([structure.name, ", ".join(values), *numbers])
        marks.append("good" if fit is found.chosen else "")
    heads = ["model", "parameters with 95 % intervals, times in s", "fit [%]", "rms residual", "Akaike, above the best"]
    return Table(heads, rows, "Models fitted to the record", ["left", "left", "right", "right", "right"], (), marks)


def _estimate(parameter: Parameter, sampling: float) -> str:
    """An estimate with its interval, or that the record says nothing of it."""
    if parameter.half_width > 10 * max(abs(parameter.value), sampling):
        return f"{parameter.name} not determined"
    return f"{parameter.name} = {number(parameter.value, 4)} ± {number(parameter.half_width, 2)}"


def choice(study: Study) -> Table:
    """Why this model, and what limits its use."""
    if study.identified is None:
        return Table(["model"], [["The model is taken as exact: the margins below know no uncertainty."]], "The choice")
    found = study.identified
    rows = [["reason", as_plain_text(text)] for text in found.reasons] + [
        ["mind", as_plain_text(text)] for text in found.warnings
    ]
    marks = ["good"] * len(found.reasons) + ["note"] * len(found.warnings)
    return Table(["", "the choice of the model"], rows, "Why this model", ["left", "left"], (), marks)


def graphical(study: Study) -> Table:
    """What the documents' graphical rules read off the first step."""
    if study.identified is None:
        return Table(["rule"], [["no record: nothing to read"]], "Graphical rules")
    try:
        readings = graphical_readings(study.identified.record)
    except RecordError as error:
        return Table(["rule"], [[f"no step that can be read: {as_plain_text(str(error))}"]], "Graphical rules")
    rows = [
        [r.rule, r.source, ", ".join(f"{n} = {number(v, 4)}" for n, v in r.values.items()) or f"refuses: {r.reason}"]
        for r in readings
    ]
    return Table(["rule", "source", "reads"], rows, "Graphical rules on the first step", ["left"] * 3)


def recommendation(found: Recommendation) -> Table:
    """The chosen setting with its reasons."""
    rows = [[text] for text in found.reasons]
    mark = "note" if found.compromise else "good"
    caption = f"Recommended for the aim {found.aim.name}: {found.chosen.candidate.name}"
    return Table(["reasons"], rows, caption, ["left"], (), [mark] + [""] * (len(rows) - 1))


def settings(evaluations: Sequence[Evaluation]) -> Table:
    """Settings of every rule that applies, in standard and parallel form."""
    rows = []
    for e in evaluations:
        pid, parallel = e.candidate.pid, e.candidate.pid.parallel()
        times = [_shown(pid.Ti) if math.isfinite(pid.Ti) else "∞", _shown(pid.Td) if pid.Td else "–", _shown(pid.b)]
        rows.append(
            [e.candidate.name, _shown(pid.K), *times, _shown(parallel.I), _shown(parallel.D) if pid.Td else "–"]
        )
    heads = ["rule", "$K = P$", "$T_i$ [s]", "$T_d$ [s]", "$b$", "$I$ [1/s]", "$D$ [s]"]
    return Table(
        heads, rows, "Settings, standard form and parallel gains; derivative on the measurement, $T_f = T_d/10$"
    )


def validity(evaluations: Sequence[Evaluation], refused: Sequence[Refused]) -> Table:
    """What limits the rules on this process, and which refused it."""
    rows = [[e.candidate.name, "; ".join(e.candidate.notes)] for e in evaluations if e.candidate.notes]
    rows += [[r.name, f"does not apply: {r.reason}"] for r in refused]
    marks = ["note"] * len(rows)
    return Table(["rule", "validity"], rows or [["all rules", "apply within their range"]], "Where the rules hold",
                 ["left", "left"], (), marks or [""])  # fmt: skip


def robustness(evaluations: Sequence[Evaluation], spread: dict[str, Robustness]) -> Table:
    """Margins with exact dead time, and the same over the model's uncertainty where it is known."""
    rows, marks = [], []
    known = any(r.models for r in spread.values())
    for e in evaluations:
        found = spread.get(e.candidate.name)
        row = [e.candidate.name]
        margins = [e.Ms, e.Mt, e.gain_margin, e.phase_margin, e.delay_margin]
        row += [number(m, 3) for m in margins] if e.stable else ["not judged" if e.reason else "unstable", *["–"] * 4]
        if known:
            row += [f"{found.stable} of {found.models}", _shown(found.Ms)] if found else ["–", "–"]
        rows.append(row)
        marks.append("bad" if not e.stable else "good" if e.Ms <= 1.6 else "note" if e.Ms > 2 else "")
    heads = ["rule", "$M_s$", "$M_t$", "gain margin", "phase margin [°]", "delay margin [s]"]
    heads += ["stable models", "$M_s$, 95 %"] if known else []
    return Table(heads, rows, "Robustness", (), (), marks)


def performance(evaluations: Sequence[Evaluation]) -> Table:
    """Responses to unit steps: what each setting gives and what it asks of the actuator."""
    rows = []
    for e in evaluations:
        numbers = (e.iae_reference, e.iae_load, e.overshoot, e.settling, e.peak_input, e.variation, e.noise_gain)
        rows.append([e.candidate.name, *[_shown(v) for v in numbers]])
    heads = ["rule", "IAE, reference", "IAE, load", "overshoot [%]", "settling [s]", "peak $u$", "variation of $u$",
             "noise gain"]  # fmt: skip
    return Table(heads, rows, "Responses to unit steps of the reference and of the load")


def program_coefficients(program: SampledProgram) -> Table:
    """The numbers that go into the controller."""
    s = program.settings
    names = {"K": "gain", "Ti": "integral time", "Td": "derivative time", "Tf": "filter time constant",
             "b": "set-point weight", "h": "sampling interval", "Tt": "tracking time constant"}  # fmt: skip
    units = {"K": "u/y", "b": ""}
    rows = [
        [f"${n[0]}_{n[1]}$" if len(n) > 1 else f"${n}$", names[n], number(getattr(s, n), 6), units.get(n, "s")]
        for n in names
        if getattr(s, n) is not None
    ]
    rows += [[f"${name}$", GAINS[name], number(value, 6), ""] for name, value in program.gains.items()]
    align = ["left", "left", "right", "left"]
    share = f"{100 * max(program.delay_margin_left, 0.0):.0f} %"
    left = f"Sampling adds half an interval of dead time and leaves {share} of the delay margin."
    return Table(["", "coefficient", "value", "unit"], rows, "The discrete regulator", align, (*program.why, left))


def single_precision(study: Study) -> Table:
    """What the regulator pays for 32-bit numbers, at the record's rest and over its range of y."""
    found = study.identified
    if found is None:
        return Table(
            ["single precision"], [["A model has no range of measurement to compare with."]], "Single precision"
        )
    y = found.record.y
    price = cost(regulator_from_json(study.results()), float(y.max() - y.min()))
    units = {"y": as_plain_text(found.record.output_unit), "u": as_plain_text(found.record.input_unit)}
    rows = [[what, value, units.get(unit, unit)] for what, value, unit in price.rows()]
    advice = price.advice or ("Single precision is enough: no error that matters is lost in the integral.",)
    return Table(
        ["what", "value", "unit"],
        rows,
        "What 32-bit numbers and 12-bit converters cost",
        ["left", "right", "left"],
        advice,
    )
