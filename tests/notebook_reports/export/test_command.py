"""The nbconvert command: mends on standard error, one message where there is no page, never a traceback."""

import subprocess
import sys

import nbformat
import pytest

pytestmark = pytest.mark.builds


def nbconvert(folder, *arguments):
    command = [sys.executable, "-m", "nbconvert", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)


@pytest.fixture
def folder(make, tmp_path):
    script = make.code({"text/html": "<script>1</script>", "text/plain": "a chart"})
    image = "![a loop](https://example.org/loop.png) and [data](gone.csv)"
    nbformat.write(make.notebook("# T", image, script), tmp_path / "any.ipynb")
    (tmp_path / "broken.ipynb").write_text("{")
    return tmp_path


@pytest.mark.parametrize("form", ["pdf", "html"])
def test_mends_are_listed_with_their_cells(folder, form):
    run = nbconvert(folder, "--to", f"loopbook_{form}", "any.ipynb")
    assert run.returncode == 0 and "Traceback" not in run.stderr
    for line in (
        'any, cell 2, mend 1: Image "a loop" not shown: it is on the web, not in the notebook (https://example.org/loop.png)',
        "any, cell 2, mend 2: Link: it leads to a file that is not beside the notebook (gone.csv)",
        "any, cell 3, mend 3: Script not shown: a page runs no scripts",
    ):
        assert line in run.stderr
    assert (folder / f"any.{form}").stat().st_size > 1000


def test_strict_names_every_problem_at_once_and_writes_nothing(folder):
    run = nbconvert(folder, "--to", "loopbook_pdf", "any.ipynb", "--PdfExporter.mode=strict")
    lines = [line for line in run.stderr.splitlines() if line.startswith("any, cell")]
    assert run.returncode == 1 and "Traceback" not in run.stderr
    assert [line.split(":")[0] for line in lines] == ["any, cell 2", "any, cell 2", "any, cell 3"]
    assert not (folder / "any.pdf").exists()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["broken.ipynb"], "no notebook that can be read"),
        (["any.ipynb", "--PdfExporter.mode=kind"], "the mode is one of strict, mend, got 'kind'"),
    ],
)
def test_what_cannot_be_exported_is_one_message(folder, arguments, told):
    run = nbconvert(folder, "--to", "loopbook_pdf", *arguments)
    said = [line for line in run.stderr.splitlines() if not line.startswith("[NbConvertApp]")]
    assert run.returncode == 1 and len(said) == 1 and told in said[0], run.stderr


@pytest.mark.parametrize(
    ("settings", "gone", "kept"),
    [
        ({"TemplateExporter": {"exclude_input": True}}, ["code 1"], ["words", "out 1"]),
        ({"TemplateExporter": {"exclude_output": True}}, ["out 1"], ["code 1"]),
        ({"TemplateExporter": {"exclude_markdown": True}}, ["words"], ["code 1", "out 1"]),
        ({"TagRemovePreprocessor": {"remove_cell_tags": {"secret"}}}, ["code 2", "out 2"], ["code 1", "out 1"]),
        ({"TagRemovePreprocessor": {"remove_input_tags": {"secret"}}}, ["code 2"], ["out 2", "code 1"]),
        ({"RegexRemovePreprocessor": {"patterns": ["words"]}}, ["words"], ["code 1"]),
        ({"ClearOutputPreprocessor": {"enabled": True}}, ["out 1", "out 2"], ["code 1", "code 2"]),
    ],
)
def test_what_nbconvert_is_told_to_leave_out_is_left_out(make, settings, gone, kept):
    """``--no-input`` is the first of these."""
    import re

    from traitlets.config import Config

    from notebook_reports.export.exporters.html import HtmlExporter

    cells = [make.code(make.stream(f"out {n}"), source=f"# code {n}", tags=["secret"] * (n == 2)) for n in (1, 2)]
    notebook = make.notebook("# T", "words", *cells)
    before = nbformat.writes(notebook)
    page, _ = HtmlExporter(config=Config(settings)).from_notebook_node(notebook)
    seen = re.sub(r"<(style|script)>.*?</\1>|<[^>]*>", "", page, flags=re.DOTALL)
    assert not [words for words in gone if words in seen] and all(words in seen for words in kept)
    assert nbformat.writes(notebook) == before, "the notebook given stays as it is"
