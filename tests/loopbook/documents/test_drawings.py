"""The documents' own drawings, from data: each has a caption that names its figure, words, and room on the page."""

import re
from pathlib import Path

import matplotlib
import pytest

matplotlib.use("Agg")

from loopbook.documents.double_tank import diagrams as of_the_tank
from loopbook.documents.drawings import drawing
from loopbook.documents.pid_report import diagrams as of_the_report
from loopbook.plots.block_diagram import Diagram
from loopbook.plots.circuit import Circuit

pytestmark = pytest.mark.long

FIGURES = {of_the_tank: {"1", "2", "4", "7", "9"}, of_the_report: {"3.1", "3.11", "4.1", "4.4", "5.6"}}


def drawings(module):
    return {name: data for name, data in vars(module).items() if isinstance(data, Diagram | Circuit)}


@pytest.mark.parametrize("module", FIGURES)
def test_every_lost_drawing_is_drawn(module):
    found = {re.match(r"Figure ([\d.]+) of the", data.caption)[1] for data in drawings(module).values()}
    assert found == FIGURES[module]


@pytest.mark.parametrize("name", drawings(of_the_tank))
def test_a_drawing_of_the_tank_stands_in_a_chapter(name):
    chapters = (Path(__file__).parents[3] / "notebooks" / "double_tank").glob("*.ipynb")
    assert sum(f"drawing(double_tank.diagrams.{name})" in c.read_text("utf-8") for c in chapters) == 1


@pytest.mark.parametrize("data", [d for module in FIGURES for d in drawings(module).values()])
def test_a_drawing_fits_and_is_the_same_twice(data):
    one, other = drawing(data), drawing(data)
    assert one.svg == other.svg and one.alt == data.told() and len(one.alt) > 60
    width, unit = re.search(r'<svg[^>]* width="([\d.]+)(\w+)"', one.svg).groups()
    assert unit == "pt" and float(width) < 530  # at full size, or reduced by an eighth at most
