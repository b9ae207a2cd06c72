"""One notebook to build: what has to be done and why, and the doing of it."""

import json
import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from notebook_reports.memory import fingerprint, stamps
from notebook_reports.project import atomic
from notebook_reports.project.failures import Failure
from notebook_reports.project.project import EnvironmentProblem, Notebook, Project
from notebook_reports.project.source import Source
from notebook_reports.run.quick_imports import import_nbformat

Exporter = Callable[..., bytes]
_EXPORTING = threading.Lock()  # the exporters keep state while they write


@dataclass(frozen=True)
class Wanted:
    """What a build is asked for. output: the folder of the reports, None for the usual. exporter: see `export`."""

    formats: tuple[str, ...] = ("pdf", "html", "ipynb")
    engine: str = "typst"
    output: Path | None = None
    force: bool = False
    timeout: float = 600
    exporter: Exporter | None = None


@dataclass
class Job:
    """One notebook, with the reasons to run it and to export it again; no reasons where it is up to date."""

    notebook: Notebook
    source: Source
    parameters: Mapping[str, Any]
    outputs: dict[str, Path]
    stamp: stamps.Stamp | None
    run_because: list[str]
    export_because: dict[str, list[str]]

    @property
    def idle(self) -> bool:
        return not self.run_because and not self.export_because

    @property
    def reasons(self) -> list[str]:
        return self.run_because or list(dict.fromkeys(r for rs in self.export_because.values() for r in rs))


@dataclass
class Done:
    """What came of a job. records: what its checks left."""

    notebook: Notebook
    seconds: float
    failures: list[Failure] = field(default_factory=list)
    warnings: list[list] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    records: list[dict] = field(default_factory=list)
    ran: bool = False
    environment: bool = False


def plan(project: Project, notebook: Notebook, source: Source, parameters: Mapping[str, Any], wanted: Wanted) -> Job:
    """Compare what the last build recorded with what is there now."""
    outputs = output_paths(project, notebook, parameters, wanted)
    if parameters or not notebook.own:
        why = ["other parameters"] if parameters else ["not of this project"]
        return Job(notebook, source, parameters, outputs, None, why, dict.fromkeys(outputs, why))
    stamp = stamps.load(project, notebook)
    now = fingerprint.of_run(project, source, stamp.used if stamp else [])
    because = ["--force"] if wanted.force else fingerprint.differences(stamp.run if stamp else None, now)
    exports: dict[str, list[str]] = {}
    if not because:
        for format, path in outputs.items():
            prints = fingerprint.of_export(source, stamp.results, wanted.engine, format)
            last = stamp.exports.get(str(path))
            if last is None or stamps.print_of(path) != last["file"]:
                exports[format] = [f"{path.name} is not there" if not path.exists() else f"{path.name} was changed"]
            elif why := fingerprint.differences(last["prints"], prints):
                exports[format] = why
    return Job(notebook, source, parameters, outputs, stamp, because, exports)


def output_paths(
    project: Project, notebook: Notebook, parameters: Mapping[str, Any], wanted: Wanted
) -> dict[str, Path]:
    """Where each format goes.

    A notebook of the project: ``reports/<id>.pdf``; with parameters of one's own ``reports/custom/<id>-q=0.6.pdf``.
    One from elsewhere: beside it, the executed notebook as ``<name>.executed.ipynb``. With -o: below that folder.
    """
    if wanted.output is not None:
        folder = wanted.output
    elif notebook.own:
        folder = project.reports / "custom" if parameters else project.reports
    else:
        folder = notebook.path.parent
    stem = notebook.id + _suffix(parameters)
    paths = {format: folder / f"{stem}.{format}" for format in wanted.formats}
    if paths.get("ipynb") and paths["ipynb"].resolve() == notebook.path:
        paths["ipynb"] = folder / f"{stem}.executed.ipynb"
    return paths


def _suffix(parameters: Mapping[str, Any]) -> str:
    import re

    text = "".join(f"-{name}={re.sub(r'[^A-Za-z0-9_.+-]+', '_', str(value))}" for name, value in parameters.items())
    return text if len(text) <= 80 else "-" + fingerprint.digest(dict(parameters))


def do(project: Project, job: Job, wanted: Wanted) -> Done:
    """Run and export as planned. Whatever fails is in the result, and no file of it looks finished."""
    started = time.monotonic()
    try:
        done = _do(project, job, wanted)
    except EnvironmentProblem as problem:
        failure = Failure(job.notebook.id, str(problem), repeat=repeat(job), kind="environment")
        done = Done(job.notebook, 0, [failure], environment=True)
    done.seconds = time.monotonic() - started
    return done


def repeat(job: Job) -> str:
    """The command that does this job again."""
    name = job.notebook.id if job.notebook.own else str(job.notebook.path)
    import shlex

    given = [word for k, v in job.parameters.items() for word in ("-p", k, str(v))]
    return shlex.join(["loopbook", "build", name, *given])


def _do(project: Project, job: Job, wanted: Wanted) -> Done:
    from notebook_reports.ledger import harvest
    from notebook_reports.run.canonical import canonical, dump, renew_prose

    notebook, source = job.notebook, job.source
    stamped = notebook.own and not job.parameters
    executed = stamps.executed_path(project, notebook)
    if job.run_because:
        from notebook_reports.run.run import run

        if stamped:
            stamps.forget(project, notebook)
        began = time.time_ns()
        ran = run(source, notebook.id, project, job.parameters, wanted.timeout)
        content, warnings = ran.content, [list(w) for w in ran.warnings]
        if ran.failure:
            for path in job.outputs.values():
                atomic.remove(path)
            seen = stamps.failed_path(project, notebook)
            atomic.write(seen, dump(content))
            failure = Failure(**{**vars(ran.failure), "repeat": repeat(job)})
            return Done(notebook, 0, [failure], warnings, ran=True)
        used = fingerprint.used_by(project, source, ran.depends)
        seconds, prints = ran.seconds, fingerprint.of_run(project, source, used, since=began)
    else:
        content = json.loads(executed.read_bytes())
        plain = canonical(source.content, project.root, [c.id for c in source.cells])
        content = renew_prose(content, plain)
        used, seconds = job.stamp.used, job.stamp.seconds
        prints, warnings = job.stamp.run, job.stamp.warnings
    stored = dump(content)
    content = json.loads(stored)  # in one order, run now or read: a report shows data in the order it is in
    records = harvest.records(content, notebook.id)
    found = [r.data() for r in records]
    counts = dict(Counter(r["table"] for r in found))
    done = Done(notebook, 0, warnings=warnings, counts=counts, records=found, ran=bool(job.run_because))
    if not stamped or wanted.output is not None:
        done.failures += harvest.failing(records)  # a build that does not come before the ledger's judge
    results = fingerprint.digest([c.get("outputs") for c in content["cells"]])
    exports = {} if job.run_because else dict(job.stamp.exports)
    todo = job.outputs if job.run_because else {f: job.outputs[f] for f in job.export_because}
    for format, path in todo.items():
        failures = _export(project, job, wanted, content, format, path)
        if failures:
            done.failures += failures
            exports.pop(str(path), None)
        else:
            prints_now = fingerprint.of_export(source, results, wanted.engine, format)
            exports[str(path)] = {"prints": prints_now, "file": stamps.print_of(path)}
    if stamped:
        atomic.write(executed, stored)
        stamps.save_records(project, notebook, found)
        digest = fingerprint.digest(found)
        stamp = stamps.Stamp(prints, used, results, source.title, seconds, counts, digest, warnings, exports)
        stamps.save(project, notebook, stamp)
        atomic.remove(stamps.failed_path(project, notebook))
    return done


def _export(project: Project, job: Job, wanted: Wanted, content: dict, format: str, path: Path) -> list[Failure]:
    """Write one report; the failures, and then no report."""
    from notebook_reports.run.canonical import dump

    notebook = job.notebook
    if format == "ipynb":
        atomic.write(path, dump(content))
        return []
    export = wanted.exporter or reporter()
    try:
        atomic.write(path, export(content, format, notebook, job.source.title, wanted.engine))
    except EnvironmentProblem:
        raise
    except Exception as error:
        atomic.remove(path)
        problems = getattr(error, "problems", None) or [error]
        return [
            Failure(
                notebook.id,
                f"{format}: {getattr(p, 'text', None) or f'{type(p).__name__}: {p}'}",
                getattr(p, "cell", None) or 0,
                repeat=repeat(job),
                kind="export",
            )
            for p in problems
        ]
    return []


def reporter() -> Exporter:
    """What writes reports, one at a time; see `export`."""
    import_nbformat()
    import nbformat

    from notebook_reports.export.exporters.choose import export

    def call(content: dict, format: str, notebook: Notebook, title: str, engine: str) -> bytes:
        with _EXPORTING:
            return export(
                nbformat.from_dict(content),
                format,
                name=notebook.id,
                title=title,
                document=notebook.folder.replace("_", "-"),
                engine=engine,
                assets=notebook.path.parent,
                strict_alt=notebook.own,
                mode="strict" if notebook.own else "mend",
            )

    return call
