"""A recorded experiment from a logger's file: which column is what, time in seconds, samples cleaned.

Everything that had to be assumed is said in the record's ``assumptions``, so that a report can show it.
"""

import re
from pathlib import Path

import numpy as np

from loopbook.records.cells import cells_of, name_and_unit, text_of
from loopbook.records.record import FEWEST_SAMPLES, Record, RecordError

TIME_NAMES = r"t|time|tid|czas|zeit|temps|timestamp|datetime|date|elapsed|seconds?|sec|minutes?"
INPUT_NAMES = (
    r"u\d*|input|in|mv|op|co|q\d*|heater\d*|power|valve|pump|pwm|duty|control|styrsignal|sterowanie|drive|voltage"
)
OUTPUT_NAMES = (
    r"y\d*|output|out|pv|measured?|measurement|temp\w*|t\d+|level|speed|pressure|flow|position|ph"
    r"|ärvärde|wyjscie|wyjście"
)
TIME_UNITS = {
    "s": 1.0,
    "sec": 1.0,
    "second": 1.0,
    "seconds": 1.0,
    "ms": 1e-3,
    "us": 1e-6,
    "µs": 1e-6,
    "min": 60.0,
    "minute": 60.0,
    "minutes": 60.0,
    "h": 3600.0,
    "hour": 3600.0,
    "hours": 3600.0,
}
SINCE_1970 = ((1e17, 1e-9, "nanoseconds"), (1e14, 1e-6, "microseconds"), (1e11, 1e-3, "milliseconds"))


def _seconds(texts: list[str]) -> np.ndarray | None:
    """Dates with a time of day as seconds from the first, or None where the texts are none.

    Of 01/02/2026 as a day in January or in February the one is taken that makes the record shorter.
    """
    import pandas as pd

    orders = (False, True) if re.match(r"\d{1,2}[./-]\d{1,2}[./-]\d{2,4}\b", texts[0].strip()) else (False,)
    found = []
    for dayfirst in orders:
        try:
            stamps = pd.to_datetime(pd.Series(texts), errors="raise", format="mixed", dayfirst=dayfirst)
        except (ValueError, TypeError, OverflowError):
            continue
        found.append((stamps - stamps.iloc[0]).dt.total_seconds().to_numpy())
    return min(found, key=np.ptp, default=None)


def _pick(names: list[str], wanted: str | None, pattern: str, role: str, taken: set[int]) -> list[int]:
    """Columns that may play a role: the one named by the user, or those whose name is usual for it."""
    if wanted is not None:
        exact = [i for i, n in enumerate(names) if n.lower() == wanted.lower()]
        if not exact:
            raise RecordError(f"there is no column {wanted!r} for the {role}; the columns are {', '.join(names)}")
        return exact[:1]
    return [i for i, n in enumerate(names) if i not in taken and re.fullmatch(pattern, n, re.IGNORECASE)]


def _levels(column: np.ndarray) -> int:
    return len(np.unique(column[np.isfinite(column)]))


def _columns(names, data, time, input, output) -> tuple[int, int, int, list[str]]:
    """Which column is time, input and output, and what was assumed in choosing them."""
    notes: list[str] = []
    steady = [i for i, c in enumerate(data) if np.isfinite(c).sum() > 1]
    rising = [i for i in steady if (np.diff(data[i][np.isfinite(data[i])]) >= 0).all() and _levels(data[i]) > 2]
    named = _pick(names, time, TIME_NAMES, "time", set())
    spoken_for = f"(?:{INPUT_NAMES}|{OUTPUT_NAMES}|unnamed.*)?"
    named_otherwise = [i for i in rising if re.fullmatch(spoken_for, names[i], re.IGNORECASE)]
    unnamed = [i for i in named_otherwise if not names[i]]
    candidates = named or [i for i in rising if i not in named_otherwise] or unnamed
    if not candidates:
        raise RecordError(f"no time column found among {', '.join(names)}; name it with --time")
    t = candidates[0]
    if not named:
        notes.append(f"Time was taken from the column {names[t] or t + 1!r}, the one that only grows.")
    taken = {t} | {i for i in range(len(names)) if not names[i] or names[i].lower().startswith("unnamed")}
    if output is not None:
        taken |= set(_pick(names, output, OUTPUT_NAMES, "output", taken))
    inputs = _pick(names, input, INPUT_NAMES, "input", taken)
    free = [i for i in steady if i not in taken and 1 < _levels(data[i]) <= max(20, len(data[i]) // 20)]
    u_all = [i for i in inputs if _levels(data[i]) > 1] or inputs or sorted(free, key=lambda i: _levels(data[i]))[:1]
    if not u_all:
        raise RecordError(f"no input column found among {', '.join(names)}; name it with --input")
    u = u_all[0]
    outputs = [i for i in _pick(names, output, OUTPUT_NAMES, "output", {t, u}) if i != u]
    y_all = outputs or [i for i in steady if i not in taken | {u} and _levels(data[i]) > 1]
    if not y_all:
        raise RecordError(f"no output column found among {', '.join(names)}; name it with --output")
    y = y_all[0]
    for role, chosen, found, option in (("Input", u, u_all, "--input"), ("Output", y, y_all, "--output")):
        others = [names[i] for i in found if i != chosen]
        more = f"; {', '.join(others)} could be it too ({option})" if others else ""
        notes.append(f"{role}: column {names[chosen]!r}{more}.")
    return t, u, y, notes


def read_csv(path: str | Path, time: str | None = None, input: str | None = None, output: str | None = None) -> Record:
    """Read one experiment from a logger's CSV file.

    path: text with one sample per line; comma, semicolon, tab or blanks between the columns, decimal point or comma,
    units in the head as ``[s]`` or ``(°C)`` or in a line below it, an index column without a name, dates as time
    stamps, repeated and missing samples are understood. time, input, output: column names, where they should not be
    found by themselves. Raises RecordError with what is wrong and how to mend it.
    """
    path = Path(path)
    cells = cells_of(text_of(path), set(TIME_UNITS))
    names, units = (list(part) for part in zip(*(name_and_unit(h) for h in cells.heads), strict=True))
    data = [cells.numbers(i) for i in range(len(names))]
    stamped = None
    for i, column in enumerate(data):
        if np.isnan(column).mean() > 0.5 and (seconds := _seconds(cells.column(i))) is not None:
            data[i], units[i], stamped = seconds, "s", i
    t, u, y, notes = _columns(names, data, time, input, output)
    decimals = f", decimals by {cells.decimal!r}" if cells.decimal else ""
    notes.insert(0, f"Columns are separated by {cells.delimiter!r}{decimals}.")
    if stamped == t:
        notes.append(f"Time stamps of {names[t]!r} were turned into seconds from the first sample.")
    scale, said = _scale(units[t], data[t])
    clock, values, held, more = _cleaned(data[t] * scale, data[u], data[y])
    described = (names[u] or "u", names[y] or "y", units[u], units[y])
    return Record(clock, *values, *described, path.name, tuple(notes + said + more), held)


def _scale(unit: str, clock: np.ndarray) -> tuple[float, list[str]]:
    """Seconds in the column's unit of time, and what was assumed."""
    if unit:
        scale = TIME_UNITS.get(unit.lower().strip("."))
        if scale is None:
            raise RecordError(f"time is in {unit!r}; known units are {', '.join(TIME_UNITS)}")
        return scale, []
    start = np.nanmin(clock)
    for least, scale, name in SINCE_1970:
        if start > least:
            return scale, [f"Time was taken for {name} since 1970."]
    return 1.0, ["Time has no unit; seconds were assumed."]


def _cleaned(clock: np.ndarray, u: np.ndarray, y: np.ndarray):
    """Drop what is missing, order by time, join samples of the same time, begin at zero; say so.

    Returns time, [u, y], the input with its own times where the output misses some, and what was done.
    """
    notes = []
    known = np.isfinite(clock) & np.isfinite(u)
    whole = known & np.isfinite(y)
    if not whole.all():
        notes.append(f"{(~whole).sum()} of {len(whole)} samples lack a value and were left out.")
    if whole.sum() < FEWEST_SAMPLES:
        raise RecordError(
            f"only {whole.sum()} samples have time, input and output; at least {FEWEST_SAMPLES} are needed"
        )
    if (np.diff(clock[whole]) < 0).any():
        notes.append("Samples were not in the order of time and were sorted.")
    time, both = _joined(clock[whole], [u[whole], y[whole]])
    if len(time) < whole.sum():
        notes.append(f"{whole.sum() - len(time)} samples share a time stamp with another; their mean was taken.")
    gaps = np.diff(time)
    if len(gaps) and gaps.max() > 5 * np.median(gaps):
        notes.append(f"The longest gap between samples is {gaps.max():.3g} s (usual: {np.median(gaps):.3g} s).")
    if time[0] != 0:
        notes.append(f"Time starts at {time[0]:.6g} s and is counted from there.")
    held = None
    if known.sum() > whole.sum():
        since, (input,) = _joined(clock[known], [u[known]])
        held = (since[since >= time[0]] - time[0], input[since >= time[0]])
    return time - time[0], both, held, notes


def _joined(clock: np.ndarray, columns: list[np.ndarray]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Ordered by time, with the mean of what shares one."""
    time, where = np.unique(clock, return_inverse=True)
    counts = np.bincount(where)
    return time, [np.bincount(where, column) / counts for column in columns]
