"""`loopbook verify`: two builds of two copies give the same bytes.

They differ in folder, time, number of kernels (one, four), and in whether kernels are started afresh or forked.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from hashlib import sha256
from pathlib import Path

import click

from notebook_reports.project.project import EnvironmentProblem, Project
from notebook_reports.run.warm import PLAIN

KINDS = (".ipynb", ".pdf", ".html", ".csv")
COPIES = (("a", 1), ("another-folder-with-a-longer-name", 4))


def verify(project: Project, names: tuple[str, ...] = ()) -> int:
    """Build twice and compare; prints the hash of every file. Returns the exit code: 1 where two files differ or a
    build failed."""
    with tempfile.TemporaryDirectory(prefix="loopbook-verify-") as folder:
        hashes = []
        for name, jobs in COPIES:
            copy = Path(folder) / name
            copy_sources(project, copy)
            click.echo(f"building in {copy} with -j{jobs}")
            code = _build(copy, jobs, names)
            if code:
                click.echo(f"loopbook verify: the build in {name} failed (exit code {code})")
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


def _build(copy: Path, jobs: int, names: tuple[str, ...]) -> int:
    environment = {**os.environ, "PYTHONPATH": str(copy / "src"), **({PLAIN: "1"} if jobs == 1 else {})}
    command = [sys.executable, "-m", "notebook_reports.cli", "--root", str(copy), "build", f"-j{jobs}", *names]
    return subprocess.run(command, cwd=copy, env=environment, stdout=sys.stderr).returncode
