"""A notebook run in this process, as a kernel would run it: for one that is trusted and runs a thousand times.

What a kernel costs (its start, its messages) is saved; the canonical record is the same, see `canonical`. Only for
notebooks of an installed package: they may do here what this process may do.
"""

import ast
import io
import json
from collections.abc import Mapping
from contextlib import chdir, redirect_stdout
from typing import Any

from notebook_reports.project.project import Project
from notebook_reports.project.source import Source
from notebook_reports.run.canonical import canonical, dump
from notebook_reports.run.filled import filled
from notebook_reports.run.run import loaded

_LAST = "__last__"


def run_here(source: Source, project: Project, parameters: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The canonical record. Raises what a cell raises. The current folder is the notebook's while it runs."""
    notebook = loaded(source, parameters)
    space: dict[str, Any] = {"__name__": "__main__"}
    folder = source.path.parent
    with chdir(folder):
        number = 0
        for cell in notebook["cells"]:
            if cell["cell_type"] != "code" or not cell["source"].strip():
                continue
            number += 1
            cell["execution_count"] = number
            cell["outputs"] = _run(cell["source"], space, number)
    _close_figures()
    elsewhere = None if folder.is_relative_to(project.root) else folder
    executed = canonical(notebook, project.root, [c.id for c in source.cells], elsewhere)
    content: dict[str, Any] = json.loads(dump(filled(executed, source, parameters)))
    return content


def _run(text: str, space: dict[str, Any], number: int) -> list[dict[str, Any]]:
    tree = ast.parse(text)
    if tree.body and isinstance(last := tree.body[-1], ast.Expr):
        tree.body[-1] = ast.Assign([ast.Name(_LAST, ast.Store())], last.value)
        ast.fix_missing_locations(tree)
    said = io.StringIO()
    with redirect_stdout(said):
        exec(compile(tree, f"<cell {number}>", "exec"), space)
    value = space.pop(_LAST, None)
    outputs = [{"output_type": "stream", "name": "stdout", "text": said.getvalue()}] if said.getvalue() else []
    return [*outputs, *([_shown(value, number)] if value is not None else [])]


def _shown(value: Any, number: int) -> dict[str, Any]:
    from IPython.core.formatters import DisplayFormatter

    own = getattr(value, "_repr_mimebundle_", None)
    found = own() if own is not None else DisplayFormatter().format(value)
    data, metadata = found if isinstance(found, tuple) else (found, {})
    return {"output_type": "execute_result", "execution_count": number, "data": data, "metadata": metadata}


def _close_figures() -> None:
    from matplotlib import pyplot

    pyplot.close("all")
