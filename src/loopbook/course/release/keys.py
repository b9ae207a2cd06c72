"""What the teacher gets: a sheet with one student's numbers, solved."""

from typing import Any

from loopbook.course.notebooks import Cell, Content, code_cell, notebook, prose_cell
from loopbook.course.running import Solved
from loopbook.course.sheet import PARAMETERS, Sheet
from notebook_reports.run.filled import fill


def key_notebook(sheet: Sheet, solved: Solved, student: str) -> Content:
    """Every cell of the sheet with what it shows, the student's numbers in the place of the sheet's own."""
    cells: list[Cell] = []
    for cell in sheet.cells:
        if cell.kind == "markdown":
            cells.append(prose_cell(fill(cell.text, solved.parameters), cell.id, cell.tags))
        elif PARAMETERS in cell.tags:
            cells.append(code_cell(_assigned(sheet, solved), cell.id, tags=cell.tags))
        else:
            cells.append(code_cell(cell.text, cell.id, solved.outputs.get(cell.number, ()), cell.tags))
    cells.insert(1, prose_cell(f"Key of sheet `{sheet.id}` for **{student}**.", "whose"))
    return notebook(cells, {"contents": False})


def _assigned(sheet: Sheet, solved: Solved) -> str:
    lines = []
    for name, parameter in sheet.parameters.items():
        comment = f"  # {parameter.comment}" if parameter.comment else ""
        lines.append(f"{name}: {parameter.type} = {solved.parameters[name]!r}{comment}")
    return "\n".join(lines)


def key_row(sheet: Sheet, solved: Solved) -> dict[str, Any]:
    """The keys by name, as JSON holds them."""
    return {name: asked.kind.plain(asked.key) for name, asked in solved.asked.items()}
