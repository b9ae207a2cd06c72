"""`loopbook doctor`: is the environment as it should be? One line per question, and how to mend what is not."""

import importlib.util
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

from notebook_reports.project import runtime
from notebook_reports.project.project import Project
from notebook_reports.project.source import Source, SourceCell

OLDEST = (3, 11)
NEEDED = (
    "papermill",
    "nbclient",
    "nbconvert",
    "ipykernel",
    "typst",
    "sympy",
    "numpy",
    "scipy",
    "control",
    "matplotlib",
)
Answer = tuple[str, str, str]  # "ok", "note" or "FAIL"; the question; the finding


def examine(project: Project) -> Iterator[Answer]:
    """The answers, one after the other."""
    questions: list[tuple[str, Callable[[Project], tuple[str, str]]]] = [
        ("Python", _python),
        ("packages", _packages),
        ("locked versions", _locked),
        ("loopbook", _loopbook),
        ("folders", _folders),
        ("disk", _disk),
        ("kernel", _kernel),
        ("PDF engine", _typst),
    ]
    for name, question in questions:
        try:
            verdict, found = question(project)
        except Exception as error:
            verdict, found = "FAIL", f"{type(error).__name__}: {error}"
        yield verdict, name, found


def _python(_: Project) -> tuple[str, str]:
    version = sys.version.split()[0]
    if sys.version_info < OLDEST:
        return "FAIL", f"{version}; 3.11 or newer is needed: make clean, then make PYTHON=/path/to/python3"
    return "ok", f"{version} in {sys.prefix}"


def _packages(_: Project) -> tuple[str, str]:
    absent = [n for n in NEEDED if importlib.util.find_spec(n) is None]
    return ("FAIL", f"missing: {', '.join(absent)}; run make") if absent else ("ok", f"{len(NEEDED)} found")


def _locked(project: Project) -> tuple[str, str]:
    path = project.root / "environment.txt"
    if not path.exists():
        return "note", "no environment.txt here"
    wrong, right = [], 0
    for line in path.read_text(encoding="utf-8").splitlines():
        found = re.match(r"([A-Za-z0-9_.-]+)==([^\s;\\]+)", line)
        if not found:
            continue
        try:
            installed = metadata.version(found[1])
        except metadata.PackageNotFoundError:
            continue  # for another system or another Python
        if installed == found[2]:
            right += 1
        else:
            wrong.append(f"{found[1]} {installed}, locked {found[2]}")
    if wrong:
        return "FAIL", f"{'; '.join(wrong[:3])}{' …' if len(wrong) > 3 else ''}: run make clean, then make"
    return "ok", f"{right} packages as locked"


def _loopbook(project: Project) -> tuple[str, str]:
    own = project.root / "src"
    used = __file__
    if own.is_dir() and not used.startswith(str(own)):
        return "note", f"{used} runs, not this project's src"
    return "ok", f"{metadata.version('loopbook')} from {Path(__file__).parents[2]}"


def _folders(project: Project) -> tuple[str, str]:
    for folder in (project.reports, project.cache):
        there = next(path for path in (folder, *folder.parents) if path.exists())
        if not (there.is_dir() and os.access(there, os.W_OK | os.X_OK)):
            return "FAIL", f"{there} cannot be written; choose another folder with -o DIR"
    return "ok", f"{project.reports} and {project.cache} can be written"


def _disk(project: Project) -> tuple[str, str]:
    free = shutil.disk_usage(project.root).free / 1e9
    return ("ok" if free > 0.5 else "FAIL"), f"{free:.1f} GB free" + ("" if free > 0.5 else "; 0.5 GB are needed")


def _kernel(project: Project) -> tuple[str, str]:
    from notebook_reports.run import kernels
    from notebook_reports.run.run import run_notebook

    text = "1 + 1"
    cell: dict[str, Any] = {
        "cell_type": "code",
        "id": "one",
        "metadata": {},
        "source": text,
        "outputs": [],
        "execution_count": None,
    }
    content = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    started = time.monotonic()
    with tempfile.TemporaryDirectory(dir=runtime.folder()) as folder:
        elsewhere = replace(project, cache=Path(folder))
        done = run_notebook(
            Source(Path(folder) / "x.ipynb", (SourceCell(1, "one", "code", text, (), ""),), content),
            "doctor",
            elsewhere,
        )
    runtime.tidy()
    if done.failure:
        return "FAIL", done.failure.line
    return "ok", f"starts, computes and ends in {time.monotonic() - started:.1f} s over {kernels.TRANSPORT}"


def _typst(_: Project) -> tuple[str, str]:
    import typst

    made = typst.compile(b"#set document(title: [x])\n$ integral_0^1 x dif x $", format="pdf")
    if not made.startswith(b"%PDF"):
        return "FAIL", "typst made no PDF; run make clean, then make"
    return "ok", f"typst {metadata.version('typst')} makes a PDF"
