"""What a machine writes into outputs is masked, whole paths only; results are left as they are."""

import json
import tempfile
from pathlib import Path

import pytest

from notebook_reports.memory import fingerprint
from notebook_reports.project import home
from notebook_reports.run.canonical import canonical
from notebook_reports.run.masks import Masks, home_shown

pytestmark = pytest.mark.builds

ROOT = Path("/somewhere/project")
TABLE = "<table><tr><td>1/2</td></tr></table>"


def output(text, mime="text/plain"):
    cell = {"cell_type": "code", "id": "c", "metadata": {}, "source": "", "execution_count": 1}
    cell["outputs"] = [{"output_type": "display_data", "metadata": {}, "data": {mime: text}}]
    made = canonical({"cells": [cell], "metadata": {}}, ROOT, ["c"])
    return made["cells"][0]["outputs"][0]["data"][mime]


@pytest.mark.parametrize("folder", ["/", "", "/e", "relative", ".", "/root"])
def test_a_home_too_short_to_be_told_from_text_is_not_masked(monkeypatch, folder):
    monkeypatch.setenv("HOME", folder)
    monkeypatch.setattr(home, "_of_the_list_of_users", lambda: None)
    for text in ("1/2", "/etc/passwd", "e.g. /e/x", "a.b", "relative", "/root/x"):
        assert output(text) == text
    assert output(TABLE, "text/html") == TABLE


def test_a_home_that_outputs_show_is_part_of_the_stamp(bench, monkeypatch):
    shown = set()
    for folder in ("/", "/root", "/home/a", "/home/b"):
        monkeypatch.setenv("HOME", folder)
        shown.add(fingerprint.environment(bench.project)["the home folder"])
    assert shown == {"/", "/root", "~"} and home_shown() == "~"


@pytest.mark.parametrize(
    ("text", "masked"),
    [
        ("/home/ann/data.csv", "~/data.csv"),
        ("in /home/ann.", "in ~."),
        ("file:///home/ann/x", "file://~/x"),
        ("'/home/ann'", "'~'"),
        ("/home/anna/x /home/ann-old /home/ann.old x/home/ann /srv/home/ann", None),
        ("/somewhere/project/src/x.py:3", "src/x.py:3"),
        ("/somewhere/project", "."),
        ("/somewhere/project/", "./"),
        ("/somewhere/project2/x /somewhere/project.bak /a/somewhere/project/x", None),
    ],
)
def test_only_whole_paths_are_masked(monkeypatch, text, masked):
    monkeypatch.setenv("HOME", "/home/ann")
    assert output(text) == (text if masked is None else masked)


def test_another_folder_for_temporary_files_gives_the_same_text(monkeypatch):
    shown = set()
    for folder in ("/tmp", "/var/tmp/mine"):
        monkeypatch.setattr(tempfile, "tempdir", folder)
        shown.add(Masks(ROOT).text(f"{folder}/x.csv"))
    assert shown == {"/tmp/x.csv"}


@pytest.mark.parametrize("number", [hex(2**40), "0xdeadbeef", "crc at 0xdeadbeef", "0x7f3a5c2b1d90"])
def test_a_number_in_hexadecimal_is_a_result(number):
    assert output(number) == number


@pytest.mark.parametrize(
    ("text", "mime", "masked"),
    [
        ("<function f at 0x7f3a5c2b1d90>", "text/plain", "<function f at 0x…>"),
        ("&lt;object at 0x7f3a5c2b1d90&gt;", "text/html", "&lt;object at 0x…&gt;"),
        ("/tmp/ipykernel_1/2.py:1: W", "text/html", "&lt;cell&gt;:1: W"),
        ("<svg><text>/somewhere/project/a</text></svg>", "image/svg+xml", "<svg><text>a</text></svg>"),
        ({"a": ["/somewhere/project/x", 3]}, "application/json", {"a": ["x", 3]}),
    ],
)
def test_every_form_of_an_output_is_masked_as_it_is_read(text, mime, masked):
    assert output(text, mime) == masked


NOTEBOOK = (
    "from fractions import Fraction\nprint('1/2', Fraction(1, 2), {'a/b': 1})",
    "import warnings, sympy\nprint(sympy.__file__.endswith('py'))",
    "import helper\nhelper.warn()",
    ("helper.fail()", "raises-exception"),
    "import numpy as np\nnp.float64(1) / np.float64(0)",
)


def test_builds_under_other_homes_and_users_words_give_the_same_bytes(bench, tmp_path_factory, monkeypatch):
    """The root of all files, a folder that is not there, and one above the project as home; other languages."""
    made = []
    for number, (variable, value) in enumerate([("HOME", "/"), ("HOME", "/no/such"), ("HOME", "above"), ("LANG", "C")]):
        folder = tmp_path_factory.mktemp(f"copy{number}") / "deep"
        folder.mkdir()
        monkeypatch.setenv(variable, str(folder.parent) if value == "above" else value)
        monkeypatch.setenv("LANGUAGE", "sv:pl"[number % 2 :])
        copy = type(bench)(folder)
        copy.module("helper.py", "import warnings\n\ndef warn():\n    warnings.warn('w')\n\ndef fail():\n    1 / 0\n")
        copy.write("a/one", "# One", *NOTEBOOK)
        assert copy.build(formats=("ipynb",)).code == 0, copy.said
        made.append((folder / "reports/a/one.ipynb").read_text())
    assert len(set(made)) == 1
    texts = json.dumps(json.loads(made[0]))
    assert "1/2 1/2 {'a/b': 1}" in texts and "src/helper.py" in texts
    assert "RuntimeWarning: divide by zero encountered in scalar divide" in texts and "site-packages" not in texts
