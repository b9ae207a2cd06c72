"""Many jobs on many machines, by Dask: workers of its own here, or those of a scheduler that runs.

Whoever reaches a scheduler's port runs code on its workers: docs/security.md.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from functools import cache
from typing import Any

from notebook_reports.executors.executor import TRIES, Job, Result, Results, surroundings
from notebook_reports.executors.served import Ended, Served
from notebook_reports.executors.sources import fingerprint
from notebook_reports.project.project import EnvironmentProblem, UsageError

SECONDS = 600.0
"""For one job."""


class Cluster:
    """Jobs on Dask's workers. where: a number of workers to be started on this machine, or the address of a scheduler,
    ``tcp://host:8786``. packages: whose sources have to be the same on every worker, the one that is installed last.
    preloaded: modules that its processes import first. seconds: for one job. A worker that is killed and a job that
    takes too long cost another try.
    """

    def __init__(
        self, where: str, packages: Sequence[str] = ("notebook_reports",), preloaded: Sequence[str] = (),
        seconds: float = SECONDS,
    ):  # fmt: skip
        self.where, self.packages, self.preloaded = where, tuple(packages), tuple(preloaded)
        self.seconds = seconds
        if not where.isdecimal() and not where.startswith(("tcp://", "tls://")):
            raise UsageError(f"--cluster {where}: give a number of workers or a scheduler, tcp://host:8786")
        if where.isdecimal() and int(where) < 1:
            raise UsageError("--cluster 0: at least one worker")

    def run(self, function: Callable[[Job], Result], jobs: Sequence[Job]) -> Results:
        """(place in the list, what it gave or the exception that it raised), as they end.

        Raises EnvironmentProblem where there is no cluster, where its workers have not the same loopbook, and where it
        is lost.
        """
        if not jobs:
            return
        distributed = _distributed()
        with self._client(distributed) as client:
            self._refuse_others(client)
            order = [(function, job, self.seconds, self.preloaded) for job in jobs]
            futures = client.map(on_worker, order, range(len(jobs)), pure=False, retries=TRIES - 1)
            places = {future.key: place for place, future in enumerate(futures)}
            for future in distributed.as_completed(futures, loop=client.loop):
                try:
                    found = future.exception() or future.result()  # one lost with its worker is done again meanwhile
                except CancelledError:
                    found = CancelledError()
                if isinstance(found, CancelledError):
                    raise EnvironmentProblem(f"--cluster {self.where}: its scheduler is gone; what is done is kept")
                future.release()  # else a worker keeps it, and one that is killed costs all that it did before
                yield places[future.key], found

    def _refuse_others(self, client: Any) -> None:
        """Raises EnvironmentProblem where a worker has not the packages that are here."""
        what, here = self.packages[-1], fingerprint(self.packages)
        try:
            client.wait_for_workers(1, timeout=60)
        except TimeoutError:
            raise EnvironmentProblem(f"--cluster {self.where}: its scheduler has no worker: start one") from None
        try:
            found_of = client.run(fingerprint, self.packages)
        except Exception as error:
            told = f"{type(error).__name__}: {error}"
            raise EnvironmentProblem(
                f"--cluster {self.where}: {what} is not on every worker ({told}); install the same there, "
                "with the extra cluster"
            ) from None
        for worker, found in found_of.items():
            for name, value in here.items():
                if found.get(name) != value:
                    told = f"has {name} {found.get(name)}, this machine {value}"
                    raise EnvironmentProblem(
                        f"--cluster {self.where}: {worker} {told}; results would differ: install the same"
                    )

    @contextmanager
    def _client(self, distributed: Any) -> Iterator[Any]:
        import dask

        quiet = {"distributed.admin.log-length": 0, "distributed.logging.distributed": "critical"}
        with dask.config.set(quiet):
            if not self.where.isdecimal():
                try:
                    client = distributed.Client(self.where, timeout=10, set_as_default=False)
                except (OSError, TimeoutError, ValueError) as error:
                    told = f"no scheduler answers at {self.where}"
                    raise EnvironmentProblem(
                        f"{told}: {type(error).__name__}; start one with `dask scheduler`"
                    ) from None
                with client:
                    yield client
                return
            with surroundings():
                local = distributed.LocalCluster(
                    n_workers=int(self.where),
                    threads_per_worker=1,
                    processes=True,
                    host="127.0.0.1",
                    dashboard_address="127.0.0.1:0",
                    worker_dashboard_address=None,
                    memory_limit=0,
                )
            with local, distributed.Client(local, set_as_default=False) as client:
                yield client


def on_worker(order: tuple[Callable[[Any], Any], Any, float, tuple[str, ...]], place: int) -> Any:
    """One job on a worker, in a process beside it. Raises what the job raises; other tries are the scheduler's.

    An error of the job itself is its result and not tried again.
    """
    function, job, seconds, preloaded = order
    try:
        return _served(preloaded).do(function, job, seconds)
    except (TimeoutError, Ended):
        raise
    except Exception as error:
        return error


@cache
def _served(preloaded: tuple[str, ...]) -> Served:
    return Served(preloaded)


def _distributed() -> Any:
    try:
        import distributed
    except ImportError:
        raise EnvironmentProblem("--cluster needs Dask: pip install 'loopbook[cluster]'") from None
    return distributed
