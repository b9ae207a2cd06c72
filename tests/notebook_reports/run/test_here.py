"""A notebook run in this process gives the record that a kernel gives."""

import json

import pytest

from notebook_reports.project.project import no_project
from notebook_reports.project.source import read_source
from notebook_reports.run.here import run_here
from notebook_reports.run.run import run_notebook

pytestmark = [pytest.mark.builds, pytest.mark.long]


def code(text, id, *tags):
    return {"cell_type": "code", "id": id, "metadata": {"tags": list(tags)}, "source": text, "outputs": [],
            "execution_count": None}  # fmt: skip


@pytest.fixture
def source(tmp_path):
    cells = [
        {"cell_type": "markdown", "id": "title", "metadata": {}, "source": "# Here, with T = {{T}}"},
        code("T: float = 2.0  # s, > 0", "given", "parameters"),
        code("print('said')\n2 * T", "shown"),
        code("x = 1", "quiet"),
    ]
    path = tmp_path / "here.ipynb"
    path.write_text(json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}))
    return read_source(path)


def test_the_record_is_that_of_a_kernel(source, tmp_path):
    project = no_project(tmp_path)
    found = run_here(source, project, {"T": 5.0})
    assert found == json.loads(json.dumps(run_notebook(source, "here", project, {"T": 5.0}).content))
    assert found["cells"][3]["outputs"][1]["data"] == {"text/plain": "10.0"}


def test_what_a_cell_raises_is_raised(source, tmp_path):
    with pytest.raises(TypeError):
        run_here(source, no_project(tmp_path), {"T": None})
