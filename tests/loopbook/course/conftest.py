"""Sheets to try things on."""

import json

import pytest

from loopbook.course.running import SheetRunner
from loopbook.course.sheet import read_sheet

HEAD = [
    ("md", "# A lag\n\nThe process ${{K}}/({{T}} s + 1)$ is to be tuned."),
    ("code", "import math\n\nfrom loopbook.course import answer, require"),
    ("code", "K: float = 2.3  # {1.7, 2.3, 3.1}\nT: float = 14.0  # s, {11, 14, 17, 23}", "parameters"),
]
TAIL = [
    ("md", "**1.** Which gain makes the closed loop a lag of half a minute?", "question"),
    ("code", 'Kc = answer("Kc", T / K / 30, points=2, wrong={"gain left out": T / 30})', "solution"),
    ("md", "**2.** Which rise time has it, and which half of that?", "question"),
    ("md", "The logarithm of nine.", "hint"),
    (
        "code",
        'rise = answer("rise", T / K / Kc * math.log(9), unit="s")\nhalf = answer("half", rise / 2, unit="s")',
        "solution",
    ),
]


def notebook(*cells) -> str:
    made = []
    for number, (kind, text, *tags) in enumerate(cells, 1):
        more = {} if kind == "md" else {"outputs": [], "execution_count": None}
        name = "markdown" if kind == "md" else "code"
        made.append({"cell_type": name, "id": f"c{number}", "metadata": {"tags": tags}, "source": text, **more})
    return json.dumps({"cells": made, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


@pytest.fixture
def sheet_file(tmp_path):
    """Writes a sheet; by default a lag with two questions."""

    def write(*cells, name="lag"):
        path = tmp_path / f"{name}.ipynb"
        path.write_text(notebook(*(cells or (*HEAD, *TAIL))))
        return path

    return write


@pytest.fixture
def runner_of(sheet_file):
    """The runner of such a sheet."""
    return lambda *cells: SheetRunner(read_sheet(sheet_file(*cells)))


@pytest.fixture
def head():
    return HEAD


@pytest.fixture
def tail():
    return TAIL
