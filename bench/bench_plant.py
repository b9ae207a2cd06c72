"""Designs among many: seconds of a processor for one record, in a process that has derived what all derive alike."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from notebook_reports.executors.executor import surroundings

RECORDS = 50
ACCEPTANCE = Path(__file__).parents[1] / "tests" / "loopbook" / "design" / "acceptance"
PROGRAM = """
import sys, time
from pathlib import Path
import loopbook.design.plant.warm
from loopbook.design.plant.one import DesignJob, design_one
for formats, page in ((("json",), False), (("json", "pdf"), True), (("json", "pdf"), False)):
    began = time.process_time()
    for path in map(Path, sys.argv[1:]):
        stems = tuple((format, f"{path.stem}-design") for format in formats)
        design_one(DesignJob(path.stem, path.name, path.read_bytes(), stems, page=page))
    print((time.process_time() - began) / len(sys.argv[1:]), flush=True)
"""
NAMES = ("a record as JSON", "a record as JSON and its first page", "a record as JSON and PDF")
WANTED = ("0.7 s", "1.3 s", "1.3 s")


def rows() -> Iterator[tuple[str, float | str, str]]:
    """(what, seconds, remark)."""
    sys.path.insert(0, str(ACCEPTANCE))
    from prove_plant import sound

    with tempfile.TemporaryDirectory() as name:
        files = sound(RECORDS, Path(name))
        with surroundings():
            command = [sys.executable, "-P", "-c", PROGRAM, *map(str, files)]
            done = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ), check=True)
    for what, seconds, wanted in zip(NAMES, done.stdout.split(), WANTED, strict=True):
        yield what, float(seconds), f"of a processor, {RECORDS} records; wanted: below {wanted}"
