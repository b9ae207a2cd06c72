"""`loopbook build --watch`: build, wait until a file that matters changes, build again."""

import os
import sys
import time
from pathlib import Path
from typing import Any

from notebook_reports.build.build import build
from notebook_reports.build.job import Wanted
from notebook_reports.build.work import INTERRUPTED
from notebook_reports.project.console import Console
from notebook_reports.project.project import Project, UsageError

PAUSE = 0.4  # s between two looks
PRESS = Path(__file__).parents[1]


def watch(project: Project, names: tuple[str, ...], parameters: Any, wanted: Wanted, options: dict[str, Any]) -> None:
    """Until Ctrl-C. Where something changed that this process has loaded, it starts anew to load that."""
    console = Console()
    while True:
        before = snapshot(project, names)
        try:
            code = build(project, names, parameters, wanted, console=console, **options).code
        except UsageError as error:
            console.line(f"loopbook: {error}")
            code = 2
        if code == INTERRUPTED:
            sys.exit(code)
        console.line("watching; Ctrl-C ends it")
        changed = wait_for_change(project, names, before)
        console.line(f"\nchanged: {_shown(project, changed)}")
        if any(_loaded(p) for p in changed):
            os.execv(sys.executable, [sys.executable, "-P", "-m", "notebook_reports.cli", *sys.argv[1:]])


def _loaded(path: Path) -> bool:
    """Is the file part of the pipeline, a module that it imported, or data that it keeps?"""
    modules = {getattr(module, "__file__", None) for module in list(sys.modules.values())}
    return path.is_relative_to(PRESS) or str(path) in modules or path.suffix == ".toml"


def snapshot(project: Project, names: tuple[str, ...]) -> dict[Path, int]:
    """The time stamps of everything a build may depend on: notebooks, sources, data."""
    folders = [project.notebooks_folder, project.root / "src", PRESS.parent]
    files = {p for folder in dict.fromkeys(folders) if folder.is_dir() for p in folder.rglob("*")}
    files |= {Path(n).resolve() for n in names if n.endswith(".ipynb")}
    files.add(project.root / "environment.txt")
    found = {}
    for path in files:
        if "__pycache__" in path.parts or ".ipynb_checkpoints" in path.parts or path.name.startswith("."):
            continue
        try:
            if path.is_file():
                found[path] = path.stat().st_mtime_ns
        except OSError:
            continue
    return found


def wait_for_change(project: Project, names: tuple[str, ...], before: dict[Path, int]) -> list[Path]:
    """Return what changed, came or went against a snapshot, as soon as something did."""
    while True:
        now = snapshot(project, names)
        changed = [p for p in {**before, **now} if before.get(p) != now.get(p)]
        if changed:
            return sorted(changed)
        time.sleep(PAUSE)


def _shown(project: Project, changed: list[Path]) -> str:
    names = [str(p.relative_to(project.root)) if p.is_relative_to(project.root) else str(p) for p in changed]
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
