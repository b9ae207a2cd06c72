"""What CONTRIBUTING shows can be done to the letter; its rule is added in tests/loopbook/tuning/test_family.py."""

import re
import textwrap
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from notebook_reports.ledger.document import Document
from notebook_reports.ledger.printed_data import load

TEXT = (Path(__file__).parents[2] / "CONTRIBUTING.md").read_text(encoding="utf-8")
PARTS = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", TEXT, re.MULTILINE | re.DOTALL))


def code(part: str, language: str) -> list[str]:
    found = re.findall(rf"^ *```{language}\n(.*?)^ *```", PARTS[part], re.MULTILINE | re.DOTALL)
    return [textwrap.dedent(block) for block in found]


def test_the_printed_table_and_the_claim_are_read_and_checked(tmp_path):
    table, claim = code("How to add a printed table", "toml")
    printed = tmp_path / "double_tank" / "printed"
    printed.mkdir(parents=True)
    (printed / "table_5.toml").write_text(f"{table}\n{claim}", encoding="utf-8")
    tank = Document(load("double-tank", tmp_path))
    check, said = code("How to add a printed table", "python")
    exact, rounded = SimpleNamespace(rise=3.66348), SimpleNamespace(rise=3.66348)
    space = {"tank": tank, "doc": tank, "exact": exact, "rounded": rounded, "slope": -0.4}
    assert eval(check, space).verdicts() == {"rise-q0.3": "reproduced"}
    verdicts = [eval(said, {**space, "slope": slope}).verdicts() for slope in (-0.4, 0.4)]
    assert verdicts == [{"error-falls-with-gain": "holds"}, {"error-falls-with-gain": "fails"}]


def test_the_figure_is_drawn():
    (example,) = code("How to add a figure", "python")
    t = np.linspace(0, 4)
    space = {"t": t, "y": 1 - np.exp(-t)}
    exec(example, space)
    assert [len(axis.lines) for axis in space["fig"].axes] == [1]


@pytest.mark.parametrize("part", [part for part in PARTS if code(part, "python")])
def test_every_example_is_python(part):
    for example in code(part, "python"):
        compile(example, part, "exec")
