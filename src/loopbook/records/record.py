"""A recorded experiment: time, input and output. `reading.read_record` makes it from a logger's file."""

from dataclasses import dataclass, field

import numpy as np

from derivations.errors import LoopbookError

FEWEST_SAMPLES = 10


class RecordError(LoopbookError):
    """The record cannot be used; the message says what is missing and how to mend it."""


@dataclass(frozen=True)
class Other:
    """A further input or disturbance that was recorded and moves. values: shape (n,), in its own unit."""

    name: str
    values: np.ndarray


@dataclass(frozen=True)
class Record:
    """One experiment.

    time: seconds from the first sample, strictly increasing, shape (n,). u, y: input and output in their own units,
    shape (n,). assumptions: what the reader took for what, one sentence each. held: (time, u) with the samples too
    whose output is missing, None where none is: the input may step at one of them. others: further inputs that move.
    setpoint: that of a regulator, where the log has one, shape (n,).
    left_out: samples that a fit must not use (outliers, a sensor at its limit), shape (n,), None for none. cut: the
    share of samples at a sensor's limit. time_unit: of the file's column. faults: what the sensor did wrong.

    >>> import numpy as np
    >>> from loopbook.records.record import Record
    >>> t = np.arange(12.0)
    >>> Record(t, np.where(t > 2, 1.0, 0.0), np.where(t > 4, 0.6, 0.0)).input_name
    'u'
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
    others: tuple[Other, ...] = ()
    left_out: np.ndarray | None = None
    cut: float = 0.0
    time_unit: str = "s"
    setpoint: np.ndarray | None = None
    faults: tuple[str, ...] = ()

    def __post_init__(self) -> None:
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
    def used(self) -> np.ndarray:
        """The samples that a fit may use, shape (n,), true or false."""
        return np.ones(len(self.time), bool) if self.left_out is None else ~self.left_out

    @property
    def sampling(self) -> float:
        """The usual distance between samples (median), in seconds."""
        return float(np.median(np.diff(self.time)))
