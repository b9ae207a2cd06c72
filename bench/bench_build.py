"""All reports from nothing, beside papermill and jupyter nbconvert called one after the other.

Both work on the same copy of the project's notebooks. What the stock commands leave out (the ledger, the executed
notebook beside the report, equal bytes) is not counted against them. LOOPBOOK_BENCH_NOTEBOOKS=3 takes the first three.
"""

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from notebook_reports.build.verify import copy_sources
from notebook_reports.project.project import Project, project_at

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
Row = tuple[str, float | str, str]


def rows() -> list[Row]:
    with tempfile.TemporaryDirectory(prefix="loopbook-bench-") as folder:
        copy = Path(folder) / "project"
        copy_sources(project_at(ROOT), copy)
        project = project_at(copy)
        limit = int(os.environ.get("LOOPBOOK_BENCH_NOTEBOOKS", "0"))
        for notebook in project.notebooks()[limit:] if limit else []:
            notebook.path.unlink()
        ours, stock = _ours(project), _stock(project, Path(folder))
        ratio = ("  how many times as long as ours, PDFs included", f"{stock[0][1] / ours[0][1]:.1f}", "")
        return [*ours, stock[0], ratio, *stock[1:], *_exports(project)]


def _ours(project: Project) -> list[Row]:
    number = len(project.notebooks())
    seconds, memory, largest = [], [], []
    for _ in range(3):
        shutil.rmtree(project.cache, ignore_errors=True)
        shutil.rmtree(project.reports, ignore_errors=True)
        taken, total, most, code = _watched(project, "build")
        seconds.append(taken)
        memory.append(total)
        largest.append(most)
    remark = f"{number} notebooks, PDF, HTML and ipynb; exit code {code}"
    idle = [_watched(project, "build")[0] for _ in range(7)]
    return [
        ("loopbook build, from nothing (median of 3)", statistics.median(seconds), remark),
        ("  memory of all its processes at the peak", f"{max(memory) / 1e6:.0f} MB", "proportional set size"),
        ("  the largest of them", f"{max(largest) / 1e6:.0f} MB", ""),
        ("loopbook build, nothing to do (median of 7)", statistics.median(idle), ""),
    ]


def _watched(project: Project, *command: str) -> tuple[float, int, int, int]:
    """(seconds, peak memory of the whole tree, of its largest process, exit code) of one command."""
    environment = {**os.environ, "PYTHONPATH": str(project.root / "src")}
    start = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "loopbook.cli", "--root", str(project.root), *command],
        cwd=project.root,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    ended = threading.Event()
    peaks = [0, 0]
    watcher = threading.Thread(target=_watch_memory, args=(process.pid, ended, peaks))
    watcher.start()
    code = process.wait()
    seconds = time.perf_counter() - start
    ended.set()
    watcher.join()
    return seconds, peaks[0], peaks[1], code


def _watch_memory(pid: int, ended: threading.Event, peaks: list[int]) -> None:
    """Shared pages counted once, divided among those who share them, where the system tells."""
    import psutil

    while not ended.wait(0.25):
        try:
            tree = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
            sizes = []
            for process in tree:
                info = process.memory_full_info()
                sizes.append(getattr(info, "pss", 0) or info.rss)
        except psutil.Error:
            continue
        peaks[:] = max(peaks[0], sum(sizes)), max(peaks[1], *sizes)


def _stock(project: Project, folder: Path) -> list[Row]:
    """papermill, then nbconvert, for one notebook after the other; a command that fails is not counted in a sum."""
    steps = ["papermill", "nbconvert --to html", *(["nbconvert --to pdf"] if shutil.which("xelatex") else [])]
    seconds, failed = dict.fromkeys(steps, 0.0), dict.fromkeys(steps, 0)
    environment = {**os.environ, "PYTHONPATH": str(project.root / "src")}
    for notebook in project.notebooks():
        ran = folder / f"{notebook.id.replace('/', '-')}.ipynb"
        for step in steps:
            command = [BIN / "jupyter", *step.split(), ran]
            if step == "papermill":
                command = [BIN / "papermill", "--no-progress-bar", "--cwd", notebook.path.parent, notebook.path, ran]
            start = time.perf_counter()
            good = subprocess.run(command, env=environment, capture_output=True).returncode == 0
            seconds[step] += good * (time.perf_counter() - start)
            failed[step] += not good
    count = len(project.notebooks())
    rows = [("papermill and nbconvert --to html, in turn", seconds[steps[0]] + seconds[steps[1]], "the alternative")]
    for step in steps:
        name = f"  of which {step}" if step in steps[:2] else step
        taken = seconds[step] if failed[step] < count else "none"
        rows.append((name, taken, f"{failed[step]} of {count} failed" if failed[step] else ""))
    return rows


def _exports(project: Project) -> list[Row]:
    """The export of each executed notebook in a running process, after one to warm up."""
    import nbformat

    from notebook_reports.export.exporters.choose import ExportError, export
    from notebook_reports.memory import stamps

    nodes = []
    for notebook in project.notebooks():
        path = stamps.executed_path(project, notebook)
        if path.exists():
            nodes.append((notebook, nbformat.reads(path.read_text(encoding="utf-8"), 4)))
    result: list[Row] = []
    for format in ("pdf", "html"):
        seconds = []
        for notebook, node in [*nodes[:1], *nodes]:
            start = time.perf_counter()
            try:
                export(node, format, name=notebook.id, document=notebook.folder)
            except ExportError:
                continue
            seconds.append(time.perf_counter() - start)
        if len(seconds) > 1:
            remark = f"median of {len(seconds) - 1}; the slowest {max(seconds[1:]):.2f} s"
            result.append((f"export of one report to {format}", statistics.median(seconds[1:]), remark))
    return result
