"""One notebook on files of the reader's own: each file gets its run and its report, in parallel, nothing in the ledger.

Notebook and file are copied into a folder of their own, so that the report names the file and not the machine's paths,
and a notebook that writes something cannot touch the originals.
"""

import json
import re
import shlex
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from notebook_reports.build.job import Done, Job, Wanted, plan
from notebook_reports.build.work import Outcome, _finish, _work
from notebook_reports.build.writing import reporter
from notebook_reports.executors.executor import cores
from notebook_reports.project import atomic, runtime
from notebook_reports.project.console import Console
from notebook_reports.project.parameters import assign
from notebook_reports.project.project import Notebook, Project, UsageError
from notebook_reports.project.source import read_source

CODE = "code-only"
"""The tag of cells that are shown only together with code."""
FORMATS = ("pdf", "html", "ipynb", "json")
Programs = Mapping[str, Callable[[dict, str], bytes]]
"""More formats, by their ending: (the JSON that the notebook shows, stem of the file) -> the file."""
FEW = 8  # reports that are named one by one


@dataclass(frozen=True)
class Item:
    """A file to run the notebook on, where each format of its report goes, and what it is called on the way."""

    data: Path
    outputs: dict[str, Path]
    label: str = ""


def items(
    files: Sequence[Path],
    target: Path | None,
    name: str,
    formats: Sequence[str] = (),
    default: str = "pdf",
    more: Sequence[str] = (),
) -> list[Item]:
    """Where the reports go: beside each file as ``<file>-<name>.pdf``, into a folder, or for one file to a file.

    target: None, a folder, or for one file a file: its ending is one more format, the others go beside it under its
    name. formats: none for the default; more: formats besides `FORMATS`.
    Files of one name get their folder's name in front. Raises UsageError for a
    file that is not there, for an unknown format or a target of another ending.
    """
    files = list({f.resolve(): f for f in files}.values())
    missing = [f"{f} (a link to {f.readlink()}, which is not there)" if f.is_symlink() else str(f)
               for f in files if not f.is_file()]  # fmt: skip
    if missing:
        raise UsageError(f"no such file: {', '.join(missing)}")
    known = (*FORMATS, *more)
    unknown = [f for f in formats if f not in known]
    if unknown:
        raise UsageError(f"unknown format {', '.join(unknown)}; one or more of {','.join(known)}")
    single = None if target is None or target.is_dir() else _single(files, target, formats, default, more)
    if single is not None:
        return [single]
    wanted = list(formats) or [default]
    folders = [file.parent if target is None else target for file in files]
    labels = _labels(files, folders)
    return [
        Item(file, {f: (folder / f"{_stem(label, name, f in more)}.{f}").resolve() for f in wanted}, label)
        for file, folder, label in zip(files, folders, labels, strict=True)
    ]


def program_stem(file: str, name: str) -> str:
    """The name of a program's files: one that other programs can import.

    >>> program_stem("heater 2", "design")
    'heater_2_design'
    """
    return _importable(f"{file}_{name}")


def _importable(name: str) -> str:
    return re.sub(r"\W", "_", name)


def _stem(label: str, name: str, program: bool) -> str:
    return program_stem(label, name) if program else f"{label}-{name}"


def _single(
    files: Sequence[Path], target: Path, formats: Sequence[str], default: str, more: Sequence[str]
) -> Item | None:
    """The report of one file where the target names a file; None where it names a folder to be made."""
    end = target.resolve() if target.is_symlink() else target
    suffix = (target.suffix or end.suffix).lstrip(".")
    if not suffix and not end.is_file():
        return None
    if suffix and suffix not in FORMATS:
        raise UsageError(f"{target}: a report ends in .pdf, .html, .ipynb or .json")
    if len(files) > 1:
        raise UsageError(f"{target} is one file, {len(files)} reports are to be made: give a folder")
    wanted = list(dict.fromkeys([*([suffix] if suffix else []), *formats])) or [default]
    if not suffix and len(wanted) > 1:
        raise UsageError(
            f"{target} is a file without an ending: for {' and '.join(wanted)} give a folder, or a name with one"
        )
    first = suffix or wanted[0]
    stems = {f: _importable(target.stem) if f in more else target.stem for f in wanted}
    outputs = {f: end.resolve() if f == first else target.with_name(f"{stems[f]}.{f}").resolve() for f in wanted}
    return Item(files[0], outputs, files[0].stem)


def _labels(files: Sequence[Path], folders: Sequence[Path]) -> list[str]:
    """A name for each report, no two alike in one folder: the stem, with the file's folder or ending where that is
    needed to tell two apart, at last with a number.
    """
    whole = [f.resolve() for f in files]
    ways = (
        [f.stem for f in files],
        [f"{f.parent.name}-{f.stem}" for f in whole],
        [f"{f.stem}-{f.suffix.lstrip('.')}" for f in files],
        [f"{f.parent.name}-{f.stem}-{f.suffix.lstrip('.')}" for f in whole],
    )
    labels, taken = list(ways[0]), set()
    places = [(folder.resolve(), f.stem) for folder, f in zip(folders, files, strict=True)]
    for i, place in enumerate(places):
        alike = [j for j, other in enumerate(places) if other == place]
        if len(alike) > 1:
            apart = (way for way in ways if len({way[j] for j in alike}) == len(alike))
            labels[i] = next(apart, ways[1])[i]
        number, label = 2, labels[i]
        while (place[0], label) in taken:
            label, number = f"{labels[i]}-{number}", number + 1
        labels[i] = label
        taken.add((place[0], label))
    return labels


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
    programs: Programs | None = None,
    code: bool = True,
    leave_out: frozenset[str] = frozenset(),
) -> Outcome:
    """Run `notebook` once for each item, with `parameter` set to the item's file.

    repeat: the command that did it, for the list of failures. ready: ``module:function`` that computes, once for all
    items, what each run would compute again; see `warm`. programs: writers of more formats. code: show code, and
    what is tagged `CODE`, in reports to be read. leave_out: tags of cells that are not run at all. A run that fails
    sets older reports aside under their name with .old behind it. Raises UsageError before any kernel starts.
    """
    console = console or Console()
    given = [word for name, value in parameters for word in ("-p", name, value)]
    with tempfile.TemporaryDirectory(prefix="data-", dir=runtime.folder()) as temporary:
        todo: list[Job] = []
        stems = {item.label or item.data.stem: {f: p.stem for f, p in item.outputs.items()} for item in wanted}
        settings = Wanted(("pdf",), timeout=timeout, exporter=partial(_report, programs or {}, stems, code))
        for i, item in enumerate(wanted):
            folder = Path(temporary) / str(i)
            folder.mkdir()
            label = item.label or item.data.stem
            copied = folder / f"{label}.ipynb"
            copied.write_text(without(notebook.read_text(encoding="utf-8"), leave_out), encoding="utf-8")
            shutil.copyfile(item.data, folder / item.data.name)
            source = read_source(copied)
            values = assign(source, [*parameters, (parameter, item.data.name)])
            job = plan(project, Notebook(label, copied, own=False), source, values, settings)
            job.outputs, job.keep_older = item.outputs, True
            job.run_because, job.export_because = ["first build"], {f: ["first build"] for f in item.outputs}
            todo.append(job)
        for path in sorted({p.parent for job in todo for p in job.outputs.values()}):
            path.mkdir(parents=True, exist_ok=True)
            atomic.writable(path)
        done = _work(project, todo, settings, jobs or cores(), console, ready)
        failed = {one.notebook.path for one in done if one.failures}
        again = [str(item.data) for job, item in zip(todo, wanted, strict=True) if job.notebook.path in failed]
        command = shlex.join([*repeat, *again, *given])
        failures = [replace(f, repeat=command) for one in done for f in one.failures]
        _tell(todo, done, console)
        _set_aside([job for job in todo if job.notebook.path in failed], console)
        return _finish(project, done, failures, todo, console)


def without(notebook: str, tags: frozenset[str]) -> str:
    """A notebook's text without the cells that have one of the tags."""
    if not tags:
        return notebook
    content = json.loads(notebook)
    content["cells"] = [c for c in content["cells"] if not tags & set(c.get("metadata", {}).get("tags", ()))]
    return json.dumps(content, ensure_ascii=False)


def _codeless(content: dict) -> dict:
    """The notebook with all code hidden, and all that is only for those who read it."""
    cells = []
    for cell in content["cells"]:
        tags = list(cell["metadata"].get("tags", ()))
        hide = ["remove-cell"] if CODE in tags else ["remove-input"] if cell["cell_type"] == "code" else []
        cells.append({**cell, "metadata": {**cell["metadata"], "tags": tags + hide}})
    return {**content, "cells": cells}


def _report(
    programs: Programs,
    stems: Mapping[str, Mapping[str, str]],
    code: bool,
    content: dict,
    format: str,
    notebook: Notebook,
    title: str,
) -> bytes:
    """A report in any of `FORMATS`; json is the data that the notebook shows as such, programs are made from it."""
    if format in programs:
        return programs[format](_shown(content), stems[notebook.path.stem][format])
    if format != "json":
        return report_of(content, format, notebook, title, code)
    return (json.dumps(_shown(content), indent=2, ensure_ascii=False) + "\n").encode()


def report_of(content: dict, format: str, notebook: Notebook, title: str, code: bool) -> bytes:
    """A report to be read, of an executed notebook from elsewhere. code: show it."""
    return reporter()(content if code else _codeless(content), format, notebook, title)


def _shown(content: dict) -> dict:
    for cell in content["cells"]:
        for output in cell.get("outputs", ()):
            if "application/json" in output.get("data", {}):
                return output["data"]["application/json"]
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


def _set_aside(failed: Sequence[Job], console: Console) -> None:
    """Reports of an earlier run do not stay where this one failed: each is renamed."""
    for path in (p for job in failed for p in job.outputs.values() if p.is_file()):
        older = path.with_name(f"{path.name}.old")
        path.replace(older)
        console.line(f"      {path} was of an earlier run and is now {older.name}")
