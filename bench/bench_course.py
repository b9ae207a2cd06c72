"""A class of 240: one sheet released with keys and PDFs, answers by hand, graded with feedback, exported."""

import ctypes
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests" / "loopbook" / "course" / "proof"))
import class_of  # noqa: E402

STUDENTS, SHEET = 240, "step_test"
LOOPBOOK = Path(sys.executable).parent / "loopbook"


def timed(*words: object) -> tuple[float, float]:
    """Seconds of the clock and of the processors for `loopbook course ...`."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run([LOOPBOOK, "course", *map(str, words)], cwd=ROOT, capture_output=True, text=True)
    with suppress(ChildProcessError):
        while True:  # the workers, which end a moment after the command
            os.wait()
    if done.returncode:
        raise SystemExit(f"course {words[0]}: {done.stdout}{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = sum(getattr(after, n) - getattr(before, n) for n in ("ru_utime", "ru_stime"))
    return time.monotonic() - began, used


def adopt() -> None:
    """Become the parent of what a command leaves behind, so that its seconds are counted (Linux)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER


def rows() -> Iterator[tuple[str, float | str, str]]:
    """(what, seconds, remark)."""
    adopt()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        ids = class_of.roster(STUDENTS, folder / "roster.csv")
        (folder / "secret").write_text("a secret for a bench of a class\n")
        out, load = folder / "out", f"load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
        given = ("--students", folder / "roster.csv", "--secret", folder / "secret", "-o", out)
        wall, used = timed("release", SHEET, *given)
        yield (
            f"release to {STUDENTS}: notebooks, PDFs, keys",
            wall,
            f"{used:.0f} s of processors; {load}; wanted: below 180 s",
        )
        numbers = json.loads((out / "teacher" / "manifest.json").read_text())["sheets"][SHEET]["numbers"]
        began = time.monotonic()
        done = class_of.write_submissions(out, SHEET, ids, numbers, folder / "in")
        yield f"{len(done)} answers by hand", time.monotonic() - began, "right, rounded, every wrong method, garbage"
        wall, used = timed("grade", folder / "in", "--release", out, "-o", folder / "grades")
        feedback = len(list((folder / "grades" / "feedback").rglob("*.pdf")))
        yield (
            f"grade {feedback} with feedback as PDF and HTML",
            wall,
            f"{used:.0f} s of processors; wanted: below 600 s",
        )
        wall, used = timed("export", SHEET, "--format", "moodle", "-o", folder / "m.xml", "--variants", STUDENTS)
        yield f"export {STUDENTS} variants as Moodle XML", wall, f"{(folder / 'm.xml').stat().st_size / 1e6:.1f} MB"
