"""One broken input is one failure, in one line that names file and place; everything else is built."""

import json

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from loopbook.design.model import ModelError
from loopbook.design.model_file import read_model
from notebook_reports.ledger.glossary import terms
from notebook_reports.ledger.printed_data import PrintedDataError, load
from notebook_reports.memory import sealed
from notebook_reports.project import toml
from notebook_reports.project.outline import read_outline
from notebook_reports.project.parameters import NotebookParameter, ParameterError, read_parameters
from notebook_reports.project.project import UsageError
from notebook_reports.project.ranges import Range
from notebook_reports.project.source import read_source
from notebook_reports.run import run as runner

GOOD = {"cell_type": "code", "id": "c", "metadata": {}, "source": "1", "outputs": [], "execution_count": None}


def notebook(**changes):
    return {"cells": [GOOD], "metadata": {}, "nbformat": 4, "nbformat_minor": 5, **changes}


def cell(**changes):
    made = {**GOOD, **changes}
    return notebook(cells=[{k: v for k, v in made.items() if v is not ...}])


BROKEN = {
    "no JSON": "{",
    "empty": "",
    "a list": "[]",
    "nested deeply": "[" * 100_000,
    "nested to the limit of the machine": '{"nbformat": 4, "cells": ' + "[" * 400 + "]" * 400 + "}",
    "no cells": {"nbformat": 4},
    "cells null": notebook(cells=None),
    "cells a text": notebook(cells="x"),
    "a cell null": notebook(cells=[None]),
    "a cell without source": cell(source=...),
    "source null": cell(source=None),
    "source numbers": cell(source=[1, 2]),
    "half a character": cell(source="\ud800"),
    "metadata null": notebook(metadata=None),
    "metadata of a cell null": cell(metadata=None),
    "tags a word": cell(metadata={"tags": "parameters"}),
    "tags numbers": cell(metadata={"tags": [1]}),
    "no cell type": cell(cell_type=...),
    "another cell type": cell(cell_type="heading"),
    "outputs null": cell(outputs=None),
    "id a number": cell(id=3),
    "attachments a list": cell(attachments=[]),
    "an older format": notebook(nbformat=3),
    "another language": notebook(metadata={"kernelspec": {"language": "julia"}}),
    "inputs that are no list": notebook(metadata={"loopbook": {"inputs": "data.csv"}}),
    "an input that is not there": notebook(metadata={"loopbook": {"inputs": ["nowhere.csv"]}}),
}
TOLERATED = {
    "a kernel null": notebook(metadata={"kernelspec": None, "language_info": {"name": None}}),
    "no metadata": {"cells": [GOOD], "nbformat": 4, "nbformat_minor": 5},
    "no outputs": cell(outputs=..., execution_count=...),
    "no id": cell(id=...),
    "lines": cell(source=["1 +\n", " 1"]),
}


@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_notebook_is_one_failure_and_the_others_are_built(bench, monkeypatch, what):
    monkeypatch.setattr(runner, "run_notebook", lambda source, *_: runner.Run(source.content, 0.1))
    bench.write("a/good", "# Good", "1")
    text = BROKEN[what] if isinstance(BROKEN[what], str) else json.dumps(BROKEN[what])
    (bench.root / "notebooks/a/bad.ipynb").write_text(text)
    outcome = bench.build()
    assert outcome.code == 1 and bench.reports() == ["a/good.html"]
    (failure,) = outcome.failures
    assert failure.notebook == "a/bad" and "bad.ipynb: " in failure.what and "\n" not in failure.what
    assert "report it" not in bench.said and "Traceback" not in bench.said
    result = CliRunner().invoke(main, ["--root", str(bench.root), "list"])
    assert result.exit_code in (0, 1) and "a/good" in result.output


@pytest.mark.parametrize("what", TOLERATED)
def test_what_is_only_missing_is_added(tmp_path, what):
    path = tmp_path / "n.ipynb"
    path.write_text(json.dumps(TOLERATED[what]))
    assert read_source(path).cells[0].kind == "code"


DEEP = "x = " + "[" * 5000 + "]" * 5000
LONG = "x = " + "9" * 5000
TOML = {
    "nested deeply": (DEEP, "nested too deeply"),
    "a long integer": (LONG, "a number too long"),
    "not UTF-8": (b"# \xe5\nx = 1", "not UTF-8"),
    "no TOML": ("x = ", "Invalid value"),
}


@pytest.mark.parametrize("what", TOML)
def test_a_broken_toml_file_is_one_line(tmp_path, what):
    content, message = TOML[what]
    path = tmp_path / "file.toml"
    path.write_bytes(content if isinstance(content, bytes) else b"a = 1\n" + content.encode())
    with pytest.raises(toml.TomlError, match=message) as raised:
        toml.read_toml(path)
    assert str(raised.value).startswith("file.toml") and "\n" not in str(raised.value)
    if what in ("nested deeply", "a long integer"):
        assert "line 2, x" in str(raised.value)


@pytest.mark.parametrize(
    "text", ["part = 5", "part = [1]", "[part]\nfolder = 1", DEEP, "title = 1\n[[part]]\nfolder=''"]
)
def test_a_broken_outline_is_one_failure(bench, text):
    bench.write("a/b", "# T")
    (bench.root / "notebooks/book.toml").write_text(text)
    with pytest.raises(UsageError, match=r"notebooks/book\.toml"):
        read_outline(bench.project, [])


@pytest.mark.parametrize(
    "text",
    [
        "value = 5",
        "[[value]]\nid = 'a'\nplace = 'T'\nquantity = 'q'\nprinted = 5",
        "[[value]]\nid = 'a'\nplace = 'T'\nquantity = 'q'\nprinted = '1e999999999'",
        "[[value]]\nid = 7\nplace = 'T'\nquantity = 'q'\nprinted = '1'",
        "[[misprint]]\nid = {a = 1}\nplace = 'T'",
        LONG,
        DEEP,
    ],
)
def test_broken_printed_data_names_its_file(tmp_path, text):
    folder = tmp_path / "a_document" / "printed"
    folder.mkdir(parents=True)
    (folder / "file.toml").write_text(f"document = 'a-document'\nplace = 'T'\n{text}")
    with pytest.raises(PrintedDataError, match=r"^file\.toml"):
        load("a-document", tmp_path)


def test_a_broken_glossary_names_its_file(tmp_path):
    (tmp_path / "g.toml").write_text("term = 5")
    with pytest.raises(ValueError, match=r"g\.toml: term = 5"):
        terms(tmp_path / "g.toml")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("process = 5", "process = 5: a table"),
        ("process = [1]", r"process = \[1\]: a table"),
        ("experiment = 5\n[process]\ngain = 1.0\ndelay = 1.0\ntime_constants = [1.0]", "experiment = 5: a table"),
        ("[process]\ngain = 1.0\ndelay = 1e300\ntime_constants = [1.0]", "delay = 1e[+]300: a number between"),
        ("[process]\ngain = 1.0\ndelay = 1.0\ntime_constants = [1e-200]", "time_constants = 1e-200: a number between"),
        (f"[process]\ngain = 1{'0' * 400}\ndelay = 1.0\ntime_constants = [1.0]", "gain = 1000.*: a number between"),
        ("[process]\ngain = nan\ndelay = 1.0\ntime_constants = [1.0]", "gain = nan"),
        ("[process]\ngain = 1.0\ndelay = '1'\ntime_constants = [1.0]", "delay = '1': a number"),
        ("[process]\ngain = 1.0\ndelay = 1.0\ntime_constants = 'x'", "time_constants"),
        (LONG, "4300 digits"),
        (DEEP, "nested too deeply"),
        (b"\xff\xfe", "not UTF-8"),
    ],
)
def test_a_broken_model_is_one_line(tmp_path, text, message):
    path = tmp_path / "model.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ModelError, match=rf"^model\.toml: .*{message}"):
        read_model(path)


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("int", "1_000"),
        ("int", "007"),
        ("int", "1.0"),
        ("int", "٣"),
        ("int", "9" * 5000),
        ("float", "1_0.5"),
        ("float", "nan"),
        ("float", "inf"),
        ("float", "0x10"),
        ("float", "1e400"),
        ("list[int]", "[" * 300 + "]" * 300),
        ("list[int]", "__import__('os').abort()"),
        ("bool", "1"),
    ],
)
def test_a_value_that_is_not_written_as_one_is_refused(kind, text):
    with pytest.raises(ParameterError):
        NotebookParameter("n", kind, None, "", Range()).from_text(text)


def test_a_value_as_one_writes_it_is_taken():
    for kind, text, value in (("int", "-12", -12), ("int", "0", 0), ("float", "1e-3", 1e-3), ("float", ".5", 0.5)):
        assert NotebookParameter("n", kind, None, "", Range()).from_text(text) == value


def test_a_parameter_cell_nested_deeply_is_refused(bench):
    for text in ("x: int = " + "-" * 100_000 + "1", "x: int = " + "(" * 1000 + ")" * 1000, "x: int = 1\0"):
        source = read_source(bench.write("a/b", "# T", (text, "parameters")))
        with pytest.raises(ParameterError):
            read_parameters(source)


@pytest.mark.parametrize("seconds", ["nan", "inf", "0", "-1", "x"])
def test_a_time_limit_is_a_number_of_seconds(bench, seconds):
    bench.write("a/b", "# T")
    assert CliRunner().invoke(main, ["--root", str(bench.root), "build", "--timeout", seconds]).exit_code == 2


def test_a_seal_over_what_is_nested_deeply_is_damage_not_a_traceback(tmp_path):
    (tmp_path / "x.json").write_text('{"a": ' * 50_000)
    with pytest.raises(sealed.Damaged):
        sealed.read(tmp_path / "x.json")
