"""`loopbook build`: every notebook that needs it, in parallel; all of them, even if one fails; then the ledger.

One process drives N kernels. Where nothing is to be done, nothing is imported that takes time.
"""

import math
import os
import signal
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from loopbook.pipeline import atomic, pages, stamps, warm
from loopbook.pipeline.console import Console
from loopbook.pipeline.failures import Failure, everything, summary
from loopbook.pipeline.job import Done, Job, Wanted, do, plan, repeat
from loopbook.pipeline.project import FORMATS, Notebook, Project, UsageError
from loopbook.pipeline.quick_imports import import_nbformat
from loopbook.pipeline.source import Source, read_source
from loopbook.pipeline.surroundings import drop_stale_bytecode, environment
from loopbook.pipeline.warm import Warm

OK, FAILED, USAGE, ENVIRONMENT, INTERRUPTED = 0, 1, 2, 3, 130
WORTH_WARMING = 2  # notebooks


@dataclass
class Outcome:
    """How a build ended. code: the exit code. done: one entry per notebook that was worked on."""

    code: int
    done: list[Done] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)


def build(
    project: Project,
    names: tuple[str, ...] = (),
    parameters: Sequence[tuple[str, str]] | Mapping[str, Any] = (),
    wanted: Wanted | None = None,
    jobs: int | None = None,
    accept: bool = False,
    frozen: bool = False,
    console: Console | None = None,
    ledger: bool = True,
) -> Outcome:
    """Build notebooks, by default all of the project.

    parameters: for the notebooks named, as typed values or as words of the command line. jobs: kernels at a time,
    default one per core. accept, frozen: see `judge.judge`. ledger: False runs and exports only. Raises UsageError and
    EnvironmentProblem before the first kernel starts; what happens later is in the outcome.
    """
    wanted, console = wanted or Wanted(), console or Console()
    _check(names, parameters, wanted)
    notebooks = project.select(names)
    judged = [n for n in notebooks if n.own] if ledger and not parameters and wanted.output is None else []
    todo, broken = _plan(project, notebooks, parameters, wanted)
    complete = bool(judged) and len(judged) == len(project.notebooks())
    publishing = pages.publishes(project, complete, wanted.formats)
    if not broken and all(j.idle for j in todo) and not accept and not (publishing and pages.reasons(project)):
        from loopbook.pipeline.judge import remembered

        verdict = remembered(project, judged, f"{complete} {frozen}")
        if verdict or not judged:
            return _finish(project, [], verdict.failures if verdict else [], todo, console)
    _writable(project, todo)
    with atomic.only_builder(project.cache, lambda who: console.line(f"waiting for {who} to finish its build")):
        todo, broken = _plan(project, notebooks, parameters, wanted)
        work = [j for j in todo if not j.idle]
        try:
            done = _work(project, work, wanted, jobs or _cores(), console)
        except KeyboardInterrupt:
            console.line(
                "interrupted: what was finished stays, nothing is half written; the next build goes on from there"
            )
            return Outcome(INTERRUPTED)
        failures = broken + [f for d in done for f in d.failures]
        if judged:
            from loopbook.pipeline.judge import judge
            from loopbook.pipeline.manifest import write_manifest

            ran = [n for n in judged if stamps.load(project, n)]
            verdict = judge(project, ran, complete and len(ran) == len(judged), accept, frozen)
            failures += verdict.failures
            console.changes(verdict.changes)
            if complete and len(ran) < len(judged):
                console.line("the ledger was not checked for completeness: not every notebook ran")
            write_manifest(project)
        if publishing:
            failures += pages.publish(project, console)
    return _finish(project, done, failures, todo, console)


def _check(names: tuple[str, ...], parameters: Any, wanted: Wanted) -> None:
    if parameters and not names:
        raise UsageError("-p needs a notebook: loopbook build NOTEBOOK -p NAME VALUE")
    unknown = [f for f in wanted.formats if f not in FORMATS]
    if unknown:
        raise UsageError(f"unknown format {', '.join(unknown)}; one or more of {','.join(FORMATS)}")


def _plan(
    project: Project, notebooks: Sequence[Notebook], parameters: Any, wanted: Wanted
) -> tuple[list[Job], list[Failure]]:
    """The jobs, and the notebooks that cannot even be read, as failures where no parameter was given."""
    todo, broken = [], []
    for notebook in notebooks:
        try:
            source = read_source(notebook.path)
            values = _values(project, notebook, source, parameters)
        except UsageError as error:
            if parameters or not notebook.own:
                raise
            stamps.forget(project, notebook)
            broken.append(Failure(notebook.id, str(error), repeat=f"loopbook build {notebook.id}"))
            continue
        todo.append(plan(project, notebook, source, values, wanted))
    return todo, broken


def _values(project: Project, notebook: Notebook, source: Source, parameters: Any) -> dict[str, Any]:
    if not parameters and not (notebook.own and source.tagged("parameters")):
        return {}
    known = stamps.load(project, notebook)
    if not parameters and known and known.run.get("its code") == source.hash_code():
        return {}  # this very code was checked before it ran
    from loopbook.pipeline.parameters import assign, read_parameters

    read_parameters(source)
    return assign(source, parameters)


def _writable(project: Project, todo: list[Job]) -> None:
    folders = {path.parent for job in todo if not job.idle for path in job.outputs.values()}
    for folder in sorted({project.cache, *folders}):
        atomic.writable(folder)


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _work(
    project: Project, work: list[Job], wanted: Wanted, jobs: int, console: Console, ready: str = ""
) -> list[Done]:
    """Do the jobs, the longest first so that none is left alone at the end. Raises KeyboardInterrupt.

    What never ran goes first, the last chapters before the others: they build on most. ready: see `warm`.
    """
    if not work:
        return []
    work = sorted(work, key=lambda j: j.notebook.id, reverse=True)
    work.sort(key=lambda j: -(j.stamp.seconds if j.stamp else math.inf))
    done: list[Done] = []
    with (
        _interruptible(),
        _kernels(project, sum(bool(j.run_because) for j in work), ready),
        console.progress(len(work)),
        ThreadPoolExecutor(min(jobs, len(work))) as pool,
    ):
        waiting: dict[Future, Job] = {pool.submit(do, project, job, wanted): job for job in work}
        try:
            while waiting:
                finished, _ = wait(waiting, return_when=FIRST_COMPLETED)
                for future in finished:
                    job = waiting.pop(future)
                    done.append(_result(future, job))
                    console.done(done[-1], job.reasons)
        except KeyboardInterrupt:
            for future in waiting:
                future.cancel()
            _kill()
            raise
    return done


@contextmanager
def _kernels(project: Project, number: int, ready: str = ""):
    """Import what runs notebooks, once, before the threads; meanwhile warm up what several kernels are forked from."""
    if not number:
        yield
        return
    drop_stale_bytecode(project.root)
    worth = number >= WORTH_WARMING and warm.possible()
    warming = Warm(environment(project.root, project.cache), ready) if worth else None
    import_nbformat()
    from loopbook.pipeline import kernels, run  # noqa: F401

    with kernels.forked_from(warming):
        yield


def _result(future: Future, job: Job) -> Done:
    try:
        return future.result()
    except KeyboardInterrupt:
        raise
    except Exception as error:
        what = f"{type(error).__name__}: {error} (a fault of the pipeline, please report it)"
        return Done(job.notebook, 0, [Failure(job.notebook.id, what, repeat=repeat(job))])


def _kill() -> None:
    import sys

    kernels = sys.modules.get("loopbook.pipeline.kernels")
    if kernels:
        kernels.kill_all()


@contextmanager
def _interruptible():
    """SIGTERM ends a build as Ctrl-C does."""
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


def _finish(project: Project, done: list[Done], failures: list[Failure], todo: list[Job], console: Console) -> Outcome:
    idle = len(todo) - len(done)
    if idle > 0:
        console.line(f"{idle} notebook{'s' if idle > 1 else ''} up to date")
    console.warnings(done)
    path = project.cache / "failures.txt"
    if failures:
        atomic.write(path, everything(failures).encode())
    else:
        atomic.remove(path)
    for line in summary(failures):
        console.line(line)
    environment = any(d.environment for d in done)
    return Outcome(ENVIRONMENT if environment else FAILED if failures else OK, done, failures)
