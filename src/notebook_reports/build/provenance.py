"""Where reports come from: an in-toto statement beside them, and the comparison with one.

The statement lists every report with its SHA-256, and what they were built from: the commit, the locked environment,
every notebook and every file of the project that a notebook used. It holds no time and nothing of the machine: the
same sources give the same statement. It is not signed; it says what somebody else's build has to agree with.
"""

import json
import platform
import subprocess
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

import click

from notebook_reports.ledger.files import FILES
from notebook_reports.memory import inputs, stamps
from notebook_reports.project import atomic
from notebook_reports.project.printable import printable
from notebook_reports.project.project import Project, UsageError

NAME = "provenance.json"
STATEMENT = "https://in-toto.io/Statement/v1"
PREDICATE = "https://slsa.dev/provenance/v1"
BUILD = "notebook_reports/build/v1"
SHOWN = 10  # lines of what differs


def write(project: Project) -> None:
    """Write the statement of the reports as they are, where it is not what it should be."""
    path = project.reports / NAME
    content = (json.dumps(statement(project), indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()
    if not path.is_file() or path.read_bytes() != content:
        atomic.write(path, content)


def is_of_now(project: Project) -> bool:
    """Is there a statement, of the commit that is checked out? (Of the reports and sources a build knows by itself.)"""
    try:
        told = _read(project.reports / NAME)["predicate"]["buildDefinition"]["resolvedDependencies"]
    except UsageError:
        return False
    commits = [d["digest"]["gitCommit"] for d in told if "gitCommit" in d["digest"]]
    return commits == [c for c in [git_commit(project)] if c]


def withdraw(project: Project) -> None:
    """Remove the statement: not all that it speaks of was built."""
    atomic.remove(project.reports / NAME)


def statement(project: Project) -> dict[str, Any]:
    """The statement as plain data."""
    reports = sorted(p for p in _reports(project) if p.is_file())
    used = sorted(p for p in _sources(project) if p.is_file())
    dependencies = [{"name": _name(project, p), "digest": {"sha256": _hash(p)}} for p in used]
    if commit := git_commit(project):
        dependencies.insert(0, {"name": "git", "digest": {"gitCommit": commit}, "annotations": _changed(project)})
    return {
        "_type": STATEMENT,
        "subject": [
            {"name": p.relative_to(project.reports).as_posix(), "digest": {"sha256": _hash(p)}} for p in reports
        ],
        "predicateType": PREDICATE,
        "predicate": {
            "buildDefinition": {
                "buildType": BUILD,
                "externalParameters": {"command": ["loopbook", "build"]},
                "resolvedDependencies": dependencies,
            },
            "runDetails": {"builder": {"id": "loopbook", "version": _versions()}},
        },
    }


def against(project: Project, file: Path) -> int:
    """Compare the reports and their sources with a statement; prints what differs. The exit code: 1 where a report
    differs or is missing. Raises UsageError for a file that is no statement."""
    told = _read(file)
    wrong = _different(project.reports, told["subject"])
    sources = told["predicate"]["buildDefinition"]["resolvedDependencies"]
    other = _different(project.root, [d for d in sources if "sha256" in d["digest"]])
    for line in [f"report  {line}" for line in wrong[:SHOWN]] + [f"source  {line}" for line in other[:SHOWN]]:
        click.echo(printable(line))
    for number, what in ((len(wrong) - SHOWN, "reports"), (len(other) - SHOWN, "sources")):
        if number > 0:
            click.echo(f"and {number} more {what}")
    total = len(told["subject"])
    told_of = f"{total - len(wrong)} of {total} reports are as {printable(str(file))} says"
    click.echo(f"{told_of}; {f'{len(other)} of their sources here are other ones' if other else 'so are all sources'}")
    return 1 if wrong or not total else 0


def git_commit(project: Project) -> str:
    """The commit checked out in the project's own repository, "" where it has none."""
    top = _git(project, "rev-parse", "--show-toplevel")
    return _git(project, "rev-parse", "HEAD") if top and Path(top).resolve() == project.root else ""


def _changed(project: Project) -> dict[str, Any]:
    """Whether the sources are those of the commit."""
    return {"sources changed since": bool(_git(project, "status", "--porcelain", "--", ".", ":!reports"))}


def _git(project: Project, *arguments: str) -> str:
    try:
        done = subprocess.run(["git", *arguments], cwd=project.root, capture_output=True, text=True, timeout=20)
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def _reports(project: Project) -> set[Path]:
    """The reports of all notebooks, and the pages and tables beside them."""
    found = {project.reports / name for name in FILES.values()}
    found |= {p for p in project.reports.glob("*") if p.suffix in (".pdf", ".html")}
    for notebook in project.notebooks():
        stamp = stamps.load(project, notebook)
        found |= {Path(path) for path in (stamp.exports if stamp else ()) if Path(path).is_relative_to(project.reports)}
    return found


def _sources(project: Project) -> set[Path]:
    found = {project.root / name for name in ("environment.txt", "pyproject.toml", "notebooks/book.toml")}
    for notebook in project.notebooks():
        found.add(notebook.path)
        stamp = stamps.load(project, notebook)
        for one in stamp.inputs if stamp else ():
            path = project.root / one.name
            if one.kind == inputs.FILE and path.is_relative_to(project.root):
                found.add(path)
    return found


def _versions() -> dict[str, str]:
    return {"loopbook": version("loopbook"), "python": platform.python_version()}


def _name(project: Project, path: Path) -> str:
    return path.relative_to(project.root).as_posix()


def _hash(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()


def _different(folder: Path, listed: list[dict[str, Any]]) -> list[str]:
    found = []
    for entry in listed:
        path = folder / entry["name"]
        if not path.is_file():
            found.append(f"{entry['name']} is not there")
        elif _hash(path) != entry["digest"]["sha256"]:
            found.append(f"{entry['name']} is another one")
    return found


def _read(file: Path) -> dict[str, Any]:
    try:
        told = json.loads(file.read_bytes())
        entries = [*told["subject"], *told["predicate"]["buildDefinition"]["resolvedDependencies"]]
        good = told["_type"] == STATEMENT and all(_is_entry(entry) for entry in entries)
    except OSError as error:
        raise UsageError(f"{file}: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, RecursionError):
        good = False
    if not good:
        raise UsageError(f"{file} is no statement of a build; `loopbook build` writes one as reports/{NAME}")
    return told


def _is_entry(entry: Any) -> bool:
    """A name inside the folder, with hashes."""
    name, digest = entry["name"], entry["digest"]
    inside = isinstance(name, str) and not Path(name).is_absolute() and ".." not in Path(name).parts
    return inside and isinstance(digest, dict) and all(isinstance(v, str) for v in digest.values())
