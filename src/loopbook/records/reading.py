"""A recorded experiment from a logger's file: which column is what, time in seconds, samples cleaned.

Everything that had to be assumed is said in the record's ``assumptions``, so that a report can show it.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from loopbook.records import clock
from loopbook.records.cells import Cells, cells_of, text_of
from loopbook.records.columns import choose, find_time
from loopbook.records.faults import find_faults
from loopbook.records.names import Name, Role, read_name
from loopbook.records.record import FEWEST_SAMPLES, Other, Record, RecordError
from loopbook.records.sheets import is_sheet, sheet_cells
from loopbook.records.units import TIME_UNITS

SINCE_1970 = ((1e17, 1e-9, "nanoseconds"), (1e14, 1e-6, "microseconds"), (1e11, 1e-3, "milliseconds"))
LONGEST_SECOND = 3600.0  # s between samples of a time without a unit: longer ones are hardly seconds


def read_record(
    path: str | Path,
    time: str | None = None,
    input: str | None = None,
    output: str | None = None,
    interval: float = 0.0,
) -> Record:
    """Read one experiment from a logger's file: CSV, .xlsx or Parquet.

    path: one sample per line; in a text file comma, semicolon, tab or blanks between the columns, decimal point or
    comma. Units in the head as ``[s]`` or ``(°C)``, in the name (``time_ms``) or in a line below it, row counters,
    dates as time stamps in one column or two, times of day past midnight, words such as on and off, repeated and
    missing samples are understood. time, input, output: column names, where they should not be found by themselves.
    interval [s]: between the samples of a record without a time column; 0 where it has one. Raises RecordError with
    what is wrong and how to mend it.

    >>> import tempfile
    >>> from loopbook.records.reading import read_record
    >>> from pathlib import Path
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "step.csv"
    ...     rows = [f"{k},{int(k > 1)},{min(k, 6)}" for k in range(12)]
    ...     _ = file.write_text("\\n".join(["t,u,y", *rows]))
    ...     len(read_record(file).time)
    12
    """
    path = Path(path)
    cells = sheet_cells(path) if is_sheet(path) else cells_of(text_of(path), set(TIME_UNITS))
    names = [read_name(head) for head in cells.heads]
    data = [cells.numbers(i) for i in range(len(names))]
    stamps, aside, notes = _stamps(cells, names, data)
    for i, seconds in stamps.items():
        data[i] = seconds
    t = _time(names, data, set(stamps), time or None, interval)
    if t is not None and not time and not names[t].says(Role.TIME):
        notes.append(f"Time was taken from the column {names[t].text or t + 1!r}, the one that only grows.")
    columns = choose(names, data, t, aside | set(stamps), input or None, output or None)
    u, y = columns.input, columns.output
    said = [_how_cut(cells), *cells.notes]
    if t is None:
        samples, scale, unit, more = np.arange(len(data[u])) * interval, 1.0, "s", []
        said.append(f"There is no time column: the samples were taken to be {interval:g} s apart.")
    elif t in stamps:
        samples, scale, unit, more = data[t], 1.0, _read_as(notes), notes
    else:
        samples, (scale, unit, more) = data[t], _scale(names[t], data[t])
        more = [*notes, *more]
    said += list(columns.notes)
    if np.isfinite(data[u]).mean() < 0.5:
        data[u] = _held(data[u])
        said.append(f"'{names[u].text}' is written only where it changes; it was held in between.")
    for i in (u, y):
        if cells.is_state(i):
            said.append(f"'{names[i].text}' holds words: on, open, yes and the like were read as 1, the others as 0.")
    aimed = [data[columns.setpoint]] if columns.setpoint is not None else []
    read = _cleaned(samples * scale, [data[u], data[y], *[data[i] for i in columns.others], *aimed])
    others = tuple(Other(names[i].text, column) for i, column in zip(columns.others, read.values[2:], strict=False))
    faults = find_faults(read.time, read.values[0], read.values[1])
    described = (names[u].text or "u", names[y].text or "y", names[u].unit, names[y].unit)
    assumptions = (*said, *more, *read.notes, *faults.notes)
    return Record(
        *(read.time, read.values[0], read.values[1], *described, path.name, assumptions, read.held),
        others=others,
        left_out=faults.left_out,
        cut=faults.cut,
        time_unit=unit,
        setpoint=read.values[-1] if aimed else None,
        faults=faults.notes,
    )


def _how_cut(cells: Cells) -> str:
    if cells.delimiter == "cells":
        return "The table was read from the file's cells."
    decimals = f", decimals by {cells.decimal!r}" if cells.decimal else ""
    return f"Columns are separated by {cells.delimiter!r}{decimals}."


def _time(
    names: list[Name], data: list[np.ndarray], stamps: set[int], wanted: str | None, interval: float
) -> int | None:
    """The column of the time, None where the interval stands for it."""
    t = None if interval and not wanted else find_time(names, data, stamps, wanted)
    if t is None and not interval:
        listed = ", ".join(n.text for n in names if n.text)
        raise RecordError(
            f"no time column found among {listed}; name it with --time, or say how far apart the samples are with "
            "--interval, in seconds (--interval 0.1)"
        )
    return t


def _stamps(
    cells: Cells, names: list[Name], data: list[np.ndarray]
) -> tuple[dict[int, np.ndarray], set[int], list[str]]:
    """Columns of time stamps as seconds; a column of dates and one of times of day are joined in the second.

    Returns the seconds by column, the columns that are no signals, and what was done.
    """
    texts = {i: cells.column(i) for i, column in enumerate(data) if np.isnan(column).mean() > 0.5}
    compact = {i: column for i in range(len(data)) if all(map(clock.COMPACT.fullmatch, column := cells.column(i)))}
    texts |= compact
    clocks = {i: found for i, column in texts.items() if (found := clock.times_of_day(column)) is not None}
    days = {i: date for i, column in texts.items() if i not in clocks and (date := clock.dates(column)) is not None}
    for i, column in texts.items():
        if i not in clocks and i not in days and (other := clock.other_stamps(column)) is not None:
            days[i] = other
    if clocks and days and (joined := _joined_stamps(cells, min(days), min(clocks))) is not None:
        d, c = min(days), min(clocks)
        note = f"Date '{names[d].text}' and time '{names[c].text}' were joined and turned into seconds."
        return {c: joined}, _no_signals(texts, data) | set(days) | set(clocks), [note]
    notes, stamps = [], {}
    for i, (seconds, read) in clocks.items():
        stamps[i] = seconds - seconds[np.isfinite(seconds)][0]
        notes.append(f"'{names[i].text}' holds {read}; they were turned into seconds from the first sample.")
    for i, seconds in days.items():
        stamps[i] = seconds - seconds[np.isfinite(seconds)][0]
        notes.append(f"Time stamps of '{names[i].text}' were turned into seconds from the first sample.")
    return stamps, _no_signals(texts, data), notes


def _read_as(notes: list[str]) -> str:
    """The time's unit in the line that every run prints: hours:minutes and minutes:seconds are worth saying."""
    return next((form for form in ("hours:minutes", "minutes:seconds") for n in notes if form in n), "time stamps")


def _no_signals(texts: dict[int, list[str]], data: list[np.ndarray]) -> set[int]:
    """The columns that hold no numbers."""
    return {i for i in texts if not np.isfinite(data[i]).any()}


def _joined_stamps(cells: Cells, date: int, time: int) -> np.ndarray | None:
    both = [f"{d} {t}" if d and t else "" for d, t in zip(cells.column(date), cells.column(time), strict=True)]
    seconds = clock.dates(both)
    return None if seconds is None else seconds - seconds[np.isfinite(seconds)][0]


def _scale(name: Name, samples: np.ndarray) -> tuple[float, str, list[str]]:
    """Seconds in the column's unit of time, the unit, and what was assumed."""
    if name.unit:
        scale = TIME_UNITS.get(name.unit.lower().strip("."))
        if scale is None:
            raise RecordError(f"time is in {name.unit!r}; known units are s, ms, us, ns, min, h, d")
        return scale, name.unit, []
    if set(name.words) & {"millis", "ms"}:
        return 1e-3, "ms", []
    if set(name.words) & {"micros", "us"}:
        return 1e-6, "us", []
    start = np.nanmin(samples)
    for least, scale, unit in SINCE_1970:
        if start > least:
            return scale, unit, [f"Time was taken for {unit} since 1970."]
    gap = float(np.nanmedian(np.diff(samples)))
    whole = bool((samples[np.isfinite(samples)] == np.round(samples[np.isfinite(samples)])).all())
    doubt = f" The samples are then {gap:g} s apart: if they are milliseconds, write {name.text}_ms in the head."
    return 1.0, "s", ["Time has no unit; seconds were assumed." + (doubt if whole and gap >= 10 else "")]


@dataclass(frozen=True)
class _Read:
    """Cleaned columns: time from zero, values, the input with its own times where the output misses some, notes."""

    time: np.ndarray
    values: list[np.ndarray]
    held: tuple[np.ndarray, np.ndarray] | None
    notes: list[str]


def _cleaned(samples: np.ndarray, columns: list[np.ndarray]) -> _Read:
    """Drop what is missing, order by time, join samples of the same time, begin at zero; say so.

    columns: input, output, and further inputs, whose missing values are held.
    """
    notes = []
    u, y, *others = columns
    others = [_held(column) for column in others]
    known = np.isfinite(samples) & np.isfinite(u)
    whole = known & np.isfinite(y)
    if not whole.all():
        notes.append(f"{(~whole).sum()} of {len(whole)} samples lack a value and were left out.")
    if whole.sum() < FEWEST_SAMPLES:
        raise RecordError(
            f"only {whole.sum()} samples have time, input and output; at least {FEWEST_SAMPLES} are needed"
        )
    if (np.diff(samples[whole]) < 0).any():
        notes.append("Samples were not in the order of time and were sorted.")
    time, both = _joined(samples[whole], [u[whole], y[whole], *[o[whole] for o in others]])
    if len(time) < whole.sum():
        notes.append(f"{whole.sum() - len(time)} samples share a time stamp with another; their mean was taken.")
    gaps = np.diff(time)
    if len(gaps) and gaps.max() > 5 * np.median(gaps):
        notes.append(f"The longest gap between samples is {gaps.max():.3g} s (usual: {np.median(gaps):.3g} s).")
    if time[0] != 0:
        notes.append(f"Time starts at {time[0]:.6g} s and is counted from there.")
    held = None
    if known.sum() > whole.sum():
        since, (input,) = _joined(samples[known], [u[known]])
        held = (since[since >= time[0]] - time[0], input[since >= time[0]])
    return _Read(time - time[0], both, held, notes)


def _held(column: np.ndarray) -> np.ndarray:
    """Missing values hold the last one known."""
    known = np.isfinite(column)
    last = np.maximum.accumulate(np.where(known, np.arange(len(column)), 0))
    filled = column[last]
    return np.where(np.isfinite(filled), filled, column[known][0] if known.any() else 0.0)


def _joined(clock: np.ndarray, columns: list[np.ndarray]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Ordered by time, with the mean of what shares one."""
    time, where = np.unique(clock, return_inverse=True)
    counts = np.bincount(where)
    return time, [np.bincount(where, column) / counts for column in columns]
