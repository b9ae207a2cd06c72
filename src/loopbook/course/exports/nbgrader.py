"""An nbgrader assignment: locked texts, one cell to fill in, a cell of hidden tests for each answer.

A weaker check, and it says so: a test runs in the student's own kernel, where `abs` may be another function.
"""

from loopbook.course.exports.checks import check_of, key_of
from loopbook.course.exports.variants import WEAKER, Variant
from loopbook.course.notebooks import Cell, Content, code_cell, notebook, prose_cell
from loopbook.course.release.student import ANSWERS, answers_cell

SCHEMA = 3
_NOTHING = {"grade": False, "locked": False, "solution": False, "task": False, "schema_version": SCHEMA}


def nbgrader(sheet: str, variant: Variant) -> Content:
    """The notebook for ``source/<assignment>/``."""
    cells = [_locked(prose_cell(WEAKER.format(sheet=sheet), "weaker"))]
    for cell in variant.cells:
        if cell["cell_type"] == "markdown":
            cells.append(_locked({**cell, "metadata": {}}) if cell["id"] != "whose" else cell)
        elif cell["id"] != ANSWERS:
            cells.append(cell)
    cells = [cell for cell in cells if cell["id"] != "whose"]
    keys = [f"    {a.name!r}: {key_of(a)}," for a in variant.solved.asked.values() if check_of(a)]
    solved = ["### BEGIN SOLUTION", "answers = {", *keys, "}", "### END SOLUTION"]
    cells.append(_told(code_cell("\n".join(solved), ANSWERS), solution=True, grade_id=ANSWERS, cell_type="code"))
    cells.append(prose_cell("```python\n" + answers_cell(variant.solved) + "\n```", "form"))
    for one in variant.solved.asked.values():
        if lines := check_of(one):
            hidden = ["### BEGIN HIDDEN TESTS", *lines, "### END HIDDEN TESTS"]
            text = "\n".join([f"# {one.name}: {one.points:g} points", *hidden])
            told = {"grade": True, "locked": True, "grade_id": f"test-{one.name}", "points": one.points}
            cells.append(_told(code_cell(text, f"test-{one.name}"), **told, cell_type="code"))
    return notebook(cells)


def _told(cell: Cell, **told: object) -> Cell:
    return {**cell, "metadata": {"nbgrader": {**_NOTHING, **told}}}


def _locked(cell: Cell) -> Cell:
    return _told(cell, locked=True, grade_id=f"text-{cell['id']}", cell_type=cell["cell_type"])
