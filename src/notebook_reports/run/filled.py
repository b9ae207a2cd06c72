"""Prose that shows a parameter: ``{{T}}`` in a Markdown cell stands for the value that the notebook was run with.

Only names of the notebook's own parameters are replaced, so that braces of formulas stay what they are. Numbers are
shown whole and with at least four significant digits; a text stands as it is, never as markup.
"""

import re
from collections.abc import Mapping
from decimal import Decimal
from typing import Any

from notebook_reports.display import literal
from notebook_reports.project.parameters import read_parameters
from notebook_reports.project.source import Source

DIGITS = 4
_PLACE = re.compile(r"\{\{\s*([^\W\d]\w*)\s*\}\}")


def written(value: Any) -> str:
    """A value as prose shows it.

    >>> written(12.5), written(0.8), written(12.375), written(50), written([1.0, 0.25])
    ('12.50', '0.8000', '12.375', '50', '1.000, 0.2500')
    """
    if isinstance(value, list | tuple):
        return ", ".join(written(v) for v in value)
    if not isinstance(value, float):
        return literal(str(value))
    exact = Decimal(repr(value))
    if value and not 1e-6 <= abs(value) < 1e15:
        return repr(value)
    places = max(0, DIGITS - 1 - exact.adjusted())
    return f"{exact:.{max(places, -int(exact.normalize().as_tuple().exponent))}f}"


def fill(text: str, values: Mapping[str, Any]) -> str:
    """The text with the values in the place of their names.

    >>> fill("$T = {{T}}$ s, $e^{{-s}}$", {"T": 10.0})
    '$T = 10.00$ s, $e^{{-s}}$'
    """
    return _PLACE.sub(lambda found: written(values[found[1]]) if found[1] in values else found[0], text)


def names_shown(text: str) -> set[str]:
    """The names that stand in double braces."""
    return set(_PLACE.findall(text))


def filled(content: dict[str, Any], source: Source, given: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """A notebook's content with the parameters in its prose. given: what it was run with, if not its own values."""
    texts = [cell["source"] for cell in content["cells"] if cell["cell_type"] == "markdown"]
    if not any(_PLACE.search(text) for text in texts):
        return content
    values = {**{name: p.default for name, p in read_parameters(source).items()}, **(given or {})}
    cells = [
        {**cell, "source": fill(cell["source"], values)} if cell["cell_type"] == "markdown" else cell
        for cell in content["cells"]
    ]
    return {**content, "cells": cells}
