"""Where the input of a record steps, and whether the output answered loudly enough to be read."""

from dataclasses import dataclass

import numpy as np

from loopbook.records.record import Record, RecordError

MOST_STEPS = 200


@dataclass(frozen=True)
class Steps:
    """The steps of an input.

    list: (instant in s, height in the input's unit), the input being constant between them. before: samples recorded
    before the first step. noise: standard deviation of the measurement's sample-to-sample noise. notes: in words.
    """

    list: list[tuple[float, float]]
    before: int
    noise: float
    notes: tuple[str, ...]

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
    """The steps of the recorded input.

    Changes below 2 % of the input's range count as noise of the input. Raises RecordError where the input never
    steps, never rests, or the output does not answer.
    """
    y = record.y
    time, u = record.held or (record.time, record.u)
    span = float(np.ptp(u))
    name = record.input_name
    if span == 0:
        raise RecordError(
            f"no step found: the input {name!r} is {u[0]:g} from the first sample to the last; "
            "record a change of the input, or name another column with --input"
        )
    changes = np.flatnonzero(np.abs(np.diff(u)) > 0.02 * span)
    if len(changes) > min(MOST_STEPS, len(u) // 4):
        raise RecordError(
            f"the input {name!r} changes at {len(changes)} of {len(u)} samples; a step record is needed, in which it "
            "rests between steps"
        )
    levels = [float(np.mean(part)) for part in np.split(u, changes + 1)]
    listed = [(float(time[k + 1]), b - a) for k, a, b in zip(changes, levels, levels[1:], strict=False)]
    when = f"taken at the first sample with the new input: the dead time may be up to {record.sampling:.3g} s longer"
    notes = [f"{len(listed)} step{'s' if len(listed) > 1 else ''} of the input found, {when}."]
    before = max(int(np.searchsorted(record.time, listed[0][0])), 1)
    if before < 5:
        many = "sample" if before == 1 else "samples"
        notes.append(f"Only {before} {many} before the first step: the output was taken to be at rest.")
    noise = noise_level(y)
    after = y[before:]
    rest = float(np.mean(y[:before]))
    moved = float(np.max(np.abs(np.convolve(after - rest, np.ones(5) / 5, "valid")))) if len(after) >= 5 else 0.0
    if moved <= 3 * noise / np.sqrt(min(before, 5)) or moved == 0:
        raise RecordError(
            f"the output {record.output_name!r} does not answer the step: it moves by {moved:.3g}, its noise is "
            f"{noise:.3g}; use a higher step, a longer record, or name another column with --output"
        )
    if noise and moved < 10 * noise:
        notes.append(f"The response ({moved:.3g}) is only {moved / noise:.1f} times the noise: the model is uncertain.")
    return Steps(listed, before, noise, tuple(notes))
