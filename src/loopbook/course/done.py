"""What was done stays done: a release or a grading that was broken off goes on where it ended.

Beside each student's files stands a record of the job they came of. It is used where job, sources, packages and the
files themselves are what they were; whatever was changed or damaged is done again.
"""

import hashlib
import importlib.metadata
import json
import platform
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from notebook_reports.project import atomic

FOLDER = ".done"
PACKAGES = ("numpy", "scipy", "sympy", "matplotlib", "nbformat", "nbconvert", "typst", "fonttools")


@cache
def fingerprint() -> dict[str, str]:
    """What results depend on beside their job: our sources, Python, the packages."""
    source, digest = Path(__file__).parents[2], hashlib.sha256()
    for package in ("derivations", "loopbook", "notebook_reports"):
        for path in sorted(p for p in (source / package).rglob("*") if p.is_file() and p.suffix != ".pyc"):
            digest.update(path.relative_to(source).as_posix().encode() + b"\0" + path.read_bytes())
    versions = {name: importlib.metadata.version(name) for name in PACKAGES}
    return {"loopbook's sources": digest.hexdigest()[:12], "Python": platform.python_version(), **versions}


class DoneJobs:
    """The records in one folder. Files are named by their path below `root`."""

    def __init__(self, root: Path, folder: Path):
        self._root, self._folder = root, folder

    def find(self, place: str, job: Any) -> dict[str, Any] | None:
        """What was noted of this very job, if its files are all there as they were written."""
        try:
            record = json.loads((self._folder / f"{place}.json").read_bytes())
            if record["seal"] != _seal(record["job"], record["noted"], record["files"]) or record["job"] != _of(job):
                return None
            for name, digest in record["files"].items():
                if hashlib.sha256((self._root / name).read_bytes()).hexdigest() != digest:
                    return None
        except (OSError, ValueError, KeyError, TypeError):
            return None
        noted: dict[str, Any] = record["noted"]
        return noted

    def note(self, place: str, job: Any, noted: Mapping[str, Any], files: Mapping[str, bytes]) -> None:
        """Keep that the job was done. noted: plain data; files: what was written, by name."""
        digests = {name: hashlib.sha256(content).hexdigest() for name, content in sorted(files.items())}
        of = _of(job)
        record = {"job": of, "noted": noted, "files": digests, "seal": _seal(of, noted, digests)}
        atomic.write(self._folder / f"{place}.json", json.dumps(record, indent=1, ensure_ascii=False).encode())


def _of(job: Any) -> str:
    return hashlib.sha256(repr((job, sorted(fingerprint().items()))).encode()).hexdigest()


def _seal(*parts: Any) -> str:
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
