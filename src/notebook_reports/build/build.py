"""`loopbook build`: every notebook that needs it, in parallel; all of them, even if one fails; then the ledger.

One process drives N kernels. Where nothing is to be done, nothing is imported that takes time.
"""

import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from notebook_reports.build import provenance
from notebook_reports.build.job import Job, Wanted, plan
from notebook_reports.build.judge import judge, remembered
from notebook_reports.build.where import output_paths
from notebook_reports.build.work import INTERRUPTED, Outcome, _finish, _work
from notebook_reports.executors.executor import cores
from notebook_reports.memory import stamps
from notebook_reports.memory.manifest import write_manifest
from notebook_reports.pages import publish as pages
from notebook_reports.project import atomic
from notebook_reports.project.console import Console
from notebook_reports.project.failures import Failure
from notebook_reports.project.home import private_cache
from notebook_reports.project.parameters import assign, read_parameters
from notebook_reports.project.project import FORMATS, EnvironmentProblem, Notebook, Project, UsageError
from notebook_reports.project.source import Source, read_source


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
    up_to_date = not broken and all(j.idle for j in todo) and not accept
    if up_to_date and not (publishing and (pages.reasons(project, wanted.code) or not provenance.is_of_now(project))):
        verdict = remembered(project, judged, f"{complete} {frozen}")
        if verdict or not judged:
            return _finish(project, [], verdict.failures if verdict else [], todo, console, options_of(wanted))
    project = _writable(project, todo, wanted)
    with atomic.only_builder(project.cache, lambda who: console.line(f"waiting for {who} to finish its build")):
        todo, broken = _plan(project, notebooks, parameters, wanted)
        work = [j for j in todo if not j.idle]
        try:
            done = _work(project, work, wanted, jobs or cores(), console)
        except KeyboardInterrupt:
            console.line(
                "interrupted: what was finished stays, nothing is half written; the next build goes on from there"
            )
            return Outcome(INTERRUPTED)
        failures = broken + [f for d in done for f in d.failures]
        if judged:
            ran = [n for n in judged if stamps.load(project, n)]
            verdict = judge(project, ran, complete and len(ran) == len(judged), accept, frozen)
            failures += verdict.failures
            console.changes(verdict.changes)
            if complete and len(ran) < len(judged):
                console.line("the ledger was not checked for completeness: not every notebook ran")
            write_manifest(project)
        if publishing:
            failures += pages.publish(project, console, wanted.code)
            provenance.withdraw(project) if failures else provenance.write(project)
    return _finish(project, done, failures, todo, console, options_of(wanted))


def options_of(wanted: Wanted) -> Callable[[str], str]:
    """A function that gives a command which repeats a build the options that the build was called with."""
    usual, words = Wanted(), []
    for name, option in (("timeout", "--timeout"), ("output", "-o"), ("code", "--code")):
        value = getattr(wanted, name)
        if value != getattr(usual, name):
            words += [option, f"{value:g}" if isinstance(value, float) else str(value)]
    if wanted.formats != usual.formats:
        words += ["--format", ",".join(wanted.formats)]
    return lambda command: shlex.join([*shlex.split(command), *words]) if command else ""


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
            todo.append(plan(project, notebook, source, values, wanted))
        except UsageError as error:
            if parameters or not notebook.own:
                raise
            stamps.forget(project, notebook, output_paths(project, notebook))
            broken.append(Failure(notebook.id, str(error), repeat=f"loopbook build {notebook.id}"))
    _refuse_one_file_for_two(todo)
    return todo, broken


def _refuse_one_file_for_two(todo: Sequence[Job]) -> None:
    """Raise UsageError where two notebooks would write the same file."""
    writers: dict[str, Job] = {}
    for job in todo:
        for path in job.outputs.values():
            other = writers.setdefault(str(path).casefold(), job)
            if other is not job:
                raise UsageError(f"{other.notebook.path} and {job.notebook.path} would both write {path}")


def _values(project: Project, notebook: Notebook, source: Source, parameters: Any) -> dict[str, Any]:
    if not parameters and not (notebook.own and source.tagged("parameters")):
        return {}
    known = stamps.load(project, notebook)
    if not parameters and known and known.run.get("its code") == source.hash_code():
        return {}  # this very code was checked before it ran
    read_parameters(source)
    return assign(source, parameters)


def _writable(project: Project, todo: list[Job], wanted: Wanted) -> Project:
    """The project, after it was seen that its folders can be written.

    Where the reports go elsewhere the project may be read-only: then its cache is a private one.
    """
    for folder in sorted({path.parent for job in todo if not job.idle for path in job.outputs.values()}):
        atomic.writable(folder)
    try:
        atomic.writable(project.cache)
    except EnvironmentProblem:
        if wanted.output is None:
            raise
        return replace(project, cache=private_cache())
    return project
