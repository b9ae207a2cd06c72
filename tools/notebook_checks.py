"""The checks of one notebook as data, without a kernel and without the committed ledger.

    python tools/notebook_checks.py notebooks/double_tank/01_model.ipynb [--serve]

Runs the code cells in order in one namespace and prints one JSON object: `records`, what each check decided, by table
and id, and `error`, the exception that ended the run, with its cell, or "". With --serve it does so once for itself,
and then for every line on its input, each time in a fork of its own that reads notebook and printed data anew.
"""

import contextlib
import json
import os
import sys
from pathlib import Path
from typing import Any

PURE = ("behaviour", "study_process")
"""Caches of `loopbook.documents` whose arguments hold all that their results depend on: a loop, a process."""


def run(notebook: Path) -> dict[str, Any]:
    """The records of a notebook's checks, and the error that ended it."""
    import matplotlib

    matplotlib.use("Agg")
    from notebook_reports.ledger.document import Document

    records: dict[str, dict[str, Any]] = {}
    whole = Document._checked

    def seen(self: Document, view: Any, rows: list[Any]) -> Any:
        for row in rows:
            records["/".join(row.key)] = {"verdict": row.verdict, "fails": row.fails, "fields": dict(row.fields)}
        return whole(self, view, rows)

    Document._checked = seen  # type: ignore[method-assign]
    names: dict[str, Any] = {"__name__": "__main__"}
    error = ""
    try:
        for number, cell in enumerate(json.loads(notebook.read_text(encoding="utf-8"))["cells"], 1):
            if cell["cell_type"] == "code":
                with contextlib.redirect_stdout(sys.stderr):
                    exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
    except Exception as problem:
        error = f"cell {number}: {type(problem).__name__}: {problem}"
    finally:
        Document._checked = whole  # type: ignore[method-assign]
    return {"error": error, "records": records}


def forget() -> None:
    """Empty every cache that may hold something of the printed data."""
    for name, module in list(sys.modules.items()):
        if name.startswith("loopbook.documents"):
            for attribute, value in list(vars(module).items()):
                if hasattr(value, "cache_clear") and attribute not in PURE:
                    value.cache_clear()


def serve(notebook: Path) -> None:
    """A JSON object for each line on the input, from a fork in which the modules are loaded already."""
    run(notebook)
    print("ready", flush=True)
    for _ in sys.stdin:
        if not (child := os.fork()):
            forget()
            print(json.dumps(run(notebook)), flush=True)
            os._exit(0)
        os.waitpid(child, 0)


if __name__ == "__main__":
    given = Path(sys.argv[1]).resolve()
    if "--serve" in sys.argv:
        serve(given)
    else:
        print(json.dumps(run(given)))
