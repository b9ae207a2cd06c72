"""What a notebook depends on beside its own code: as its kernel saw it, and as the notebook declares it.

An input is a kind and a name: the content of a file, the names in a folder, whether something exists, its size and
time, a variable of the environment. The kernel sees what goes through Python (see `kernel_side`). It does not see what
another program reads, nor the network: the build says so, and a notebook says in its metadata what it depends on::

    "loopbook": {"inputs": ["../data/record.csv", "../data/", "$PLANT"]}

names relative to its folder, of a folder all that lies in it, a variable with a dollar. ``"inputs": []`` says that
there is nothing more.
"""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from notebook_reports.memory.hashes import hash_file, hash_folder, of_bytes
from notebook_reports.project.project import Project, UsageError
from notebook_reports.project.source import Source
from notebook_reports.run.surroundings import environment, passed_on

PRESS = Path(__file__).parents[1]
FILE, FOLDER, EXISTS, STAT, VARIABLE = KINDS = ("file", "folder", "exists", "stat", "variable")
CHANGED = "changed during the run"


@dataclass(frozen=True, order=True)
class Input:
    """kind: one of `KINDS`. name: of a path, relative to the project where it lies in it; of a variable, its name."""

    name: str
    kind: str

    @property
    def label(self) -> str:
        """How the reason for a build calls it."""
        forms = {FOLDER: "{}/", EXISTS: "whether {} exists", STAT: "size and time of {}", VARIABLE: "${}"}
        return forms.get(self.kind, "{}").format(self.name)

    def print(self, project: Project, since: int | None = None) -> str:
        """Its hash now. since: when a run began, in ns; of a file changed later nobody knows what was read."""
        if self.kind == VARIABLE:
            value = environment(project).get(self.name)
            return "" if value is None else of_bytes(value.encode("utf-8", "surrogateescape"))
        path = project.root / self.name  # an absolute name stays absolute
        if self.kind == FOLDER:
            return hash_folder(path)
        try:
            found = path.stat()
        except (OSError, ValueError):
            return ""
        if self.kind == EXISTS:
            return "folder" if path.is_dir() else "file"
        if self.kind == STAT:
            return f"{found.st_size} {found.st_mtime_ns} {found.st_mode}"
        return CHANGED if since is not None and found.st_mtime_ns > since else hash_file(path)


def seen(project: Project, source: Source, depends: dict[str, Any], press: Iterable[str]) -> list[Input]:
    """The inputs in a kernel's report, without the notebook itself and the cache.

    press: the parts of the press whose code every stamp holds anyway, as paths below it.
    """
    parts = [PRESS / part for part in press]
    found = {Input(name, VARIABLE) for name in depends.get("variables", ()) if passed_on(name)}
    for text in depends.get("modules", ()):
        path = Path(text)
        if not any(path.is_relative_to(part) for part in parts):
            found.add(Input(_name(project, path), FILE))
    for text, told in depends.get("read", {}).items():
        path = Path(text)
        if path == source.path or path.is_relative_to(project.cache) or path.is_relative_to(PRESS):
            continue
        if "__pycache__" not in path.parts:
            found |= {Input(_name(project, path), kind) for kind in told["kinds"]}
    return sorted(found)


def declares(source: Source) -> bool:
    """Does the notebook say what it depends on, be it that there is nothing more?"""
    told = (source.content.get("metadata") or {}).get("loopbook")
    return isinstance(told, dict) and "inputs" in told


def declared(project: Project, source: Source) -> list[Input]:
    """The inputs that the notebook's metadata names. Raises UsageError where they are no list of names or are not
    there."""
    if not declares(source):
        return []
    told = source.content["metadata"]["loopbook"]["inputs"]
    if not isinstance(told, list) or not all(isinstance(name, str) and name.strip("$/ ") for name in told):
        raise UsageError(
            f"{source.path}: metadata.loopbook.inputs is a list of file names and $VARIABLES, got {told!r}"
        )
    return [found for name in told for found in _declared(project, source, name)]


def _declared(project: Project, source: Source, name: str) -> list[Input]:
    if name.startswith("$"):
        return [Input(name[1:], VARIABLE)]
    path = Path(os.path.abspath(source.path.parent / os.path.expanduser(name)))
    if not path.exists():
        raise UsageError(f"{source.path}: its metadata declares the input {name}, which is not there")
    if not path.is_dir():
        return [Input(_name(project, path), FILE)]
    return [Input(_name(project, p), FOLDER if p.is_dir() else FILE) for p in sorted((path, *path.rglob("*")))]


def outside(project: Project, source: Source, depends: dict[str, Any]) -> list[tuple[int, str]]:
    """What of a run is not seen, or lies where no copy of the project would have it: (number among the cells that ran,
    sentence)."""
    told = [(at, f"reads from {host}: what changes there is not seen") for host, at in depends.get("network", ())]
    if not declares(source):
        cure = 'name it in the notebook\'s metadata, "loopbook": {"inputs": […]}'
        for text, read in depends.get("read", {}).items():
            path = Path(text)
            homes = (project.root, source.path.parent, PRESS.parent)
            if not any(path.is_relative_to(home) for home in homes) and {FILE, FOLDER} & set(read["kinds"]):
                told.append((read["at"], f"reads {path}, outside its project: keep it in the project, or {cure}"))
        for command, at in depends.get("programs", ()):
            told.append((at, f"runs {command}: what that reads is not seen, {cure}"))
    return sorted(told)


def _name(project: Project, path: Path) -> str:
    return path.relative_to(project.root).as_posix() if path.is_relative_to(project.root) else path.as_posix()
