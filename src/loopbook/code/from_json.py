"""A controller from the JSON of a design, or from one written by hand.

    {"form": "standard", "settings": {"K": 2.0, "Ti": 10.0, "Td": 1.0, "Tf": 0.1, "b": 1.0, "h": 0.5},
     "limits": {"u_low": 0.0, "u_high": 100.0}}

What more may stand there: ``name``; ``start`` {u, y}, where the process was at rest; ``signals``, for y and u each
{name, unit, span: [low, high], raw: [low, high]}, from which the scaling of the converters is written; ``data``,
``rule`` and ``mind``, which become comments. Other forms: see `FORMS`.
"""

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from textwrap import wrap
from typing import Any

from loopbook.code.block import Block, BlockSignal, CodeError, identifier
from loopbook.code.laws import on_off_block, rst_block, scheduled_block, smith_block
from loopbook.code.pid import pid_block
from loopbook.controllers.rst import PlacementError, Rst
from loopbook.controllers.settings import PidSettings, SettingError

WIDTH = 110  # of a comment
PID_SETTINGS = ("K", "Ti", "Td", "Tf", "b", "c", "h", "Tt", "rate", "anti_windup")


def _read(data: Mapping[str, Any], where: str, name: str, kind: str, default: Any = ...) -> Any:
    """One value of a JSON object. kind: number, numbers, object, objects or text."""
    value = data.get(name, default)
    if value is ...:
        raise CodeError(f"{where}: {name} is missing; it has {', '.join(data) or 'nothing'}")
    if value is default:
        return value
    if not KINDS[kind](value):
        raise CodeError(f"{where}: {name} = {value!r}: {kind} expected")
    return value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


KINDS: dict[str, Callable[[Any], bool]] = {
    "a number": _is_number,
    "numbers": lambda v: isinstance(v, list) and bool(v) and all(map(_is_number, v)),
    "two numbers": lambda v: isinstance(v, list) and len(v) == 2 and all(map(_is_number, v)),
    "an object": lambda v: isinstance(v, Mapping),
    "a list of objects": lambda v: isinstance(v, list) and all(isinstance(one, Mapping) for one in v),
    "a list of text": lambda v: isinstance(v, list) and all(isinstance(one, str) for one in v),
    "text": lambda v: isinstance(v, str),
}


def _limits(data: Mapping[str, Any]) -> tuple[float, float]:
    """u_low and u_high; null is unlimited."""
    limits = _read(data, "the regulator", "limits", "an object", {})
    given = {n: v for n, v in limits.items() if v is not None}
    low = _read(given, "limits", "u_low", "a number", -math.inf)
    high = _read(given, "limits", "u_high", "a number", math.inf)
    return float(low), float(high)


def _pid_settings(data: Mapping[str, Any], **fixed: Any) -> PidSettings:
    settings = _read(data, "the regulator", "settings", "an object")
    if strange := sorted(set(settings) - set(PID_SETTINGS)):
        raise CodeError(f"settings: {', '.join(strange)} unknown; a PID controller has {', '.join(PID_SETTINGS)}")
    kinds = {"anti_windup": "text"}
    found = {n: _read(settings, "settings", n, kinds.get(n, "a number")) for n in settings if settings[n] is not None}
    for name in ("K", "h"):
        if name not in found and name not in fixed:
            raise CodeError(f"settings: {name} is missing; they have {', '.join(settings) or 'nothing'}")
    low, high = _limits(data)
    return PidSettings(**{**found, **fixed}, u_low=low, u_high=high)


def _standard(data: Mapping[str, Any], **more: Any) -> Block:
    return pid_block(_pid_settings(data), **more)


def _rst(data: Mapping[str, Any], *, compensated: bool = False, **more: Any) -> Block:
    R, S, T = (tuple(_read(data, "the regulator", n, "numbers")) for n in "RST")
    observer = tuple(_read(data, "the regulator", "observer", "numbers", [1.0]))
    h = float(_read(data, "the regulator", "h", "a number"))
    return rst_block(Rst(R, S, T, h, observer), *_limits(data), **more)


def _on_off(data: Mapping[str, Any], *, compensated: bool = False, **more: Any) -> Block:
    settings = _read(data, "the regulator", "settings", "an object", {})
    low, high = _limits(data)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise CodeError("limits: on-off control needs u_low and u_high, the two outputs")
    return on_off_block(low, high, float(_read(settings, "settings", "hysteresis", "a number", 0.0)), **more)


def _scheduled(data: Mapping[str, Any], **more: Any) -> Block:
    zones = _read(data, "the regulator", "zones", "a list of objects")
    edges = _read(data, "the regulator", "edges", "numbers")
    first = {n: zones[0][n] for n in ("K", "Ti", "Td") if zones and zones[0].get(n) is not None}
    band = float(_read(data, "the regulator", "hysteresis", "a number", 0.0))
    return scheduled_block(zones, edges, band, _pid_settings(data, **first), **more)


def _smith(data: Mapping[str, Any], **more: Any) -> Block:
    model = _read(data, "the regulator", "model", "an object")
    numbers = [float(_read(model, "model", n, "a number")) for n in ("gain", "time_constant", "delay")]
    return smith_block(_pid_settings(data), *numbers, **more)


FORMS: dict[str, tuple[Callable[..., Block], str]] = {
    "standard": (_standard, "PID: settings K, h and where wanted Ti, Td, Tf, b, c, Tt, rate, anti_windup"),
    "rst": (_rst, "R, S, T, h, observer: coefficients of z^0, z^-1, ..."),
    "on-off": (_on_off, "settings hysteresis; limits u_low and u_high are the outputs"),
    "scheduled": (_scheduled, "zones [{K, Ti, Td}], edges, hysteresis; settings for what the zones share"),
    "smith": (_smith, "as standard, with model {gain, time_constant, delay}"),
}
"""What ``form`` may be, and what the JSON then holds."""


def _signal(data: Mapping[str, Any], name: str) -> BlockSignal:
    signals = _read(data, "the regulator", "signals", "an object", {})
    given = _read(signals, "signals", name, "an object", {})
    where = f"signals, {name}"
    ends = (_read(given, where, n, "two numbers", None) for n in ("span", "raw"))
    span, raw = (None if e is None else (float(e[0]), float(e[1])) for e in ends)
    if (span is None) != (raw is None):
        raise CodeError(f"{where}: span and raw belong together; one of them is missing")
    return BlockSignal(_read(given, where, "name", "text", ""), _read(given, where, "unit", "text", ""), span, raw)


def _notes(data: Mapping[str, Any], y: BlockSignal, u: BlockSignal) -> tuple[str, ...]:
    made = [f"Designed from {data['data']} by {data['rule']}."] if {"data", "rule"} <= set(data) else []
    made += [f"{letter}: {signal}" for letter, signal in (("y", y), ("u", u)) if str(signal)]
    cautions = _read(data, "the regulator", "mind", "a list of text", [])
    return (*made, *(line for text in cautions for line in wrap(f"Mind: {text}", WIDTH)))


def regulator_from_json(data: Mapping[str, Any] | str | Path, *, name: str = "", compensated: bool = False) -> Block:
    """The controller that a design's JSON describes.

    data: the object, or the path of a file. name: of the program; default the JSON's ``name``, then the data's file,
    then pid. compensated: the integral keeps what rounding takes from it. Raises CodeError with what is wrong.

    >>> block = regulator_from_json({"form": "standard", "settings": {"K": 2, "Ti": 8, "h": 0.5}, "name": "Oven 3"})
    >>> block.name, block.settings()["Ti"]
    ('oven_3', 8.0)
    """
    where = "the regulator"
    if isinstance(data, str | Path):
        where = str(data)
        try:
            data = json.loads(Path(data).read_text(encoding="utf-8"))
        except OSError as error:
            raise CodeError(f"{where}: cannot be read: {error.strerror}") from None
        except ValueError as error:
            raise CodeError(f"{where}: no JSON: {error}") from None
    if not isinstance(data, Mapping):
        raise CodeError(f"{where}: an object with form and settings expected, found a {type(data).__name__}")
    form = _read(data, where, "form", "text")
    if form not in FORMS:
        raise CodeError(f"{where}: form = {form!r}; one of {', '.join(FORMS)} is expected")
    y, u = _signal(data, "y"), _signal(data, "u")
    start = _read(data, where, "start", "an object", None)
    rest = None
    if start is not None:
        rest = float(_read(start, "start", "u", "a number")), float(_read(start, "start", "y", "a number"))
    named = name or _read(data, where, "name", "text", "") or Path(str(data.get("data", "pid"))).stem
    try:
        return FORMS[form][0](
            data, name=identifier(named), y=y, u=u, rest=rest, notes=_notes(data, y, u), compensated=compensated
        )
    except (SettingError, PlacementError) as error:
        raise CodeError(f"{where}: {error}") from None
