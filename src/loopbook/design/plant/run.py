"""`loopbook design *.csv -o out/`: every record its design, resumable, then one summary."""

import os
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from loopbook.design.plant.attention import FAILED, REFUSED, LoopRow, ranked
from loopbook.design.plant.one import Designed, DesignJob, design_one
from loopbook.design.plant.summary import summary_csv, summary_page
from loopbook.jobs import PACKAGES
from notebook_reports.build.apply import Item
from notebook_reports.executors.done import FOLDER, DoneJobs
from notebook_reports.executors.executor import Executor
from notebook_reports.project import atomic
from notebook_reports.project.project import UsageError

CSV, HTML = "summary.csv", "summary.html"
OURS = "summary"
"""The record of the summary, among those of the designs: names begin with no such."""


@dataclass
class PlantDesigns:
    """What came of a run. rows: ranked. fresh: how many were designed now."""

    rows: list[LoopRow] = field(default_factory=list)
    fresh: int = 0

    def of(self, *states: str) -> list[LoopRow]:
        return [row for row in self.rows if row.state in states]

    @property
    def code(self) -> int:
        return 1 if self.of(FAILED, REFUSED) else 0


def design_plant(
    wanted: Sequence[Item],
    out: Path,
    values: Sequence[tuple[str, Any]],
    executor: Executor,
    page: bool = False,
    code: bool = False,
    tell: Callable[[LoopRow, int, int], None] = lambda row, done, of: None,
) -> PlantDesigns:
    """Design for each item and write its files and the summary into `out`. tell: (the row, how many are done, of how
    many), as they end.

    A run that is broken off keeps what it has done; the next does the rest, and whatever changed or was lost since.
    Raises UsageError before anything runs where the folder holds a summary that no such run wrote.
    """
    kept = DoneJobs(out, out / FOLDER, PACKAGES)
    _refuse_foreign(out, kept, wanted)
    atomic.writable(out)
    rows, jobs, done = {}, [], PlantDesigns()
    for item in wanted:
        try:
            jobs.append(_job(item, values, page, code))
        except OSError as error:
            rows[item.label] = LoopRow(item.label, failed=f"{item.data} cannot be read: {error.strerror}")
    folders = {item.label: item.outputs for item in wanted}
    todo = []
    for job in jobs:
        if (noted := kept.find(_place(job.label), job)) is None:
            todo.append(job)
        else:
            rows[job.label] = _row(noted)
    with closing(executor.run(design_one, todo)) as results:
        for number, (place, found) in enumerate(results, len(rows) + 1):
            job = todo[place]
            rows[job.label] = _keep(found, job, folders[job.label], out, kept)
            done.fresh += 1
            tell(rows[job.label], number, len(wanted))
    done.rows = ranked(rows.values())
    links = {item.label: {f: p.name for f, p in item.outputs.items()} for item in wanted}
    files = {CSV: summary_csv(done.rows), HTML: summary_page(done.rows, links)}
    kept.note(OURS, OURS, {}, files)  # first: a summary without its record would be taken for a stranger's
    for name, content in files.items():
        atomic.write(out / name, content)
    return done


def _job(item: Item, values: Sequence[tuple[str, Any]], page: bool, code: bool) -> DesignJob:
    stems = tuple((format, path.stem) for format, path in item.outputs.items())
    return DesignJob(item.label, item.data.name, item.data.read_bytes(), stems, tuple(values), page, code)


def _place(label: str) -> str:
    return f"loops/{label}"


def _row(noted: dict[str, Any]) -> LoopRow:
    return LoopRow(**{**noted, "mind": tuple(noted["mind"])})


def _keep(found: Designed | Exception, job: DesignJob, outputs: dict[str, Path], out: Path, kept: DoneJobs) -> LoopRow:
    """Write what came of a job. One that failed is not noted, and so done again by the next run."""
    if isinstance(found, Exception):
        _set_aside(outputs)
        return LoopRow(job.label, failed=f"{type(found).__name__}: {found}")
    if not found.files:
        _set_aside(outputs)
    for format, content in found.files.items():
        atomic.write(outputs[format], content)
    written = {os.path.relpath(outputs[format], out.resolve()): content for format, content in found.files.items()}
    kept.note(_place(job.label), job, asdict(found.row), written)
    return found.row


def _set_aside(outputs: dict[str, Path]) -> None:
    """A report of an earlier run does not stay where this one gave none."""
    for path in outputs.values():
        if path.is_file():
            path.replace(path.with_name(f"{path.name}.old"))


def _refuse_foreign(out: Path, kept: DoneJobs, wanted: Sequence[Item]) -> None:
    if out.exists() and not out.is_dir():
        raise UsageError(f"{out} is a file: give a folder for {len(wanted)} designs")
    for name in (CSV, HTML):
        if any(item.data.resolve() == (out / name).resolve() for item in wanted):
            raise UsageError(f"{out / name} is named as a record, and the summary goes there: leave it out, or choose "
                             "another folder with -o DIR")  # fmt: skip
    if any((out / name).exists() for name in (CSV, HTML)) and not (out / FOLDER / f"{OURS}.json").is_file():
        raise UsageError(f"{out} holds a summary that no design wrote: choose another folder with -o DIR")


class Progress:
    """Says how far a run is and how long the rest will take."""

    def __init__(self, say: Callable[[str], None], terminal: bool, now: Callable[[], float] = time.monotonic):
        self._say, self._terminal, self._now = say, terminal, now
        self._began = self._told = now()
        self._bad = self._fresh = 0

    def __call__(self, row: LoopRow, done: int, of: int) -> None:
        """One more is done: a line that is written over on a terminal, elsewhere one a minute."""
        self._fresh += 1
        self._bad += row.state in (FAILED, REFUSED)
        now = self._now()
        if not self._terminal and now - self._told < 60 and done < of:
            return
        self._told = now
        left = (of - done) * (now - self._began) / self._fresh
        about = f", about {duration(left)} left" if done < of else ""
        text = f"{done} of {of} designed, {self._bad} without a regulator{about}"
        self._say(f"\r{text:<78}" + ("\n" if done == of else "") if self._terminal else f"{text}\n")


def duration(seconds: float) -> str:
    """
    >>> duration(42), duration(600), duration(9000)
    ('42 s', '10 min', '2 h 30 min')
    """
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"
