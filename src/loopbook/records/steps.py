"""Where the input of a record steps, and whether the output answered loudly enough to be read."""

from dataclasses import dataclass

import numpy as np

from loopbook.records.record import Record, RecordError

MOST_STEPS = 200
SMALLEST = 0.02  # of the input's range: a smaller change is noise
LARGEST_LEFT = 0.1  # of the input's range: what the levels between steps may leave of it


@dataclass(frozen=True)
class Steps:
    """The steps of an input.

    list: (instant in s, height in the input's unit), the input being constant between them. before: samples recorded
    before the first step. noise: standard deviation of the measurement's sample-to-sample noise. notes: in words.
    course: the list holds every change of an input that is no sequence of steps.
    """

    list: list[tuple[float, float]]
    before: int
    noise: float
    notes: tuple[str, ...]
    course: bool = False

    def describe(self) -> str:
        """How the input moves, in a word or two."""
        return f"{len(self.list)} step{'s' if len(self.list) != 1 else ''}" if not self.course else "no steps, a course"

    @property
    def largest(self) -> int:
        """Index of the highest step."""
        return int(np.argmax([abs(height) for _, height in self.list]))


def noise_level(y: np.ndarray) -> float:
    """Standard deviation of white noise on a smooth signal, from its second differences (variance 6 sigma^2).

    The median makes it blind to the few samples where the signal bends or jumps. A quantised signal that mostly
    stands still gives the width of a quantisation step over sqrt(12).
    """
    second = np.abs(np.diff(y, 2))
    sigma = float(np.median(second) / 0.6745 / np.sqrt(6))
    if sigma > 0:
        return sigma
    levels = np.diff(np.unique(y))
    return float(levels.min() / np.sqrt(12)) if len(levels) and len(levels) < len(y) / 4 else 0.0


def find_steps(record: Record) -> Steps:
    """The steps of the recorded input; where it moves otherwise (a ramp, a random course), every change of it.

    Changes below 2 % of the input's range count as noise of the input. Raises RecordError where the input never
    moves or the output does not answer.
    """
    time, u = record.held or (record.time, record.u)
    span = float(np.ptp(u))
    name = record.input_name
    if span == 0:
        raise RecordError(
            f"no step found: the input {name!r} is {u[0]:g} from the first sample to the last; "
            "record a change of the input, or name another column with --input"
        )
    changes = np.flatnonzero(np.abs(np.diff(u)) > SMALLEST * span)
    levels = [float(np.mean(part)) for part in np.split(u, changes + 1)]
    staircase = np.repeat(levels, np.diff(np.concatenate([[0], changes + 1, [len(u)]])))
    is_course = len(changes) > min(MOST_STEPS, len(u) // 4) or np.abs(u - staircase).max() > LARGEST_LEFT * span
    if is_course:
        listed, notes, first = _course(time, u, span)
    else:
        listed = [(float(time[k + 1]), b - a) for k, a, b in zip(changes, levels, levels[1:], strict=False)]
        first = listed[0][0]
        when = (
            f"taken at the first sample with the new input: the dead time may be up to {record.sampling:.3g} s longer"
        )
        notes = [f"{len(listed)} step{'s' if len(listed) > 1 else ''} of the input found, {when}."]
    before = max(int(np.searchsorted(record.time, first)), 1)
    if before < 5:
        many = "sample" if before == 1 else "samples"
        notes.append(f"Only {before} {many} before the first step: the output was taken to be at rest.")
    noise = noise_level(record.y[record.used])
    notes += _answered(record, before, noise)
    return Steps(listed, before, noise, tuple(notes), is_course)


def _course(time: np.ndarray, u: np.ndarray, span: float) -> tuple[list[tuple[float, float]], list[str], float]:
    """Every change of an input that is no sequence of steps, in words, and when it first left its start."""
    moves = np.flatnonzero(np.diff(u) != 0)
    listed = [(float(time[k + 1]), float(u[k + 1] - u[k])) for k in moves]
    away = np.flatnonzero(np.abs(u - u[0]) > SMALLEST * span)
    note = (
        f"The input is no sequence of steps: it changes at {len(listed)} of {len(u)} samples (a ramp or another "
        "course); it was used as recorded, held from one sample to the next."
    )
    return listed, [note], float(time[max(int(away[0]) - 1, int(moves[0]) + 1)])


def _answered(record: Record, before: int, noise: float) -> list[str]:
    """What is to be said of the answer's size. Raises RecordError where there is none to speak of."""
    y, used = record.y, record.used
    resting = y[:before][used[:before]]
    after = y[before:][used[before:]]
    rest = float(np.mean(resting)) if len(resting) else float(after[0]) if len(after) else 0.0
    moved = float(np.max(np.abs(np.convolve(after - rest, np.ones(5) / 5, "valid")))) if len(after) >= 5 else 0.0
    if moved <= 3 * noise / np.sqrt(min(before, 5)) or moved == 0:
        raise RecordError(
            f"the output {record.output_name!r} does not answer the step: it moves by {moved:.3g}, its noise is "
            f"{noise:.3g}; use a higher step, a longer record, or name another column with --output"
        )
    if noise and moved < 10 * noise:
        return [f"The response ({moved:.3g}) is only {moved / noise:.1f} times the noise: the model is uncertain."]
    return []


def drifts(record: Record, steps: Steps) -> bool:
    """Does the output drift before the first step, beyond four standard errors of the slope?"""
    used = record.used[: steps.before]
    n = int(used.sum())
    if n < 10:
        return False
    t, y = record.time[: steps.before][used], record.y[: steps.before][used]
    t = t - t.mean()
    slope = float(t @ (y - y.mean()) / (t @ t))
    sigma = max(float(np.std(y - y.mean() - slope * t)) * np.sqrt(n / (n - 2)), steps.noise)
    spans = np.ptp(record.time), np.ptp(record.y[record.used])
    return abs(slope) > 4 * sigma / np.sqrt(t @ t) and abs(slope) * spans[0] > 0.02 * spans[1]
