"""What `loopbook tune` reads: a record, a model, a regulator's JSON; and a design that has been made."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from loopbook.controllers.pid_forms import FormError, PidStandard
from loopbook.design.model_file import read_model
from loopbook.design.study import Study
from loopbook.process.construct import tf
from loopbook.process.transfer_function import Process, ProcessError
from loopbook.tuner_page.settings import TunerError
from loopbook.tuner_page.turned import TurnedLoop, tuner

USUAL = 20.0
"""The uncertainty of the dead time [%] where nothing is known of it."""


def of_file(path: Path) -> TurnedLoop:
    """A record (CSV, spreadsheet, Parquet), a model (TOML) or a regulator (JSON) with its knobs.

    A record is identified and the recommended regulator taken; a model gets a rule's settings. Raises what their
    readers raise, and TunerError for a JSON that is no regulator of a known process.
    """
    if path.suffix.lower() == ".json":
        return of_regulator(path)
    if path.suffix.lower() == ".toml":
        return tuner(read_model(path).process, name=path.stem)
    return of_study(Study(path))


def of_study(study: Any) -> TurnedLoop:
    """A design (`loopbook.design.study.Study`): its model, the recommended regulator, steps, record and limits.

    Limits taken from the record, which are only what it happened to go through, are left out.
    """
    found, s = study.identified, study.program.settings
    rest = study.rest if found is not None else (0.0, 0.0)
    limits = tuple(limit - rest[0] for limit in study.limits) if study.actuator.confirmed else None
    pid = PidStandard(s.K, math.inf if s.Ti is None else s.Ti, s.Td, b=s.b, c=s.c, Tf=s.Tf)
    record, names, shares = None, None, {"L": USUAL}
    if found is not None:
        log = found.record
        record = {"t": log.time, "u": log.u, "y": log.y, "u0": rest[0], "y0": rest[1]}
        names = {"y": _name(log.output_name, log.output_unit), "u": _name(log.input_name, log.input_unit)}
        shares = _shares(found.chosen)
    caption = (
        "The recommended loop on its model: output and input after a set-point and a load step, and the Nyquist "
        "curve. In the HTML report its knobs can be turned."
    )
    return tuner(
        study.model.process,
        pid,
        limits=limits,
        steps=study.steps,
        uncertainty=shares,
        record=record,
        names=names,
        name=Path(study.data).stem,
        caption=caption,
    )


def _name(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def _shares(fit: Any) -> dict[str, float]:
    """The half-widths of the 95 % intervals in per cent: of the gain, of the longest lag, of the dead time."""
    gain, *lags, delay = fit.parameters
    share = lambda p: min(100 * p.half_width / abs(p.value), 100.0) if p.value else 0.0  # noqa: E731
    return {"K": share(gain), "T": share(max(lags, key=lambda p: p.value)) if lags else 0.0, "L": share(delay)}


def of_regulator(path: Path) -> TurnedLoop:
    """A regulator's JSON: of a design, of the page itself, or written by hand with its process."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise TunerError(f"{path}: no JSON that can be read: {error}") from None
    if not isinstance(data, Mapping) or not isinstance(data.get("process"), Mapping):
        raise TunerError(f"{path}: process is missing: {{gain, time_constants, delay, integrating}} is expected")
    if data.get("form") != "standard" or not isinstance(data.get("settings"), Mapping):
        raise TunerError(
            f"{path}: form = {data.get('form')!r}: a PID regulator, form standard with settings, is expected"
        )
    s, limits = data["settings"], data.get("limits") or {}
    point = (data.get("operating_point") or {}).get("u0", 0.0)
    try:
        Ti = math.inf if s.get("Ti") is None else float(s["Ti"])
        numbers = {key: float(s.get(key, usual)) for key, usual in (("Td", 0), ("b", 1), ("c", 0), ("Tf", 0))}
        pid = PidStandard(float(s["K"]), Ti, **numbers)
        low, high = (None if limits.get(key) is None else float(limits[key]) - point for key in ("u_low", "u_high"))
        process = _process(data["process"])
    except (KeyError, TypeError, ValueError, FormError, ProcessError) as error:
        raise TunerError(f"{path}: {error!s} is missing or no number that it can be") from None
    ends = (-math.inf if low is None else low, math.inf if high is None else high)
    steps = data.get("expected") or {}
    return tuner(
        process,
        pid,
        limits=ends,
        steps=(steps["reference_step"], steps["load_step"]) if {"reference_step", "load_step"} <= set(steps) else None,
        uncertainty={"L": USUAL},
        name=str(data.get("name") or path.stem),
    )


def _process(data: Mapping[str, Any]) -> Process:
    if "num" in data:
        return Process(tuple(data["num"]), tuple(data["den"]), float(data.get("delay", 0.0)))
    lags = data.get("time_constants", [])
    rows = [[float(T), 1.0] for T in (lags if isinstance(lags, list) else [lags])]
    rows += [[1.0, 0.0]] * bool(data.get("integrating"))
    gain, zero = float(data["gain"]), float(data.get("zero", 0.0))
    num = [gain * zero, gain] if zero else [gain]
    return tf(num, rows or [[1.0]], delay=float(data.get("delay", 0.0)))
