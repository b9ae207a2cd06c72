"""The report of one design among many: the notebook run in this process, then printed as always."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from notebook_reports.build.apply import report_of, without
from notebook_reports.project.project import Notebook, no_project
from notebook_reports.project.source import read_source
from notebook_reports.run.canonical import dump
from notebook_reports.run.here import run_here


def report_files(
    notebook: Path,
    folder: Path,
    label: str,
    values: Mapping[str, Any],
    formats: Sequence[str],
    left_out: frozenset[str],
    code: bool,
) -> dict[str, bytes]:
    """The reports of a trusted notebook that is run in `folder`, by format."""
    copied = folder / f"{label}.ipynb"
    copied.write_text(without(notebook.read_text(encoding="utf-8"), left_out), encoding="utf-8")
    source = read_source(copied)
    content = run_here(source, no_project(folder), values)
    about = Notebook(label, copied, own=False)
    return {
        format: dump(content) if format == "ipynb" else report_of(content, format, about, source.title, code)
        for format in formats
    }
