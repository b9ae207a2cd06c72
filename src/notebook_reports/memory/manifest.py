"""What was built, for the pages that list it: ``.cache/manifest.json``, and the same as a function."""

import json
from collections import Counter
from typing import Any

from notebook_reports.memory import stamps
from notebook_reports.project import atomic
from notebook_reports.project.project import Notebook, Project, UsageError
from notebook_reports.project.source import read_source


def manifest(project: Project) -> list[dict[str, Any]]:
    """One entry per notebook of the project, in order.

    id, title, folder; source: path of the notebook; reports: path by format, relative to ``reports/``; built: whether
    the last run was good; seconds; verdicts: number of records by table and verdict; records: as harvested, each with
    the cell and the section that shows it.
    """
    entries = []
    for notebook in project.notebooks():
        stamp = stamps.load(project, notebook)
        records = stamps.records(project, notebook) if stamp else []
        reports = {}
        for format in ("pdf", "html", "ipynb"):
            path = project.reports / f"{notebook.id}.{format}"
            if path.exists():
                reports[format] = path.relative_to(project.reports).as_posix()
        verdicts: dict[str, Counter] = {}
        for record in records:
            verdicts.setdefault(record["table"], Counter())[record["verdict"]] += 1
        entries.append(
            {
                "id": notebook.id,
                "title": stamp.title if stamp else _title(notebook),
                "folder": notebook.folder,
                "source": notebook.path.relative_to(project.root).as_posix(),
                "reports": reports,
                "built": stamp is not None,
                "seconds": stamp.seconds if stamp else None,
                "verdicts": verdicts,
                "records": records,
            }
        )
    return entries


def _title(notebook: Notebook) -> str:
    try:
        return read_source(notebook.path).title
    except UsageError:
        return notebook.id


def write_manifest(project: Project) -> None:
    """Write it to ``.cache/manifest.json``."""
    atomic.clear(project.cache / "manifest.json")
    atomic.write(project.cache / "manifest.json", json.dumps(manifest(project), ensure_ascii=False, indent=1).encode())
