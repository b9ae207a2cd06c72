"""A notebook run by hand, as JupyterLab runs it, shows the tables, equations and verdicts of its report."""

import json
import os
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from notebook_reports.display import EQUATION_MIME, FIGURE_MIME, TABLE_MIME
from notebook_reports.ledger.harvest import records
from notebook_reports.project.project import project_at
from notebook_reports.project.source import read_source

pytestmark = pytest.mark.builds

PROJECT = project_at(Path(__file__).parents[2])


def shown(content):
    """What a reader sees of each cell, without the drawings: their fonts are the pipeline's."""
    kinds = (TABLE_MIME, EQUATION_MIME, FIGURE_MIME, "text/plain")
    outputs = [output.get("data", {}) for cell in content["cells"] for output in cell.get("outputs", ())]
    return [{kind: data[kind] for kind in kinds if kind in data} for data in outputs]


@pytest.mark.parametrize(
    "name", ["double_tank/01_model", pytest.param("pid_article/03_step_response_tuning", marks=pytest.mark.whole)]
)
def test_the_same_tables_and_verdicts(outcome, name, monkeypatch):
    source = read_source(PROJECT.notebooks_folder / f"{name}.ipynb")
    report = json.loads((PROJECT.cache / "executed" / f"{name}.ipynb").read_text(encoding="utf-8"))
    for variable in [v for v in os.environ if v.startswith(("LOOPBOOK", "MPL", "MATPLOTLIB"))]:
        monkeypatch.delenv(variable)
    monkeypatch.setenv("PYTHONHASHSEED", "7")
    node = nbformat.read(source.path, 4)
    NotebookClient(node, kernel_name="python3", resources={"metadata": {"path": str(source.path.parent)}}).execute()
    verdicts = [[r.data() for r in records(content, name)] for content in (node, report)]
    assert verdicts[0] == verdicts[1] and verdicts[0]
    assert shown(node) == shown(report)
