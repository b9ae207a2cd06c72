"""A recorded experiment: time, input and output. `reading.read_csv` makes it from a logger's file."""

from dataclasses import dataclass, field

import numpy as np

FEWEST_SAMPLES = 10


class RecordError(ValueError):
    """The record cannot be used; the message says what is missing and how to mend it."""


@dataclass(frozen=True)
class Record:
    """One experiment.

    time: seconds from the first sample, strictly increasing, shape (n,). u, y: input and output in their own units,
    shape (n,). assumptions: what the reader took for what, one sentence each. held: (time, u) with the samples too
    whose output is missing, None where none is: the input may step at one of them.
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
    held: tuple[np.ndarray, np.ndarray] | None = None

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
