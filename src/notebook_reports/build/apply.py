"""One notebook on files of the reader's own: each file gets its run and its report, in parallel, nothing in the ledger.

Notebook and file are copied into a folder of their own, so that the report names the file and not the machine's paths,
and a notebook that writes something cannot touch the originals.
"""

import json
import shlex
import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from notebook_reports.build.job import Done, Job, Wanted, plan, reporter
from notebook_reports.build.work import Outcome, _cores, _finish, _work
from notebook_reports.project import atomic
from notebook_reports.project.console import Console
from notebook_reports.project.parameters import assign
from notebook_reports.project.project import Notebook, Project, UsageError
from notebook_reports.project.source import read_source

FORMATS = ("pdf", "html", "ipynb", "json")
FEW = 8  # reports that are named one by one


@dataclass(frozen=True)
class Item:
    """A file to run the notebook on, and where each format of its report goes."""

    data: Path
    outputs: dict[str, Path]


def items(files: Sequence[Path], target: Path | None, name: str, formats: Sequence[str]) -> list[Item]:
    """Where the reports go: beside each file as ``<file>-<name>.pdf``, into a folder, or for one file to a file.

    target: None, a folder, or a file that ends in one of the formats. Raises UsageError for a file that is not there,
    for an unknown format or a target of another ending, and for two files whose reports would have one name.
    """
    missing = [str(f) for f in files if not f.is_file()]
    if missing:
        raise UsageError(f"no such file: {', '.join(missing)}")
    suffix = target.suffix.lstrip(".") if target is not None else ""
    if target is not None and suffix and not target.is_dir():
        if suffix not in FORMATS:
            raise UsageError(f"{target}: a report ends in .pdf, .html, .ipynb or .json")
        if len(files) > 1:
            raise UsageError(f"{target} is one file, {len(files)} reports are to be made: give a folder")
        return [Item(files[0], {suffix: target.resolve()})]
    unknown = [f for f in formats if f not in FORMATS]
    if unknown:
        raise UsageError(f"unknown format {', '.join(unknown)}; one or more of {','.join(FORMATS)}")
    stems = [f.stem for f in files]
    if target is not None and len(set(stems)) < len(stems):
        raise UsageError("two files of one name cannot share a folder of reports")
    made = []
    for file in files:
        folder = file.parent if target is None else target
        made.append(Item(file, {f: (folder / f"{file.stem}-{name}.{f}").resolve() for f in formats}))
    return made


def apply(
    project: Project,
    notebook: Path,
    wanted: Sequence[Item],
    parameters: Sequence[tuple[str, str]],
    parameter: str = "data",
    jobs: int | None = None,
    timeout: float = 600,
    console: Console | None = None,
    repeat: Sequence[str] = ("loopbook", "design"),
    ready: str = "",
) -> Outcome:
    """Run `notebook` once for each item, with `parameter` set to the item's file.

    repeat: the command that did it, for the list of failures. ready: ``module:function`` that computes, once for all
    items, what each run would compute again; see `warm`. Raises UsageError before any kernel starts.
    """
    console = console or Console()
    given = [word for name, value in parameters for word in ("-p", name, value)]
    with tempfile.TemporaryDirectory(prefix="loopbook") as temporary:
        todo: list[Job] = []
        settings = Wanted(("pdf",), timeout=timeout, exporter=_report)
        for i, item in enumerate(wanted):
            folder = Path(temporary) / str(i)
            folder.mkdir()
            copied = folder / f"{item.data.stem}.ipynb"
            shutil.copyfile(notebook, copied)
            shutil.copyfile(item.data, folder / item.data.name)
            source = read_source(copied)
            values = assign(source, [*parameters, (parameter, item.data.name)])
            job = plan(project, Notebook(item.data.stem, copied, own=False), source, values, settings)
            job.outputs = item.outputs
            job.run_because, job.export_because = ["first build"], {f: ["first build"] for f in item.outputs}
            todo.append(job)
        for path in sorted({p.parent for job in todo for p in job.outputs.values()}):
            path.mkdir(parents=True, exist_ok=True)
            atomic.writable(path)
        done = _work(project, todo, settings, jobs or _cores(), console, ready)
        failed = {one.notebook.path for one in done if one.failures}
        again = [str(item.data) for job, item in zip(todo, wanted, strict=True) if job.notebook.path in failed]
        command = shlex.join([*repeat, *again, *given])
        failures = [replace(f, repeat=command) for one in done for f in one.failures]
        _tell(todo, done, console)
        return _finish(project, done, failures, todo, console)


def _report(content: dict, format: str, *about: Any) -> bytes:
    """A report in any of `FORMATS`; json is the data that the notebook shows as such."""
    if format != "json":
        return reporter()(content, format, *about)
    for cell in content["cells"]:
        for output in cell.get("outputs", ()):
            if "application/json" in output.get("data", {}):
                return (json.dumps(output["data"]["application/json"], indent=2, ensure_ascii=False) + "\n").encode()
    raise LookupError("the notebook shows no data as JSON")


def _tell(todo: Sequence[Job], done: Sequence[Done], console: Console) -> None:
    """Where the reports are that were made."""
    good = {one.notebook.path for one in done if not one.failures}
    paths = [path for job in todo if job.notebook.path in good for path in job.outputs.values()]
    if len(paths) <= FEW:
        for path in paths:
            console.line(f"      {path}")
        return
    for folder in sorted({path.parent for path in paths}):
        console.line(f"      {sum(path.parent == folder for path in paths)} reports in {folder}")
