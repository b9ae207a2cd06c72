"""`loopbook verify`: two builds of two copies give the same bytes.

They differ in folder, time, number of kernels (one, four), in whether kernels are started afresh or forked, in home,
language, time zone, umask and folder for temporary files; and in user, where this one may become another.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import click

from notebook_reports.project.project import EnvironmentProblem, Project
from notebook_reports.run.warm import PLAIN

KINDS = (".ipynb", ".pdf", ".html", ".csv")
LIMIT = 3600  # s for one build
NOBODY = 65534


@dataclass(frozen=True)
class Copy:
    """One of the builds. home: "" for the root of all files, else a folder made for it. other_user: as nobody."""

    name: str
    jobs: int
    home: str
    language: str
    zone: str
    umask: int
    other_user: bool = False


COPIES = (
    Copy("a", 1, "", "C", "UTC", 0o022),
    Copy(
        "another-folder-with-a-longer-name", 4, "home/of-another", "sv_SE.UTF-8", "Asia/Tokyo", 0o077, other_user=True
    ),
)


def verify(project: Project, names: tuple[str, ...] = ()) -> int:
    """Build twice and compare; prints the hash of every file. Returns the exit code: 1 where two files differ or a
    build failed."""
    with tempfile.TemporaryDirectory(prefix="loopbook-verify-") as folder:
        os.chmod(folder, 0o755)  # for the other user
        hashes = []
        for one in COPIES:
            copy = Path(folder) / one.name
            copy_sources(project, copy)
            code = _build(copy, Path(folder), one, names)
            if code:
                click.echo(f"loopbook verify: the build in {one.name} failed (exit code {code})")
                return 1
            hashes.append(hashes_of(copy / "reports"))
    return report(*hashes)


def copy_sources(project: Project, target: Path) -> None:
    """What git has or would add, as it stands in the working tree; without git everything but what is built."""
    try:
        command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, cwd=project.root, capture_output=True, check=True).stdout.decode()
        names = [n for n in listed.split("\0") if n and (project.root / n).is_file()]
    except (OSError, subprocess.CalledProcessError):
        folders = [project.root / "notebooks", project.root / "src"]
        files = [*project.root.glob("*.*"), *(p for f in folders for p in f.rglob("*"))]
        names = [str(p.relative_to(project.root)) for p in files if p.is_file() and "__pycache__" not in p.parts]
    if not names:
        raise EnvironmentProblem(f"nothing to copy from {project.root}")
    for name in names:
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(project.root / name, target / name)


def hashes_of(folder: Path) -> dict[str, str]:
    """sha256 by relative path of every report and table."""
    files = sorted(p for p in folder.rglob("*") if p.suffix in KINDS)
    return {p.relative_to(folder).as_posix(): sha256(p.read_bytes()).hexdigest() for p in files}


def report(first: dict[str, str], second: dict[str, str]) -> int:
    """Print the list and what differs; the exit code."""
    different = []
    for name in sorted({**first, **second}):
        equal = first.get(name) == second.get(name)
        click.echo(f"{first.get(name, '-' * 64)}  {name}" + ("" if equal else "   DIFFERS"))
        different += [] if equal else [name]
    if not first:
        click.echo("loopbook verify: nothing was built")
        return 1
    if different:
        click.echo(f"{len(different)} of {len(first)} files differ: {', '.join(different[:5])}")
        return 1
    click.echo(f"{len(first)} files, equal in both folders")
    return 0


def _build(copy: Path, folder: Path, one: Copy, names: tuple[str, ...]) -> int:
    """Build a copy as it says; the exit code."""
    home = folder / one.home if one.home else Path("/")
    temporary = folder / f"t{one.jobs}"
    for made in (home, temporary):
        made.mkdir(parents=True, exist_ok=True)
    user = _other_user() if one.other_user else None
    if user is not None:
        for path in (*(p for p in folder.rglob("*") if p.is_relative_to(copy)), copy, home, temporary):
            os.chown(path, user, user)
    who = "another user" if user is not None else "the same user"
    click.echo(f"building in {copy} with -j{one.jobs}, home {home}, {who}, {one.language}, umask {one.umask:03o}")
    told = {"HOME": str(home), "LC_ALL": one.language, "LANGUAGE": one.language[:2], "TZ": one.zone}
    environment = {**os.environ, **told, "TMPDIR": str(temporary), "PYTHONPATH": str(copy / "src")}
    environment |= {PLAIN: "1"} if one.jobs == 1 else {}
    press = [
        sys.executable,
        "-P",
        "-m",
        "notebook_reports.cli",
        "--root",
        str(copy),
    ]
    rights: dict[str, Any] = {} if user is None else {"user": user, "group": user, "extra_groups": []}
    options: dict[str, Any] = {"cwd": copy, "env": environment, "umask": one.umask, "timeout": LIMIT, **rights}
    return subprocess.run(
        [*press, "build", f"-j{one.jobs}", *names], stdout=sys.stderr, check=False, **options
    ).returncode


def _other_user() -> int | None:
    """The number of another user as whom this Python runs; None where there is none: not root, or it is not his to
    read."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        return None
    command = [sys.executable, "-P", "-c", "import click, nbformat"]
    try:
        done = subprocess.run(command, user=NOBODY, group=NOBODY, extra_groups=[], capture_output=True, cwd="/")
    except OSError:
        return None
    return NOBODY if done.returncode == 0 else None
