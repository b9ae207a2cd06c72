"""Cells and notebooks as plain data."""

import json
from collections.abc import Sequence
from typing import Any

Cell = dict[str, Any]
Content = dict[str, Any]
COURSE = "course"


def prose_cell(text: str, id: str, tags: Sequence[str] = (), attachments: dict[str, Any] | None = None) -> Cell:
    """A Markdown cell."""
    cell: Cell = {"cell_type": "markdown", "id": id, "metadata": {"tags": list(tags)} if tags else {}, "source": text}
    return {**cell, "attachments": attachments} if attachments else cell


def code_cell(text: str, id: str, outputs: Sequence[Any] = (), tags: Sequence[str] = ()) -> Cell:
    """A code cell; one with outputs has run."""
    return {
        "cell_type": "code",
        "execution_count": None,
        "id": id,
        "metadata": {"tags": list(tags)} if tags else {},
        "outputs": list(outputs),
        "source": text,
    }


def notebook(cells: Sequence[Cell], told: dict[str, Any] | None = None) -> Content:
    """A notebook of format 4.5. told: what stands under ``metadata.loopbook``."""
    metadata: dict[str, Any] = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
    }
    if told:
        metadata["loopbook"] = told
    return {"cells": list(cells), "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def as_bytes(content: Content) -> bytes:
    """The bytes of its file, the same on every run."""
    return (json.dumps(content, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def source_of(cell: Cell) -> str:
    """The source of a cell as one text."""
    source = cell.get("source", "")
    return source if isinstance(source, str) else "".join(source)
