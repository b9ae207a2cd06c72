"""The canonical form of an executed notebook: the same content gives the same bytes, on every run and machine.

Dropped: times, durations, paths of the run, versions of the kernel. Made regular: the order of streams within a cell,
and what a machine writes and another would write otherwise, see `masks`.
"""

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from notebook_reports.project.source import INJECTED
from notebook_reports.run.masks import Masks

_ANSI = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
_TEXT = {"text/plain": False, "text/html": True, "text/markdown": True, "text/latex": False}
"""Forms that are text to be read, and whether they are markup."""


def canonical(notebook: Any, root: Path, ids: Sequence[str], folder: Path | None = None) -> dict[str, Any]:
    """The canonical form, as plain data.

    notebook: an executed notebook (nbformat's node or its dictionary). root: the project's folder, folder: that of a
    notebook from elsewhere; both are cut off paths. ids: of the cells as written, in order; a notebook without ids
    would else get random ones.
    """
    masks = Masks(root, folder)
    names = iter(ids)
    cells = []
    for cell in json.loads(json.dumps(notebook["cells"])):
        metadata = {k: v for k, v in cell["metadata"].items() if k not in ("papermill", "execution")}
        if not metadata.get("tags", True):
            del metadata["tags"]
        id = INJECTED if INJECTED in metadata.get("tags", ()) else next(names)
        kept = {"cell_type": cell["cell_type"], "id": id, "metadata": metadata, "source": _join(cell["source"])}
        if cell.get("attachments"):
            kept["attachments"] = cell["attachments"]
        if cell["cell_type"] == "code":
            kept["execution_count"] = cell.get("execution_count")
            kept["outputs"] = [_output(o, masks) for o in _streams(cell.get("outputs", []))]
        cells.append(kept)
    metadata = {k: v for k, v in notebook["metadata"].items() if k not in ("papermill", "widgets")}
    metadata["kernelspec"] = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata["language_info"] = {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"}
    return {"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def dump(content: dict[str, Any]) -> bytes:
    """The bytes of a notebook file."""
    return (json.dumps(content, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def renew_prose(executed: dict[str, Any], source: dict[str, Any]) -> dict[str, Any]:
    """The executed notebook with the prose of the source: for a change that runs nothing.

    The code cells of both must be the same, in order; an injected cell of the executed one is kept in its place.
    """
    outputs = [c for c in executed["cells"] if c["cell_type"] == "code"]
    cells = []
    for cell in source["cells"]:
        if cell["cell_type"] == "code":
            ran = outputs.pop(0)
            cells.append({**cell, "execution_count": ran["execution_count"], "outputs": ran["outputs"]})
            while outputs and INJECTED in outputs[0]["metadata"].get("tags", ()):
                cells.append(outputs.pop(0))
        else:
            cells.append(cell)
    return {**executed, "cells": cells, "metadata": {**source["metadata"]}}


def _join(text: Any) -> str:
    return text if isinstance(text, str) else "".join(text)


def _streams(outputs: list[dict]) -> list[dict]:
    """Between two other outputs one stdout and one stderr: how they were cut and interleaved is chance."""
    result: list[dict] = []
    waiting: dict[str, str] = {}

    def flush() -> None:
        for name in sorted(waiting, reverse=True):
            result.append({"output_type": "stream", "name": name, "text": waiting[name]})
        waiting.clear()

    for output in outputs:
        if output["output_type"] == "stream":
            waiting[output["name"]] = waiting.get(output["name"], "") + _join(output["text"])
        else:
            flush()
            result.append(output)
    flush()
    return result


def _output(output: dict, masks: Masks) -> dict:
    kind = output["output_type"]
    if kind == "stream":
        return {**output, "text": masks.text(output["text"])}
    if kind == "error":
        trace = [masks.text(_ANSI.sub("", line)) for line in output["traceback"]]
        return {**output, "evalue": masks.text(output["evalue"]), "traceback": trace}
    data = {mime: _form(mime, content, masks) for mime, content in output["data"].items()}
    return {k: v for k, v in {**output, "data": data}.items() if k != "transient"}


def _form(mime: str, content: Any, masks: Masks) -> Any:
    """One form of an output: text to be read masked as text, a drawing and data of their folders, the rest as it is."""
    if mime.endswith("json"):
        return masks.data(content)
    text = _join(content) if isinstance(content, list) else content
    if mime in _TEXT:
        return masks.text(text, markup=_TEXT[mime])
    return masks.paths(text) if mime == "image/svg+xml" and isinstance(text, str) else text
