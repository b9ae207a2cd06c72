"""A design as plain data, for a program to read."""

from pathlib import Path
from typing import Any

from loopbook.design.controllers import entered_forms
from loopbook.loop.ultimate_point import NoSuchFrequency, ultimate


def ultimate_point(model: Any) -> dict[str, float]:
    """K180 and T180 as measured, else those of the model; empty where it has none."""
    if model.frequency is not None:
        return {"K180": model.frequency.K180, "T180": model.frequency.T180}
    try:
        point = ultimate(model.upright.process)
    except NoSuchFrequency:
        return {}
    return {"K180": point.K180, "T180": point.T180}


def results(study: Any) -> dict[str, Any]:
    """The design as plain data: process, rule, the program's numbers, what to expect of it, what to mind.

    Units: seconds, rad/s, degrees, those of the record. null stands for infinite and for unknown.
    """
    chosen, model = study.recommendation.chosen, study.model
    names = ("gain", "time_constants", "delay", "integrating")
    process = dict(zip(names, (model.gain, list(model.lags), model.delay, model.integrating), strict=True))
    if model.damping is not None:
        process["damping"] = model.damping
    if model.zero:
        process["zero"] = model.zero
    found = study.identified
    fit = {"percent": found.chosen.fit, "rms": found.chosen.rmse} if found else None
    widths = {p.name: p.half_width for p in found.chosen.parameters} if found else None
    record = signals = None
    if found:
        r = found.record
        signals = {
            "y": {"name": r.output_name, "unit": r.output_unit},
            "u": {"name": r.input_name, "unit": r.input_unit},
        }
        record = {"input": r.input_name, "output": r.output_name, "time_unit": r.time_unit,
                  "steps": len(found.steps.list), "samples": len(r.time)}  # fmt: skip
        if found.directions:
            process["by_direction"] = {
                "up": {"time_constants": list(found.directions.up.lags)},
                "down": {"time_constants": list(found.directions.down.lags)},
            }
    swing = found.oscillation if found else None
    point = ultimate_point(model) if swing else None
    return {
        "data": Path(study.data).name,
        "record": record,
        **({"signals": signals} if signals else {}),
        **({"oscillation": {"kind": swing.kind, "periods": swing.periods, **point}} if swing and point else {}),
        "process": {**process, "source": model.source, "fit": fit, "half_widths_95": widths},
        "aim": study.aim,
        "rule": chosen.candidate.name,
        **study.program.data(),
        "limits_confirmed": study.actuator.confirmed,
        "expected": study.running.expected,
        "beyond": [offer.data() for offer in study.beyond],
        "enter": [one.data() for one in entered_forms(study)],
        "mind": study.mind,
    }
