"""Five hundred trivial notebooks, eight kernels at a time: does the machinery itself ever fail?

LOOPBOOK_BENCH_KERNELS sets the number of notebooks, LOOPBOOK_BENCH_ROUNDS the rounds; the defaults take some minutes.
"""

import io
import json
import os
import tempfile
import time
from pathlib import Path

from notebook_reports.build.build import build
from notebook_reports.build.job import Wanted
from notebook_reports.project.console import Console
from notebook_reports.project.project import project_at
from notebook_reports.run.warm import PLAIN, possible

NUMBER = int(os.environ.get("LOOPBOOK_BENCH_KERNELS", "500"))
ROUNDS = int(os.environ.get("LOOPBOOK_BENCH_ROUNDS", "3"))


def rows() -> list[tuple[str, float | str, str]]:
    ways = [("fresh kernels", "1"), *([("forked kernels", "")] if possible() else [])]
    result: list[tuple[str, float | str, str]] = []
    with tempfile.TemporaryDirectory(prefix="loopbook-bench-") as folder:
        project = project_at(Path(folder))
        project.notebooks_folder.mkdir()
        for i in range(NUMBER):
            cell = {"cell_type": "code", "id": "a", "metadata": {}, "execution_count": None, "outputs": []}
            content = {"cells": [{**cell, "source": f"{i} + 1"}], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
            (project.notebooks_folder / f"n{i:04}.ipynb").write_text(json.dumps(content))
        for name, plain in ways:
            os.environ[PLAIN] = plain
            for _ in range(ROUNDS):
                start = time.perf_counter()
                wanted = Wanted(formats=(), force=True)
                outcome = build(project, wanted=wanted, jobs=8, console=Console(io.StringIO()), ledger=False)
                remark = f"{len(outcome.done)} run, {len(outcome.failures)} failed"
                result.append((f"{NUMBER} notebooks, 8 {name}", time.perf_counter() - start, remark))
        os.environ.pop(PLAIN)
    return result
