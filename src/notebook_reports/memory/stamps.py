"""What was built and from what: a stamp for each notebook, with the hash of everything else that is kept of it.

The cache can be deleted at any time; the next build then runs everything. Nothing in it is believed: a stamp carries
its own seal, the executed notebook and the records are compared with the stamp whenever they are read. What does not
agree is a miss: its notebook runs again, and the build says why.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from notebook_reports.memory import sealed
from notebook_reports.memory.hashes import digest, hash_now, of_bytes
from notebook_reports.memory.inputs import Input
from notebook_reports.project import atomic
from notebook_reports.project.project import EnvironmentProblem, Notebook, Project


@dataclass
class Stamp:
    """The last good run of a notebook.

    run: the fingerprint of the run. used: the (name, kind) of each input that it read. executed: hash of the executed
    notebook as kept; results: of its outputs; records: of what its checks found. counts: its records by table.
    pictures: the files that its text shows. mimes: the forms of its outputs that a script may show. exports: by output
    path, the fingerprint and the hash of the file written.
    """

    run: dict[str, str]
    used: list[list[str]]
    executed: str
    results: str
    title: str
    seconds: float
    counts: dict[str, int]
    records: str
    warnings: list[list]
    pictures: list[str] = field(default_factory=list)
    mimes: list[str] = field(default_factory=list)
    exports: dict[str, dict[str, Any]] = field(default_factory=dict)

    @property
    def inputs(self) -> list[Input]:
        return [Input(*pair) for pair in self.used]


@dataclass(frozen=True)
class StampLook:
    """What the cache has of a notebook. stamp: None where there is none, or what it speaks of is not as it was
    written; damage: then what was wrong."""

    stamp: Stamp | None
    damage: str = ""


def _path(project: Project, folder: str, notebook: Notebook, suffix: str) -> Path:
    name = notebook.id if notebook.own else f"_/{digest(str(notebook.path))}"
    return project.cache / folder / f"{name}{suffix}"


def executed_path(project: Project, notebook: Notebook) -> Path:
    """The executed notebook, canonical."""
    return _path(project, "executed", notebook, ".ipynb")


def records_path(project: Project, notebook: Notebook) -> Path:
    """What its checks found."""
    return _path(project, "records", notebook, ".json")


def failed_path(project: Project, notebook: Notebook) -> Path:
    """What a failed run got to, to look at."""
    return _path(project, "failed", notebook, ".ipynb")


def _stamp_path(project: Project, notebook: Notebook) -> Path:
    return _path(project, "stamps", notebook, ".json")


def look(project: Project, notebook: Notebook) -> StampLook:
    """The stamp, after everything that it speaks of in the cache was compared with it."""
    try:
        data = sealed.read(_stamp_path(project, notebook), notebook.id)
        stamp = Stamp(**data) if data is not None else None
    except sealed.Damaged as problem:
        return StampLook(None, f"its stamp in the cache {problem}")
    except TypeError:
        return StampLook(None, "its stamp in the cache is of another version")
    if stamp is None:
        return StampLook(None)
    for what, path, expected in (
        ("its executed notebook", executed_path(project, notebook), stamp.executed),
        ("the record of its checks", records_path(project, notebook), stamp.records),
    ):
        if hash_now(path) != expected:
            return StampLook(None, f"{what} in the cache {'was changed' if path.exists() else 'is gone'}")
    return StampLook(stamp)


def load(project: Project, notebook: Notebook) -> Stamp | None:
    """The stamp; None where there is none, or what it speaks of is not as it was written."""
    return look(project, notebook).stamp


def save(project: Project, notebook: Notebook, stamp: Stamp) -> None:
    """Write the stamp; exports that are gone are left out."""
    stamp.exports = {path: e for path, e in stamp.exports.items() if Path(path).exists()}
    sealed.write(_stamp_path(project, notebook), asdict(stamp), notebook.id)


def keep(project: Project, notebook: Notebook, executed: bytes, records: list[dict]) -> tuple[str, str]:
    """Keep the executed notebook and its records; the hashes for the stamp, of what was to be written."""
    listed = json.dumps(records, ensure_ascii=False).encode()
    for path, content in ((executed_path(project, notebook), executed), (records_path(project, notebook), listed)):
        atomic.clear(path)
        atomic.write(path, content)
    return of_bytes(executed), of_bytes(listed)


def executed(project: Project, notebook: Notebook) -> dict[str, Any]:
    """The executed notebook of the last good run. Raises EnvironmentProblem where it is not as it was written."""
    return _read(project, notebook, executed_path(project, notebook), "executed")


def records(project: Project, notebook: Notebook) -> list[dict]:
    """The records of the last good run; none where there was none. Raises EnvironmentProblem as `executed` does."""
    return _read(project, notebook, records_path(project, notebook), "records") if load(project, notebook) else []


def _read(project: Project, notebook: Notebook, path: Path, name: str) -> Any:
    stamp = load(project, notebook)
    try:
        content = path.read_bytes()
    except OSError:
        content = b""
    if stamp is None or of_bytes(content) != getattr(stamp, name):
        raise EnvironmentProblem(f"{path} was changed while it was used; build again")
    return json.loads(content)


def forget(project: Project, notebook: Notebook, reports: Mapping[str, Path] | None) -> None:
    """The notebook is not built: its stamp, what is kept of it and the reports named, or known from it, go.

    reports: None where no report will be written: those of the last build stay until there are new ones.
    """
    if reports is not None:
        try:
            known = (sealed.read(_stamp_path(project, notebook), notebook.id) or {}).get("exports", {})
        except sealed.Damaged:
            known = {}
        for path in (*map(Path, known), *reports.values()):
            atomic.remove(path)
    for path in (executed_path(project, notebook), records_path(project, notebook), _stamp_path(project, notebook)):
        atomic.clear(path, also_files=True)
