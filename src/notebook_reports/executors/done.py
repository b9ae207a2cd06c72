"""What was done stays done: a run of many jobs that was broken off goes on where it ended.

Beside the files of each job stands a record of it. It is used where job, sources, packages and the
files themselves are what they were; whatever was changed or damaged is done again.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from notebook_reports.executors.sources import fingerprint
from notebook_reports.project import atomic

FOLDER = ".done"


class DoneJobs:
    """The records in one folder. Files are named by their path below `root`. packages: see `fingerprint`."""

    def __init__(self, root: Path, folder: Path, packages: Sequence[str]):
        self._root, self._folder, self._packages = root, folder, tuple(packages)

    def find(self, place: str, job: Any) -> dict[str, Any] | None:
        """What was noted of this very job, if its files are all there as they were written."""
        try:
            record = json.loads((self._folder / f"{place}.json").read_bytes())
            if record["seal"] != _seal(record["job"], record["noted"], record["files"]) or record["job"] != self._of(
                job
            ):
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
        of = self._of(job)
        record = {"job": of, "noted": noted, "files": digests, "seal": _seal(of, noted, digests)}
        atomic.write(self._folder / f"{place}.json", json.dumps(record, indent=1, ensure_ascii=False).encode())

    def _of(self, job: Any) -> str:
        return hashlib.sha256(repr((job, sorted(fingerprint(self._packages).items()))).encode()).hexdigest()


def _seal(*parts: Any) -> str:
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
