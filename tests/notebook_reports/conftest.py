"""Tiny projects to build: a folder of notebooks, an exporter that writes what it was given, a console to read."""

import io
import json
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from notebook_reports.build import build as builder
from notebook_reports.build.job import Wanted
from notebook_reports.project.console import Console
from notebook_reports.project.project import Project, project_at
from notebook_reports.run.warm import PLAIN


def cell(text: str, *tags: str, id: str = "") -> dict:
    """One cell; prose where the text starts with a hash and a blank or a greater-than sign."""
    if text.startswith(("# ", "## ", "> ")):
        return {"cell_type": "markdown", "id": id, "metadata": {}, "source": text}
    made = {"cell_type": "code", "id": id, "metadata": {"tags": list(tags)} if tags else {}, "source": text}
    return {**made, "execution_count": None, "outputs": []}


def notebook(*cells: str | tuple[str, ...]) -> dict:
    """A notebook of such cells, with ids c1, c2, ...; a tuple is a text and its tags."""
    made = [cell(c) if isinstance(c, str) else cell(*c) for c in cells]
    for number, one in enumerate(made, 1):
        one["id"] = one["id"] or f"c{number}"
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def record(id: str, verdict: str = "reproduced", document: str = "double-tank", table: str = "value", **fields) -> str:
    """The text of a cell that leaves one record, as a check does."""
    named = {"quantity": id, "printed": "1.0", "unit": "s", "kind": "computed", "exact": "1", "from_inputs": ""}
    data = {"table": table, "document": document, "place": "Table 5", "id": id, "verdict": verdict}
    data["fields"] = {**named, **fields}
    bundle = {"application/vnd.loopbook.checks+json": [data], "text/plain": id}
    return f"from IPython.display import display\ndisplay({bundle!r}, raw=True)"


@dataclass
class Bench:
    """A project in a temporary folder with the verbs that the tests need."""

    root: Path
    exported: list = field(default_factory=list)
    said: str = ""

    record = staticmethod(record)

    @property
    def project(self) -> Project:
        return project_at(self.root)

    def write(self, id: str, *cells: str | tuple[str, ...]) -> Path:
        path = self.root / "notebooks" / f"{id}.ipynb"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(notebook(*cells)), encoding="utf-8")
        return path

    def module(self, name: str, text: str) -> Path:
        path = self.root / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def export(self, content, format, notebook, title) -> bytes:
        self.exported.append(f"{notebook.id}.{format}")
        return json.dumps([format, title, content], sort_keys=True).encode()

    def build(self, *names: str, parameters=(), formats=("html",), exporter=None, **options):
        wanted = {k: options.pop(k) for k in ("output", "force", "timeout") if k in options}
        self.exported.clear()
        out = io.StringIO()
        wish = Wanted(tuple(formats), exporter=exporter or self.export, **wanted)
        outcome = builder.build(self.project, names, parameters, wish, console=Console(out), **options)
        self.said = out.getvalue()
        return outcome

    def executed(self, id: str) -> dict:
        return json.loads((self.root / ".cache" / "executed" / f"{id}.ipynb").read_text(encoding="utf-8"))

    def reports(self) -> list[str]:
        folder = self.root / "reports"
        return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


@pytest.fixture(autouse=True, scope="session")
def fresh_kernels():
    """Warming up takes longer than these notebooks; `test_warm.py` forks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(PLAIN, "1")
        yield


@pytest.fixture
def bench(tmp_path) -> Bench:
    return Bench(tmp_path)


@pytest.fixture(scope="module")
def shared(tmp_path_factory) -> Bench:
    """One project for the whole module, where tests only look at what was built."""
    return Bench(tmp_path_factory.mktemp("project"))
