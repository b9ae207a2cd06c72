"""A record in one line, for every run that reads one."""

from pathlib import Path

from loopbook.records.reading import read_record
from loopbook.records.record import Record, RecordError
from loopbook.records.steps import Steps, find_steps


def line(record: Record, steps: Steps | None) -> str:
    """What was taken for what: u, y, the unit of time, how many steps and samples.

    steps: None where none were found.
    """
    moves = steps.describe() if steps else "0 steps"
    return (
        f"u = {_named(record.input_name, record.input_unit)}, y = {_named(record.output_name, record.output_unit)}, "
        f"time in {record.time_unit}, {moves}, {len(record.time)} samples"
    )


def _named(name: str, unit: str) -> str:
    text = f"{name} [{unit}]" if unit else name
    return "".join(c if c.isprintable() else "?" for c in text)


def describe(path: Path, time: str = "", input: str = "", output: str = "", interval: float = 0.0) -> str:
    """The line of a file, whatever it holds: of a record that cannot be read, that it cannot."""
    try:
        record = read_record(path, time, input, output, interval)
    except RecordError as error:
        return f"u = ?, y = ?, time in ?, ? steps, ? samples: {error}"
    try:
        steps = find_steps(record)
    except RecordError:
        steps = None
    return line(record, steps)
