"""Many jobs on this machine: processes of their own, in the surroundings of every kernel, so that bytes do not differ.

A job is a function of the module's top and plain data; what it gives is plain data too. So the other executor, of many
machines, takes the place of this one: `loopbook.course.cluster`.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_all_start_methods, get_context
from multiprocessing.context import BaseContext
from pathlib import Path
from typing import Any, Protocol

from notebook_reports.project.project import no_project
from notebook_reports.run.surroundings import environment

TRIES = 3
PRELOADED = (
    "numpy",
    "scipy.signal",
    "sympy",
    "matplotlib.pyplot",
    "loopbook.course.release.one",
    "loopbook.course.grade.one",
    "notebook_reports.export.exporters.pdf",
    "notebook_reports.export.exporters.html",
)
"""What each worker would import: done once, in the process that they are forked from."""
Job = Any
Result = Any


class Executor(Protocol):
    """What runs jobs: (place in the list, what it gave or the exception that it raised), in any order."""

    def run(
        self, function: Callable[[Job], Result], jobs: Sequence[Job]
    ) -> Iterator[tuple[int, Result | Exception]]: ...


class Processes:
    """So many processes at a time. One that is killed costs its jobs another try; a job that kills its process again
    and again is a failure of its own."""

    def __init__(self, number: int | None = None):
        self.number = number or cores()

    def run(self, function: Callable[[Job], Result], jobs: Sequence[Job]) -> Iterator[tuple[int, Result | Exception]]:
        waiting = dict.fromkeys(range(len(jobs)), 0)
        while waiting:
            alone = any(waiting.values())  # after a process was killed, one at a time: then it is known by whose job
            todo = list(waiting)[:1] if alone else list(waiting)
            with surroundings(), ProcessPoolExecutor(1 if alone else self.number, _context()) as pool:
                futures: dict[Future[Result], int] = {pool.submit(function, jobs[place]): place for place in todo}
                for future in as_completed(futures):
                    place = futures[future]
                    try:
                        found: Result | Exception = future.result()
                    except BrokenProcessPool as error:
                        waiting[place] += 1
                        if waiting[place] < TRIES:
                            continue
                        found = error
                    except Exception as error:
                        found = error
                    del waiting[place]
                    yield place, found


def _context() -> BaseContext:
    if "forkserver" not in get_all_start_methods():
        return get_context("spawn")
    context = get_context("forkserver")
    context.set_forkserver_preload(list(PRELOADED))
    return context


def cores() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def surroundings() -> Iterator[None]:
    """Processes that start inside the block have the environment of a kernel, and draw without a screen."""
    before = dict(os.environ)
    os.environ.clear()
    os.environ.update({**environment(no_project(Path.cwd())), "MPLBACKEND": "agg"})
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)
