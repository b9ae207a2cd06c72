"""What was built and from what: one small JSON file per notebook, removed whenever what it says is no longer so.

The cache can be deleted at any time; the next build then runs everything.
"""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from notebook_reports.memory.fingerprint import digest
from notebook_reports.project import atomic
from notebook_reports.project.project import Notebook, Project


@dataclass
class Stamp:
    """The last good run of a notebook.

    run: the fingerprint of the run. used: the files among it. results: hash of the executed content. counts: its
    records by table. records: hash of them. exports: by output path, fingerprint, size and time of the file written.
    """

    run: dict[str, str]
    used: list[str]
    results: str
    title: str
    seconds: float
    counts: dict[str, int]
    records: str
    warnings: list[list]
    exports: dict[str, dict[str, Any]] = field(default_factory=dict)


def _path(project: Project, folder: str, notebook: Notebook, suffix: str) -> Path:
    name = notebook.id if notebook.own else f"_/{digest(str(notebook.path))}"
    return project.cache / folder / f"{name}{suffix}"


def executed_path(project: Project, notebook: Notebook) -> Path:
    """The executed notebook, canonical."""
    return _path(project, "executed", notebook, ".ipynb")


def failed_path(project: Project, notebook: Notebook) -> Path:
    """What a failed run got to, to look at."""
    return _path(project, "failed", notebook, ".ipynb")


def load(project: Project, notebook: Notebook) -> Stamp | None:
    """The stamp; None where there is none or it, or what it speaks of, cannot be read."""
    try:
        stamp = Stamp(**json.loads(_path(project, "stamps", notebook, ".json").read_bytes()))
    except (OSError, ValueError, TypeError):
        return None
    return stamp if executed_path(project, notebook).exists() else None


def save(project: Project, notebook: Notebook, stamp: Stamp) -> None:
    stamp.exports = {path: e for path, e in stamp.exports.items() if Path(path).exists()}
    atomic.write(_path(project, "stamps", notebook, ".json"), json.dumps(asdict(stamp), indent=1).encode())


def save_records(project: Project, notebook: Notebook, records: list[dict]) -> None:
    atomic.write(_path(project, "records", notebook, ".json"), json.dumps(records, ensure_ascii=False).encode())


def load_records(project: Project, notebook: Notebook) -> list[dict]:
    """The records of the last good run; none where there was none."""
    try:
        return json.loads(_path(project, "records", notebook, ".json").read_bytes())
    except (OSError, ValueError):
        return []


def forget(project: Project, notebook: Notebook) -> None:
    """The notebook is not built: its stamp, its executed form and the reports made of it go."""
    stamp = load(project, notebook)
    for path in stamp.exports if stamp else ():
        atomic.remove(Path(path))
    for folder, suffix in (("stamps", ".json"), ("records", ".json"), ("executed", ".ipynb")):
        atomic.remove(_path(project, folder, notebook, suffix))


def print_of(path: Path) -> list[int]:
    """Size and time stamp of a file written, to see whether it is still the one; empty where it is gone."""
    try:
        status = path.stat()
    except OSError:
        return []
    return [status.st_size, status.st_mtime_ns]
