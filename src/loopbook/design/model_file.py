"""A process model from a TOML file, its template, and parameters fixed in a line of text."""

import difflib
import math
import re
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from loopbook.design.model import Model, ModelError
from loopbook.experiments.data import DataError, FrequencyData
from loopbook.records.units import TIME_UNITS

TEMPLATE = """\
# A process for loopbook design. Remove what does not apply; times are in seconds.
[process]
gain = 2.0                    # output per input at rest; for an integrating process output per input and second
time_constants = [10.0, 4.0]  # s, one or more; a single number will do; leave it out for a pure integrator
delay = 3.0                   # s, the dead time; 0 for none
integrating = false           # true: the output keeps rising while the input is held (a level, a position)

# [experiment]                # from a relay or oscillation test, if there was one
# K180 = 0.21                 # output per input: the process's gain where its phase is -180 degrees
# T180 = 22.0                 # s, the period of that oscillation
"""
ALIASES = {
    "dead_time": "delay",
    "deadtime": "delay",
    "L": "delay",
    "time_delay": "delay",
    "lag": "time_constants",
    "tau": "time_constants",
    "T": "time_constants",
    "K": "gain",
    "Kp": "gain",
    "Kv": "gain",
}
"""What people write instead; `time_constant` is accepted as it is."""
FIXED = {
    **dict.fromkeys(("K", "Kp", "Kv", "gain"), "K"),
    **dict.fromkeys(("T", "time_constant"), "T"),
    "T1": "T1",
    "T2": "T2",
    **dict.fromkeys(("L", "delay", "dead_time", "T0"), "L"),
}

LEAST, MOST = 1e-12, 1e12
"""The smallest and the largest number, apart from zero, that a description of a process may hold."""


def read_model(path: str | Path) -> Model:
    """Read a process from a TOML file, see `TEMPLATE`.

    A time constant may be a number or a list of numbers, named time_constants or time_constant. Raises ModelError with
    the entry that is missing, unknown or of the wrong kind.
    """
    path = Path(path)
    try:
        content = tomllib.loads(path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n"))
    except FileNotFoundError:
        raise ModelError(f"there is no file {path}") from None
    except UnicodeDecodeError as error:
        raise ModelError(f"{path.name}: not UTF-8 at byte {error.start}; save it as UTF-8") from None
    except RecursionError:
        raise ModelError(f"{path.name}: nested too deeply") from None
    except (OSError, ValueError) as error:
        raise ModelError(f"{path.name}: {str(error).partition(';')[0]}") from None
    for table in ("process", "experiment"):
        if not isinstance(content.get(table, {}), dict):
            raise ModelError(f"{path.name}: {table} = {content[table]!r}: a table [{table}] is expected")
    _only(path, "file", content, {"process", "experiment"})
    entries = content.get("process", {})
    if not isinstance(entries, dict) or not entries:
        raise ModelError(
            f"{path.name} has no [process] with gain, time_constants and delay; see loopbook design --template"
        )
    entries = dict(entries)
    if "time_constant" in entries and "time_constants" not in entries:
        entries["time_constants"] = entries.pop("time_constant")
    _only(path, "process", entries, {"gain", "time_constants", "delay", "integrating"})
    missing = {"gain", "delay"} - set(entries)
    if missing:
        raise ModelError(f"{path.name}: [process] lacks {', '.join(sorted(missing))}; see loopbook design --template")
    for name in ("gain", "delay"):
        _number(path, name, entries[name])
    lags = entries.get("time_constants", [])
    lags = lags if isinstance(lags, list) else [lags]
    for T in lags:
        _number(path, "time_constants", T)
    integrating = entries.get("integrating", False)
    if not isinstance(integrating, bool):
        raise ModelError(f"{path.name}: integrating = {integrating!r}: true or false is expected")
    measured = content.get("experiment")
    frequency = None
    if measured is not None:
        _only(path, "experiment", measured, {"K180", "T180"})
        try:
            frequency = FrequencyData(float(measured["K180"]), float(measured["T180"]))
        except (KeyError, TypeError, ValueError, DataError) as error:
            raise ModelError(f"{path.name}: [experiment] needs K180 and T180, positive numbers ({error})") from None
    try:
        return Model(
            float(entries["gain"]), tuple(lags), float(entries["delay"]), integrating, frequency, None, path.name
        )
    except ModelError as error:
        raise ModelError(f"{path.name}: {error}") from None


def _only(path: Path, table: str, entries: Any, known: set[str]) -> None:
    where = f"{path.name}: [{table}]" if table != "file" else path.name
    if not isinstance(entries, dict):
        raise ModelError(f"{where} is no table")
    for name in sorted(set(entries) - known):
        meant = ALIASES.get(name)
        near = [meant] if meant in known else difflib.get_close_matches(name, known, n=1)
        hint = f"; did you mean {near[0]}?" if near else f"; known: {', '.join(sorted(known))}"
        raise ModelError(f"{where} has no entry {name!r}{hint}")


def _number(path: Path, name: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ModelError(f"{path.name}: {name} = {value!r}: a number is expected")
    if value and not LEAST <= abs(value) <= MOST:
        shown = f"{value:g}" if isinstance(value, float) else f"{str(value)[:20]}…"
        raise ModelError(f"{path.name}: {name} = {shown}: a number between {LEAST:g} and {MOST:g} is expected")


def seconds(text: str) -> float:
    """A time with or without a unit, in seconds. Raises ModelError where it is none.

    >>> seconds("20s"), seconds("1.5 min"), seconds("0.2")
    (20.0, 90.0, 0.2)
    """
    found = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-zµ]*)\s*", text)
    try:
        number = float(found[1]) if found else float("nan")
    except ValueError:
        number = float("nan")
    if not found or math.isnan(number) or (found[2] and found[2] not in TIME_UNITS):
        raise ModelError(f"{text!r} is no time: write 20, 20s, 1.5min or 300ms")
    return number * TIME_UNITS.get(found[2], 1.0)


def read_fixed(text: str) -> dict[str, float]:
    """Parameters fixed by the user: "K=2, T=30" as {"K": 2.0, "T": 30.0}; times may have a unit. Raises ModelError.

    >>> read_fixed("K = -2; T1=1min, T2=5, dead_time=300ms")
    {'K': -2.0, 'T1': 60.0, 'T2': 5.0, 'L': 0.3}
    """
    found: dict[str, float] = {}
    for part in (p for p in re.split(r"[,;]", text) if p.strip()):
        name, sign, value = (piece.strip() for piece in part.partition("="))
        if not sign or name not in FIXED:
            raise ModelError(
                f"model: {part.strip()!r}: write K=2, T=30, L=5 (or T1 and T2); any of them may be left out"
            )
        if FIXED[name] in found:
            raise ModelError(f"model: {name} is given twice")
        if FIXED[name] == "K":
            try:
                found["K"] = float(value)
            except ValueError:
                raise ModelError(f"model: K = {value!r}: a number is expected") from None
        else:
            found[FIXED[name]] = seconds(value)
        if not (abs(found[FIXED[name]]) < float("inf")) or (FIXED[name] != "L" and found[FIXED[name]] == 0):
            raise ModelError(f"model: {name} = {value}: a finite number other than zero is expected")
        if FIXED[name] != "K" and found[FIXED[name]] < 0:
            raise ModelError(f"model: {name} = {value}: a time is not negative")
    if "T" in found and {"T1", "T2"} & set(found):
        raise ModelError("model: give T of one lag, or T1 and T2 of two, not both")
    return found


def with_fixed(model: Model, fixed: Mapping[str, float]) -> Model:
    """A given model with some parameters replaced."""
    lags = list(model.lags)
    for place, names in enumerate((("T", "T1"), ("T2",))):
        for name in names:
            if name in fixed:
                lags[place:] = [fixed[name], *lags[place + 1 :]]
    source = f"{model.source}, with {', '.join(f'{k} = {v:g}' for k, v in fixed.items())}"
    gain, delay = fixed.get("K", model.gain), fixed.get("L", model.delay)
    return replace(model, gain=gain, lags=tuple(lags), delay=delay, source=source)


def as_toml(fixed: Mapping[str, float]) -> str:
    """A model file from parameters alone. Raises ModelError where the gain or all times are missing."""
    if "K" not in fixed or not set(fixed) & {"T", "T1", "T2"}:
        raise ModelError("a model without a record needs K and T at least: --model 'K=2, T=30, L=5'")
    lags = [fixed[name] for name in ("T", "T1", "T2") if name in fixed]
    return f"[process]\ngain = {fixed['K']!r}\ntime_constants = {lags!r}\ndelay = {fixed.get('L', 0.0)!r}\n"
