"""What runs many jobs, and the simplest that does.

A job is a function of a module's top and plain data, and so is what it gives: then every executor can take the place
of every other, and the bytes that come of it do not depend on which.
"""

import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

from notebook_reports.project.project import no_project
from notebook_reports.run.surroundings import environment

TRIES = 3
Job = Any
Result = Any
Results = Generator[tuple[int, Result | Exception], None, None]
"""To be closed where it is not read to its end: that ends what still runs."""


class Executor(Protocol):
    """What runs jobs: (place in the list, what it gave or the exception that it raised), in any order.

    An error of a job is its result; what ends the run of all (Ctrl-C, a cluster that is lost) is raised.
    """

    def run(self, function: Callable[[Job], Result], jobs: Sequence[Job]) -> Results: ...


class Serial:
    """One after the other, in this process.

    >>> list(Serial().run(abs, [-1, "a"]))[0]
    (0, 1)
    """

    def run(self, function: Callable[[Job], Result], jobs: Sequence[Job]) -> Results:
        for place, job in enumerate(jobs):
            try:
                found: Result | Exception = function(job)
            except Exception as error:
                found = error
            yield place, found


class Threads:
    """So many at a time in threads of this process: for jobs whose work is done by kernels of their own.

    interrupted: called when the run is broken off, to end what the threads wait for.
    """

    def __init__(self, number: int, interrupted: Callable[[], None] = lambda: None):
        self.number, self.interrupted = number, interrupted

    def run(self, function: Callable[[Job], Result], jobs: Sequence[Job]) -> Results:
        with ThreadPoolExecutor(self.number) as pool:
            waiting: dict[Future[Result], int] = {pool.submit(function, job): place for place, job in enumerate(jobs)}
            try:
                while waiting:
                    finished, _ = wait(waiting, return_when=FIRST_COMPLETED)
                    for future in finished:
                        place = waiting.pop(future)
                        try:
                            found: Result | Exception = future.result()
                        except Exception as error:
                            found = error
                        yield place, found
            except (KeyboardInterrupt, GeneratorExit):
                for future in waiting:
                    future.cancel()
                self.interrupted()
                raise


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


@contextmanager
def interruptible() -> Iterator[None]:
    """SIGTERM ends what runs inside the block as Ctrl-C does."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(*_: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
