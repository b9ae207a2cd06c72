"""Exercises and their solutions: cells tagged `solution` stand after all others, or in another chapter.

A cell tagged `question` begins a question; its solution is the cells tagged `solution` up to the next. Code that is
neither a solution nor `given` would tell the answers as well: it stands with the solutions. Cells keep the numbers that
they have in the notebook.
"""

import re
from collections.abc import Sequence
from typing import Any

SOLUTION, QUESTION, GIVEN, HINT = "solution", "question", "given", "hint"
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
    cells = [(number, _with_word(cell)) for number, cell in enumerate(notebook["cells"], start=1)]
    if not has_solutions(notebook):
        return cells if way != ALONE else []
    rest = [(number, cell) for number, cell in cells if not _tells(cell)]
    if way == LEFT_OUT:
        return rest
    solved = _with_numbers(cells)
    if way == ALONE:
        return solved
    return [*rest, (solved[0][0], _prose(f"## {HEADING}")), *solved]


def _tells(cell: Any) -> bool:
    return SOLUTION in tags(cell) or (cell["cell_type"] == "code" and GIVEN not in tags(cell))


def _with_word(cell: Any) -> Any:
    """A hint says that it is one."""
    return _prose(f"*Hint.* {''.join(cell['source'])}") if HINT in tags(cell) else cell


def _with_numbers(cells: Sequence[Numbered]) -> list[Numbered]:
    """The solutions, each after the number of its question."""
    found: list[Numbered] = []
    label = ""
    for number, cell in cells:
        if QUESTION in tags(cell):
            numbered = _NUMBER.match("".join(cell["source"]))
            label = f"**{numbered[1]}.**" if numbered else ""
        elif _tells(cell):
            found += [(number, _prose(label))] if label and SOLUTION in tags(cell) else []
            found.append((number, cell))
            label = "" if SOLUTION in tags(cell) else label
    return found


def _prose(text: str) -> dict[str, Any]:
    return {"cell_type": "markdown", "metadata": {}, "source": text}
