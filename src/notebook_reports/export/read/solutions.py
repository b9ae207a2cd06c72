"""Exercises and their solutions: cells tagged `solution` stand after all others, or in another chapter.

A cell tagged `question` begins a question; its solution is the cells tagged `solution` up to the next. Cells keep the
numbers that they have in the notebook.
"""

import re
from collections.abc import Sequence
from typing import Any

SOLUTION, QUESTION, GIVEN = "solution", "question", "given"
"""Tags; of a cell tagged `given` a report shows what it gives, not its code."""
LAST, LEFT_OUT, ALONE = WAYS = ("last", "left out", "alone")
HEADING = "Solutions"
_NUMBER = re.compile(r"\s*(?:#+\s*)?\**(\d+)\s*[.)]")
Numbered = tuple[int, Any]


def tags(cell: Any) -> set[str]:
    """The tags of a cell."""
    return set(cell.get("metadata", {}).get("tags", ()))


def has_solutions(notebook: Any) -> bool:
    """Is there a cell tagged `solution`?"""
    return any(SOLUTION in tags(cell) for cell in notebook["cells"])


def arranged(notebook: Any, way: str = LAST) -> list[Numbered]:
    """(number from 1, cell) in the order of the report.

    way: solutions last below a heading of their own, left out, or alone with the numbers of their questions.
    """
    if way not in WAYS:
        raise ValueError(f"solutions are {', '.join(WAYS)}, got {way!r}")
    cells = list(enumerate(notebook["cells"], start=1))
    rest = [(number, cell) for number, cell in cells if SOLUTION not in tags(cell)]
    if way == LEFT_OUT or len(rest) == len(cells):
        return rest if way != ALONE else []
    solved = _with_numbers(cells)
    if way == ALONE:
        return solved
    return [*rest, (solved[0][0], _prose(f"## {HEADING}")), *solved]


def _with_numbers(cells: Sequence[Numbered]) -> list[Numbered]:
    """The solutions, each after the number of its question."""
    found: list[Numbered] = []
    label = ""
    for number, cell in cells:
        if QUESTION in tags(cell):
            numbered = _NUMBER.match("".join(cell["source"]))
            label = f"**{numbered[1]}.**" if numbered else ""
        elif SOLUTION in tags(cell):
            found += [(number, _prose(label))] if label else []
            found.append((number, cell))
            label = ""
    return found


def _prose(text: str) -> dict[str, Any]:
    return {"cell_type": "markdown", "metadata": {}, "source": text}
