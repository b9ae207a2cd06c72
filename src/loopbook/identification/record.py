"""A recorded experiment: time, input and output, as data loggers write them.

``read_csv`` finds delimiter, decimal sign, header, units and columns itself and says in ``assumptions`` what it took
for what, so that a report can show it. Time ends up in seconds from the first sample, strictly increasing.
"""

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

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
    "min": 60.0,
    "minutes": 60.0,
    "h": 3600.0,
}
FEWEST_SAMPLES = 10


class RecordError(ValueError):
    """The record cannot be used; the message says what is missing and how to mend it."""


@dataclass(frozen=True)
class Record:
    """One experiment.

    time: seconds from the first sample, strictly increasing, shape (n,). u, y: input and output in their own units,
    shape (n,). assumptions: what the reader took for what, one sentence each.
    """

    time: np.ndarray
    u: np.ndarray
    y: np.ndarray
    input_name: str = "u"
    output_name: str = "y"
    input_unit: str = ""
    output_unit: str = ""
    source: str = ""
    assumptions: tuple[str, ...] = field(default=())

    def __post_init__(self):
        arrays = [np.asarray(a, float) for a in (self.time, self.u, self.y)]
        if len({a.shape for a in arrays}) != 1 or arrays[0].ndim != 1:
            raise RecordError(f"time, input and output differ in length: {[a.shape for a in arrays]}")
        if len(arrays[0]) < FEWEST_SAMPLES:
            raise RecordError(f"the record has {len(arrays[0])} usable samples; at least {FEWEST_SAMPLES} are needed")
        if not all(np.isfinite(a).all() for a in arrays):
            raise RecordError("time, input and output must be finite; remove or fill the missing values")
        if (np.diff(arrays[0]) <= 0).any():
            raise RecordError("time must increase strictly")
        for name, a in zip(("time", "u", "y"), arrays, strict=True):
            object.__setattr__(self, name, a)

    @property
    def sampling(self) -> float:
        """The usual distance between samples (median), in seconds."""
        return float(np.median(np.diff(self.time)))


def _text(path: Path) -> str:
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise RecordError(f"there is no file {path}") from None
    except IsADirectoryError:
        raise RecordError(f"{path} is a folder; name a CSV file") from None
    for encoding in ("utf-8-sig", "cp1252"):
        try:
            return raw.decode(encoding)
        except UnicodeDecodeError:
            continue
    return raw.decode("latin-1")


def _delimiter(lines: list[str]) -> str:
    """The sign that splits the most lines into the same number, at least two, of fields."""
    best = (0, 0, "")
    for sign in (";", "\t", ",", "|"):
        widths = [len(row) for row in csv.reader(lines, delimiter=sign) if row]
        if widths:
            usual = max(set(widths), key=widths.count)
            if usual > 1:
                best = max(best, (widths.count(usual), 1 if sign in ";\t" else 0, sign))
    if not best[2]:
        blanks = [len(line.split()) for line in lines]
        if blanks and max(blanks) > 1:
            return " "
        raise RecordError("no columns found; write one sample per line with columns separated by , ; or tab")
    return best[2]


def _number(text: str, comma: bool) -> float:
    text = text.strip().replace("−", "-")
    try:
        return float(text.replace(".", "").replace(",", ".") if comma and "," in text else text)
    except ValueError:
        return float("nan")


def _seconds(texts: list[str]) -> np.ndarray | None:
    """Dates with a time of day as seconds from the first, or None where the texts are none."""
    import pandas as pd

    try:
        stamps = pd.to_datetime(pd.Series(texts), errors="raise", format="mixed")
    except (ValueError, TypeError, OverflowError):
        return None
    return (stamps - stamps.iloc[0]).dt.total_seconds().to_numpy()


def _name_and_unit(head: str) -> tuple[str, str]:
    """Split "Time [s]", "temp (°C)" or "u / V" into name and unit."""
    found = re.fullmatch(r"\s*(.*?)\s*(?:\[\s*(.*?)\s*\]|\(\s*(.*?)\s*\)|/\s*(\S+))?\s*", head)
    return found[1], next((g for g in found.groups()[1:] if g), "")


def _table(text: str) -> tuple[list[str], list[list[str]], str]:
    """Head and rows of the CSV text, and the delimiter."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith(("#", "%"))]
    if not lines:
        raise RecordError("the file is empty")
    delimiter = _delimiter(lines[:200])
    if delimiter == " ":
        rows = [line.split() for line in lines]
    else:
        rows = [row for row in csv.reader(lines, delimiter=delimiter, skipinitialspace=True) if any(row)]
    width = max(len(row) for row in rows[len(rows) // 2 :])
    rows = [row for row in rows if len(row) == width]
    numeric = [sum(_number(c, delimiter != ",") == _number(c, delimiter != ",") for c in row) for row in rows]
    first = next((i for i, n in enumerate(numeric) if n >= max(1, max(numeric) - 1)), 0)
    head = rows[first - 1] if first else [f"column {i + 1}" for i in range(width)]
    return [h.strip() for h in head], rows[first:], delimiter


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
    units in the head as ``[s]`` or ``(°C)``, an index column without a name, dates as time stamps, repeated and
    missing samples are understood. time, input, output: column names, where they should not be found by themselves.
    Raises RecordError with what is wrong and how to mend it.
    """
    path = Path(path)
    heads, rows, delimiter = _table(_text(path))
    comma = delimiter != "," and not any(re.search(r"\d\.\d", c) for row in rows[:50] for c in row)
    names, units = zip(*(_name_and_unit(h) for h in heads), strict=True)
    names, units = list(names), list(units)
    data = [np.array([_number(row[i], comma) for row in rows]) for i in range(len(names))]
    stamped = None
    for i, column in enumerate(data):
        if np.isnan(column).mean() > 0.5 and (seconds := _seconds([row[i] for row in rows])) is not None:
            data[i], units[i], stamped = seconds, "s", i
    t, u, y, notes = _columns(names, data, time, input, output)
    notes.insert(0, f"Columns are separated by {delimiter!r}, decimals by {',' if comma else '.'!r}.")
    if stamped == t:
        notes.append(f"Time stamps of {names[t]!r} were turned into seconds from the first sample.")
    scale = TIME_UNITS.get(units[t].lower().strip("."))
    if units[t] and scale is None:
        raise RecordError(f"time is in {units[t]!r}; known units are {', '.join(TIME_UNITS)}")
    if not units[t]:
        notes.append("Time has no unit; seconds were assumed.")
    clock, values, more = _cleaned(data[t] * (scale or 1.0), data[u], data[y])
    described = (names[u] or "u", names[y] or "y", units[u], units[y])
    return Record(clock, *values, *described, path.name, tuple(notes + more))


def _cleaned(clock: np.ndarray, u: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, list[np.ndarray], list[str]]:
    """Drop what is missing, order by time, join samples of the same time, begin at zero; say so."""
    notes = []
    whole = np.isfinite(clock) & np.isfinite(u) & np.isfinite(y)
    if not whole.all():
        notes.append(f"{(~whole).sum()} of {len(whole)} samples lack a value and were left out.")
    clock, u, y = clock[whole], u[whole], y[whole]
    if len(clock) < FEWEST_SAMPLES:
        raise RecordError(
            f"only {len(clock)} samples have time, input and output; at least {FEWEST_SAMPLES} are needed"
        )
    if (np.diff(clock) < 0).any():
        order = np.argsort(clock, kind="stable")
        clock, u, y = clock[order], u[order], y[order]
        notes.append("Samples were not in the order of time and were sorted.")
    unique, where = np.unique(clock, return_inverse=True)
    if len(unique) < len(clock):
        counts = np.bincount(where)
        u, y = (np.bincount(where, a) / counts for a in (u, y))
        notes.append(f"{len(clock) - len(unique)} samples share a time stamp with another; their mean was taken.")
    gaps = np.diff(unique)
    if len(gaps) and gaps.max() > 5 * np.median(gaps):
        notes.append(f"The longest gap between samples is {gaps.max():.3g} s (usual: {np.median(gaps):.3g} s).")
    if unique[0] != 0:
        notes.append(f"Time starts at {unique[0]:.6g} s and is counted from there.")
    return unique - unique[0], [u, y], notes
