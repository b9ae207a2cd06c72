"""The checks of one notebook as data, without a kernel and without the committed ledger.

    python tools/notebook_checks.py notebooks/double_tank/01_model.ipynb

Runs the code cells in order in one namespace and prints one JSON object: `records`, what each check decided, by table
and id, and `error`, the exception that ended the run, with its cell, or "".
"""

import json
import sys
from pathlib import Path
from typing import Any


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
                exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
    except Exception as problem:
        error = f"cell {number}: {type(problem).__name__}: {problem}"
    finally:
        Document._checked = whole  # type: ignore[method-assign]
    return {"error": error, "records": records}


if __name__ == "__main__":
    print(json.dumps(run(Path(sys.argv[1]).resolve())))
