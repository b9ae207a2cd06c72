"""Where the reports of a notebook go, and what they are called."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from notebook_reports.memory.hashes import digest
from notebook_reports.project.project import FORMATS, Notebook, Project

_SPECIAL = re.compile(r"[^A-Za-z0-9_.+-]+")
LONGEST = 80  # characters of parameters in a file's name


def output_paths(
    project: Project,
    notebook: Notebook,
    parameters: Mapping[str, Any] | None = None,
    formats: Sequence[str] = FORMATS,
    output: Path | None = None,
) -> dict[str, Path]:
    """Where each format goes.

    A notebook of the project: ``reports/<id>.pdf``; with parameters of one's own ``reports/custom/<id>-q=0.6.pdf``.
    One from elsewhere: beside it, the executed notebook as ``<name>.executed.ipynb``. With -o: below that folder.
    """
    parameters = parameters or {}
    if output is not None:
        folder = output
    elif notebook.own:
        folder = project.reports / "custom" if parameters else project.reports
    else:
        folder = notebook.path.parent
    stem = notebook.id + _suffix(parameters)
    paths = {format: folder / f"{stem}.{format}" for format in formats}
    if paths.get("ipynb") and paths["ipynb"].resolve() == notebook.path:
        paths["ipynb"] = folder / f"{stem}.executed.ipynb"
    return paths


def _suffix(parameters: Mapping[str, Any]) -> str:
    """The values in a file's name; where one is not a plain word or number, or all are long, with their hash."""
    shown = {name: _SPECIAL.sub("_", str(value)) for name, value in parameters.items()}
    text = "".join(f"-{name}={value}" for name, value in shown.items())
    plain = all(_is_plain(value) for value in parameters.values())
    if plain and len(text) <= LONGEST:
        return text
    return f"{text[:LONGEST]}-{digest(dict(parameters))}"


def _is_plain(value: Any) -> bool:
    """Is the value told from every other one by what `_suffix` shows of it?"""
    if isinstance(value, str):
        return bool(value) and not _SPECIAL.search(value) and value != "None"
    return value is None or isinstance(value, bool | int | float)
