"""Time stamps as loggers write them: dates, times of day, both in one column or in two, past midnight, as seconds."""

import re
import warnings
from collections.abc import Sequence
from datetime import datetime, timedelta

import numpy as np

TIME_OF_DAY = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,](\d+))?)?\s*([AaPp])?\.?[Mm]?\.?")
PARTED = re.compile(r"(\d{1,4})[./,\- ](\d{1,2})[./,\- ](\d{1,4})")
STAMP = re.compile(PARTED.pattern + r"(?:[ T,;]+(.+))?")
COMPACT = re.compile(r"((?:19|20)\d\d)(\d\d)(\d\d)[T ]?([01]\d|2[0-3])([0-5]\d)([0-5]\d)(\d{3})?")
"""A date and a time of day without signs between: 20260301100530."""
ZONE = re.compile(r"\s*(?:Z|[+-]\d{2}:?\d{2}|UTC|GMT)$")
DAY = 86400.0


def _day_seconds(text: str) -> float | None:
    """Seconds since midnight, None where the text is no time of day."""
    found = TIME_OF_DAY.fullmatch(text.strip())
    if not found:
        return None
    hours, minutes, seconds, part, half = found.groups()
    hour = int(hours) % 12 + (12 if half in "Pp" else 0) if half else int(hours)
    return hour * 3600.0 + int(minutes) * 60.0 + float(f"{seconds or 0}.{part or 0}")


def _date(text: str, order: str) -> datetime | None:
    """A day; order: of the parts where the year is not first, "dm" or "md"."""
    found = PARTED.fullmatch(text.strip())
    if not found:
        return None
    a, b, c = (int(part) for part in found.groups())
    if len(found[1]) == 4:
        year, month, day = a, b, c
    else:
        year = c + 2000 if c < 100 else c
        day, month = (a, b) if order == "dm" else (b, a)
    try:
        return datetime(year, month, day)
    except ValueError:
        return None


def _stamp(text: str, order: str) -> float | None:
    """Seconds since the year 1 of a date with or without a time of day."""
    text = ZONE.sub("", text.strip().strip('"'))
    text = COMPACT.sub(lambda m: f"{m[1]}-{m[2]}-{m[3]} {m[4]}:{m[5]}:{m[6]}.{m[7] or 0}", text)
    found = STAMP.fullmatch(text)
    if not found:
        return None
    day = _date(text[: found.end(3)], order)
    clock = _day_seconds(found[4]) if found[4] else 0.0
    if day is None or clock is None:
        return None
    return (day - datetime(1, 1, 1)) / timedelta(seconds=1) + clock


def times_of_day(texts: Sequence[str]) -> tuple[np.ndarray, str] | None:
    """(seconds from the first midnight, how they were read) of a column of times of day; NaN where a cell is blank.

    Two parts only ("10:15") are hours and minutes, unless one ever exceeds 23 or the column starts at 00:00, as a
    stop-watch does: then minutes and seconds. None where the column is none.
    """
    values = [_day_seconds(text) if text.strip() else np.nan for text in texts]
    if any(v is None for v in values) or not np.isfinite(np.array(values, float)).any():
        return None
    seconds, round_, read = np.array(values, float), DAY, "times of day"
    known = np.flatnonzero(np.isfinite(seconds))
    if all(text.count(":") == 1 for text in texts if text.strip()):
        read = "hours:minutes"
        if seconds[known].max() >= DAY or seconds[known[0]] == 0:
            seconds, round_, read = seconds / 60, 3600.0, "minutes:seconds"
    back = np.diff(seconds[known]) < -round_ / 2
    rounds = np.zeros(len(seconds))
    rounds[known[1:]] = np.cumsum(back)
    past = " past midnight" if round_ == DAY else " past the full hour"
    return seconds + rounds * round_, read + past * bool(back.any())


def dates(texts: Sequence[str]) -> np.ndarray | None:
    """Seconds (from a day long ago) of a column of dates; the order of day and month that makes the record shorter.

    NaN where a cell is blank, None where the column holds anything else.
    """
    found = []
    for order in ("dm", "md"):
        values = [_stamp(text, order) if text.strip() else np.nan for text in texts]
        if all(v is not None for v in values) and np.isfinite(np.array(values, float)).any():
            found.append(np.array(values, float))
    return min(found, key=_length, default=None)


def _length(seconds: np.ndarray) -> tuple[bool, float]:
    known = seconds[np.isfinite(seconds)]
    return bool((np.diff(known) < 0).any()), float(np.ptp(known))


def other_stamps(texts: Sequence[str]) -> np.ndarray | None:
    """Dates in words ("3 Mar 2026 10:00:01"), read by pandas; None where they are none."""
    if not any(c.isdigit() for c in texts[0]) or len(texts[0]) < 6 or not re.search(r"[A-Za-z:]", texts[0]):
        return None
    import pandas as pd

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stamps = pd.to_datetime(pd.Series(list(texts)), errors="raise", format="mixed")
    except (ValueError, TypeError, OverflowError):
        return None
    return (stamps - stamps.iloc[0]).dt.total_seconds().to_numpy()
