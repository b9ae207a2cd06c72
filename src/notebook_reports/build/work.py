"""The work of a build: how many kernels, what each job gave, how it is ended."""

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from notebook_reports.build.job import Done, Job, Wanted, do, repeat
from notebook_reports.executors.executor import Threads, interruptible
from notebook_reports.memory import kept_fonts
from notebook_reports.project import atomic, limits, runtime
from notebook_reports.project.console import Console
from notebook_reports.project.failures import Failure, everything, summary
from notebook_reports.project.project import Project
from notebook_reports.run import warm
from notebook_reports.run.quick_imports import import_nbformat
from notebook_reports.run.surroundings import drop_stale_bytecode, environment
from notebook_reports.run.warm import Warm

OK, FAILED, USAGE, ENVIRONMENT, INTERRUPTED = 0, 1, 2, 3, 130

WORTH_WARMING = 2  # notebooks


@dataclass
class Outcome:
    """How a build ended. code: the exit code. done: one entry per notebook that was worked on."""

    code: int
    done: list[Done] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)


def _work(
    project: Project, work: list[Job], wanted: Wanted, jobs: int, console: Console, ready: str = ""
) -> list[Done]:
    """Do the jobs, the longest first so that none is left alone at the end. Raises KeyboardInterrupt.

    What never ran goes first, the last chapters before the others: they build on most. ready: see `warm`.
    """
    if not work:
        return []
    limits.check(min(jobs, len(work)))
    work = sorted(work, key=lambda j: j.notebook.id, reverse=True)
    work.sort(key=lambda j: -(j.stamp.seconds if j.stamp else math.inf))
    done: list[Done] = []
    with (
        interruptible(),
        _kernels(project, sum(bool(j.run_because) for j in work), console, ready),
        console.progress(len(work)),
    ):
        executor = Threads(min(jobs, len(work)), interrupted=_kill)
        for place, found in executor.run(partial(do, project, wanted=wanted), work):
            done.append(_result(found, work[place]))
            console.done(done[-1], work[place].reasons)
    return done


@contextmanager
def _kernels(project: Project, number: int, console: Console, ready: str = "") -> Iterator[Any]:
    """Import what runs notebooks, once, before the threads; meanwhile warm up what several kernels are forked from."""
    if not number:
        yield
        return
    drop_stale_bytecode(project)
    if told := kept_fonts.check(project.cache):
        console.line(told)
    worth = number >= WORTH_WARMING and warm.possible()
    warming = Warm(environment(project), ready) if worth else None
    try:
        import_nbformat()
        from notebook_reports.run import kernels, run  # noqa: F401

        with kernels.forked_from(warming):
            yield
        kept_fonts.note(project.cache)
    finally:
        if warming is not None:
            warming.close()  # also of a build that is interrupted before there is a kernel
        runtime.tidy()


def _result(found: Done | Exception, job: Job) -> Done:
    if isinstance(found, Done):
        return found
    what = f"{type(found).__name__}: {found} (a fault of the pipeline, please report it)"
    return Done(job.notebook, 0, [Failure(job.notebook.id, what, repeat=repeat(job))])


def _kill() -> None:
    kernels = sys.modules.get("notebook_reports.run.kernels")
    if kernels:
        kernels.kill_all()


def _finish(
    project: Project,
    done: list[Done],
    failures: list[Failure],
    todo: list[Job],
    console: Console,
    again: Callable[[str], str] = str,
) -> Outcome:
    """Say how it ended. again: gives a command that repeats a failure the options that this build had."""
    idle = len(todo) - len(done)
    if idle > 0:
        console.line(f"{idle} notebook{'s' if idle > 1 else ''} up to date")
    console.warnings(done)
    path = project.cache / "failures.txt"
    told = [replace(f, repeat=again(f.repeat)) for f in failures]
    if told:
        atomic.write(path, everything(told).encode())
    else:
        atomic.remove(path)
    for line in summary(told, path):
        console.line(line)
    environment = any(d.environment for d in done)
    return Outcome(ENVIRONMENT if environment else FAILED if failures else OK, done, failures)
