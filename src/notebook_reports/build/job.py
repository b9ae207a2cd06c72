"""One notebook to build: what has to be done and why, and the doing of it."""

import json
import shlex
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from notebook_reports.build import writing
from notebook_reports.build.standing import NOWHERE, Standing, standing
from notebook_reports.build.where import output_paths
from notebook_reports.build.writing import Exporter
from notebook_reports.ledger import harvest
from notebook_reports.memory import fingerprint, inputs, stamps
from notebook_reports.memory.hashes import digest, hash_now, of_bytes
from notebook_reports.memory.inputs import Input
from notebook_reports.project import atomic
from notebook_reports.project.failures import Failure
from notebook_reports.project.project import EnvironmentProblem, Notebook, Project
from notebook_reports.project.source import Source
from notebook_reports.run.canonical import canonical, dump, renew_prose
from notebook_reports.run.filled import filled


@dataclass(frozen=True)
class Wanted:
    """What a build is asked for. output: the folder of the reports, None for the usual. exporter: see `writing`.
    code: where the book has its code, "" for what book.toml says."""

    formats: tuple[str, ...] = ("pdf", "html", "ipynb")
    output: Path | None = None
    force: bool = False
    timeout: float = 600
    exporter: Exporter | None = None
    code: str = ""


@dataclass
class Job:
    """One notebook, with the reasons to run it and to export it again; no reasons where it is up to date.

    keep_older: reports of an earlier run stay where this one fails.
    """

    notebook: Notebook
    source: Source
    parameters: Mapping[str, Any]
    outputs: dict[str, Path]
    stamp: stamps.Stamp | None
    run_because: list[str]
    export_because: dict[str, list[str]]
    keep_older: bool = False
    stands: Standing = NOWHERE

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
    outputs = output_paths(project, notebook, parameters, wanted.formats, wanted.output)
    declared = inputs.declared(project, source)
    if parameters or not notebook.own:
        why = ["other parameters"] if parameters else ["not of this project"]
        stands = standing(project, notebook, beside=False)
        return Job(notebook, source, parameters, outputs, None, why, dict.fromkeys(outputs, why), stands=stands)
    found = stamps.look(project, notebook)
    stamp = found.stamp
    now = fingerprint.of_run(project, source, {*(stamp.inputs if stamp else ()), *declared})
    because = [found.damage] if found.damage else fingerprint.differences(stamp.run if stamp else None, now)
    because = ["--force"] if wanted.force else because
    stands = standing(project, notebook, wanted.output is None, wanted.formats)
    exports = {} if because or stamp is None else _outdated(source, stamp, outputs, wanted, stands)
    return Job(notebook, source, parameters, outputs, stamp, because, exports, stands=stands)


def _outdated(
    source: Source, stamp: stamps.Stamp, outputs: Mapping[str, Path], wanted: Wanted, stands: Standing
) -> dict[str, list[str]]:
    """The formats to be written again, and why: the file is not the one that was written, or it would be another."""
    found: dict[str, list[str]] = {}
    for format, path in outputs.items():
        last = stamp.exports.get(str(path))
        if wanted.output is not None:
            found[format] = ["-o"]
        elif last is None or hash_now(path) != last["file"]:
            found[format] = [f"{path.name} was changed" if path.exists() else f"{path.name} is not there"]
        else:
            prints = fingerprint.of_export(source, stamp, format, stands.print(format))
            if why := fingerprint.differences(last["prints"], prints):
                found[format] = why
    return found


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
    given = [word for k, v in job.parameters.items() for word in ("-p", k, str(v))]
    return shlex.join(["loopbook", "build", name, *given])


@dataclass
class _Result:
    """What a run gave, now or before: the content, canonical and in one order; its inputs with their prints."""

    content: dict[str, Any]
    stored: bytes
    used: list[Input]
    prints: fingerprint.Prints
    seconds: float
    warnings: list[list]


def _do(project: Project, job: Job, wanted: Wanted) -> Done:
    """Run or remember, harvest, export, remember."""
    remembers = job.notebook.own and not job.parameters and wanted.output is None
    result = _run(project, job, wanted, remembers) if job.run_because else _renewed(project, job)
    if isinstance(result, Done):
        return result
    records = harvest.records(result.content, job.notebook.id)
    found = [r.data() for r in records]
    counts = dict(Counter(r["table"] for r in found))
    done = Done(job.notebook, 0, [], result.warnings, counts, found, ran=bool(job.run_because))
    if not remembers:
        done.failures += harvest.failing(records)  # no ledger's judge comes after this build
    results = digest([c.get("outputs") for c in result.content["cells"]])
    stamp = stamps.Stamp(
        run=result.prints,
        used=[[i.name, i.kind] for i in result.used],
        executed="",
        results=results,
        title=job.source.title,
        seconds=result.seconds,
        counts=counts,
        records="",
        warnings=result.warnings,
        pictures=fingerprint.pictures(result.content),
        mimes=fingerprint.mimes(result.content),
        exports={} if job.run_because or not job.stamp else dict(job.stamp.exports),
    )
    done.failures += _reports(project, job, wanted, result.content, stamp)
    if remembers:
        stamp.executed, stamp.records = stamps.keep(project, job.notebook, result.stored, found)
        stamps.save(project, job.notebook, stamp)
        atomic.remove(stamps.failed_path(project, job.notebook))
    return done


def _run(project: Project, job: Job, wanted: Wanted, remembers: bool) -> "_Result | Done":
    """Run the notebook. Where it fails: what is to be said, and nothing of it that looks finished is left."""
    from notebook_reports.run.run import run_notebook

    notebook, source = job.notebook, job.source
    if remembers:
        stamps.forget(project, notebook, output_paths(project, notebook) if wanted.formats else None)
    began = time.time_ns()
    ran = run_notebook(source, notebook.id, project, job.parameters, wanted.timeout)
    warnings = [list(w) for w in ran.warnings]
    if ran.failure:
        for path in job.outputs.values() if not job.keep_older else ():
            atomic.remove(path)
        atomic.write(stamps.failed_path(project, notebook), dump(ran.content))
        return Done(notebook, 0, [replace(ran.failure, repeat=repeat(job))], warnings, ran=True)
    warnings += [[cell, text] for cell, text in _not_seen(project, source, ran)]
    used = sorted({*inputs.seen(project, source, ran.depends, (*fingerprint.RUNS, *fingerprint.WRITES))})
    used = sorted({*used, *inputs.declared(project, source)})
    prints = fingerprint.of_run(project, source, used, since=began)
    return _result(ran.content, used, prints, ran.seconds, warnings)


def _not_seen(project: Project, source: Source, ran: Any) -> list[tuple[int, str]]:
    """What of the run no stamp holds, by cell."""
    return [(ran.cell_of(at), text) for at, text in inputs.outside(project, source, ran.depends)]


def _renewed(project: Project, job: Job) -> _Result:
    """The last run's results in the prose of now."""
    stamp = job.stamp
    assert stamp is not None, "only what has a stamp is renewed"
    plain = filled(canonical(job.source.content, project.root, [c.id for c in job.source.cells]), job.source)
    content = renew_prose(stamps.executed(project, job.notebook), plain)
    return _result(content, stamp.inputs, stamp.run, stamp.seconds, stamp.warnings)


def _result(content: dict, used: list[Input], prints: fingerprint.Prints, seconds: float, warnings: list) -> _Result:
    stored = dump(content)  # and read again: a report shows data in one order, whether it was run now or before
    return _Result(json.loads(stored), stored, used, prints, seconds, warnings)


def _reports(project: Project, job: Job, wanted: Wanted, content: dict, stamp: stamps.Stamp) -> list[Failure]:
    """Write the reports that are due, and into the stamp what was written; the failures."""
    failures: list[Failure] = []
    for format, path in job.outputs.items():
        if not job.run_because and format not in job.export_because:
            continue
        stamp.exports.pop(str(path), None)
        told = (job.notebook, job.source.title, wanted.exporter)
        written = writing.write(path, format, content, *told, keep_older=job.keep_older, stands=job.stands)
        if isinstance(written, bytes):
            prints = fingerprint.of_export(job.source, stamp, format, job.stands.print(format))
            stamp.exports[str(path)] = {"prints": prints, "file": of_bytes(written)}
        else:
            failures += [replace(failure, repeat=repeat(job)) for failure in written]
    return failures
