"""Writing one report of one notebook."""

import threading
from collections.abc import Callable
from pathlib import Path

from notebook_reports.build.standing import NOWHERE, Standing
from notebook_reports.export.exporters.choose import export
from notebook_reports.project import atomic
from notebook_reports.project.failures import Failure
from notebook_reports.project.project import EnvironmentProblem, Notebook
from notebook_reports.run.canonical import dump
from notebook_reports.run.quick_imports import import_nbformat

Exporter = Callable[..., bytes]
_EXPORTING = threading.Lock()  # the exporters keep state while they write


def write(
    path: Path,
    format: str,
    content: dict,
    notebook: Notebook,
    title: str,
    exporter: Exporter | None,
    keep_older: bool = False,
    stands: Standing = NOWHERE,
) -> bytes | list[Failure]:
    """Write one report; its bytes, or the failures, and then no report. exporter: see `reporter`, its default."""
    report = exporter or reporter(stands)
    try:
        made = dump(content) if format == "ipynb" else report(content, format, notebook, title)
        atomic.write(path, made)
    except EnvironmentProblem:
        raise
    except Exception as error:
        if not keep_older:
            atomic.remove(path)
        problems = getattr(error, "problems", None) or [error]
        return [
            Failure(
                notebook.id,
                f"{format}: {getattr(p, 'text', None) or f'{type(p).__name__}: {p}'}",
                getattr(p, "cell", None) or 0,
                kind="export",
            )
            for p in problems
        ]
    return made


def reporter(stands: Standing = NOWHERE) -> Exporter:
    """What writes reports, one at a time; see `export`. stands: where the notebook stands in the book."""
    import_nbformat()
    import nbformat

    def call(content: dict, format: str, notebook: Notebook, title: str) -> bytes:
        with _EXPORTING:
            return export(
                nbformat.from_dict(content),
                format,
                name=notebook.id,
                title=title,
                document=notebook.folder.replace("_", "-"),
                chapter=stands.part or notebook.folder.replace("_", " "),
                assets=notebook.path.parent,
                root=notebook.root,
                strict_alt=notebook.own,
                mode="strict" if notebook.own else "mend",
                folded=notebook.own,
                around=stands.around,
            )

    return call
