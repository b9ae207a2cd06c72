"""Time stamps as loggers write them: dates, times of day, both in one column or in two, past midnight, as seconds."""

import re
import warnings
from collections.abc import Sequence
from datetime import datetime, timedelta

import numpy as np

TIME_OF_DAY = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,](\d+))?)?\s*([AaPp])?\.?[Mm]?\.?")
PARTED = re.compile(r"(\d{1,4})[./,\- ](\d{1,2})[./,\- ](\d{1,4})")
STAMP = re.compile(PARTED.pattern + r"(?:[ T,;]+(.+))?")
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
    found = STAMP.fullmatch(text)
    if not found:
        return None
    day = _date(text[: found.end(3)], order)
    clock = _day_seconds(found[4]) if found[4] else 0.0
    if day is None or clock is None:
        return None
    return (day - datetime(1, 1, 1)) / timedelta(seconds=1) + clock


def times_of_day(texts: Sequence[str]) -> tuple[np.ndarray, bool] | None:
    """(seconds from the first midnight, midnight was passed) of a column of times of day; NaN where a cell is blank.

    Two parts only ("10:15") are hours and minutes, unless the first ever exceeds 23. None where the column is none.
    """
    values = [_day_seconds(text) if text.strip() else np.nan for text in texts]
    if any(v is None for v in values) or not np.isfinite(np.array(values, float)).any():
        return None
    seconds = np.array(values, float)
    two_parts = all(text.count(":") == 1 for text in texts if text.strip())
    if two_parts and seconds[np.isfinite(seconds)].max() >= DAY:
        seconds = seconds / 60
    known = np.flatnonzero(np.isfinite(seconds))
    back = np.diff(seconds[known]) < -DAY / 2
    days = np.zeros(len(seconds))
    days[known[1:]] = np.cumsum(back)
    return seconds + days * DAY, bool(back.any())


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
