"""Many jobs on this machine, in processes that have the surroundings of every kernel, so that bytes do not differ."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_all_start_methods, get_context
from multiprocessing.context import BaseContext

from notebook_reports.executors.executor import TRIES, Job, Result, Results, cores, surroundings


class Processes:
    """So many processes at a time. One that is killed costs its jobs another try; a job that kills its process again
    and again is a failure of its own."""

    def __init__(self, number: int | None = None, preloaded: Sequence[str] = ()):
        self.number, self.preloaded = number or cores(), tuple(preloaded)

    def run(self, function: Callable[[Job], Result], jobs: Sequence[Job]) -> Results:
        waiting = dict.fromkeys(range(len(jobs)), 0)
        while waiting:
            alone = any(waiting.values())  # after a process was killed, one at a time: then it is known by whose job
            todo = list(waiting)[:1] if alone else list(waiting)
            with surroundings(), self._pool(1 if alone else self.number) as pool:
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

    @contextmanager
    def _pool(self, number: int) -> Iterator[ProcessPoolExecutor]:
        """Ended at once where the run is broken off."""
        with ProcessPoolExecutor(number, self._context()) as pool:
            try:
                yield pool
            except BaseException:
                processes = list((pool._processes or {}).values())
                pool.shutdown(wait=False, cancel_futures=True)
                for process in processes:
                    process.kill()
                raise

    def _context(self) -> BaseContext:
        if "forkserver" not in get_all_start_methods():
            return get_context("spawn")
        context = get_context("forkserver")
        context.set_forkserver_preload(list(self.preloaded))
        return context
