"""What a student gets: the texts with their own numbers, the figures, a place for each answer; no solution.

On screen a figure is an attachment of a Markdown cell, which no run of all cells clears; on paper it is a numbered
figure, and a table at the end takes the answers.
"""

import base64
from collections.abc import Iterator
from typing import Any

from loopbook.course.kinds.choice import Choice
from loopbook.course.notebooks import COURSE, Cell, Content, code_cell, notebook, prose_cell
from loopbook.course.question import Asked
from loopbook.course.running import Solved
from loopbook.course.sheet import Sheet
from loopbook.course.shown import points, wanted
from notebook_reports.display import EQUATION_MIME, FIGURE_MIME, TABLE_MIME, Table, literal
from notebook_reports.export.read.solutions import GIVEN, HINT, QUESTION
from notebook_reports.project.source import SourceCell
from notebook_reports.run.filled import fill

ANSWERS = "answers"
READ_THIS = (
    "Work in the empty cells or on paper, and write your answers into the cell below: numbers with a decimal point and "
    "without units, texts in quotes. What is left as it is counts as not answered."
)


def screen_sheet(sheet: Sheet, solved: Solved, student: str) -> Content:
    """The student's notebook."""
    cells: list[Cell] = []
    for cell in sheet.seen:
        if GIVEN in cell.tags:
            cells += _as_prose(cell, solved)
        elif HINT in cell.tags:
            text = f"<details><summary>Hint</summary>\n\n{fill(cell.text, solved.parameters)}\n\n</details>"
            cells.append(prose_cell(text, cell.id))
        else:
            cells.append(_text(sheet, cell, solved))
            if QUESTION in cell.tags:
                cells.append(code_cell("", f"work-{cell.id}"))
    total = points(sum(a.points for a in solved.asked.values()))
    cells.insert(1, prose_cell(f"Sheet `{sheet.id}` for **{literal(student)}**, {total}.", "whose"))
    cells.append(prose_cell(f"## Your answers\n\n{READ_THIS}", "how-to-answer"))
    cells.append(code_cell(answers_cell(solved), ANSWERS))
    return notebook(cells, {COURSE: {"sheet": sheet.id, "student": student}})


def paper_sheet(sheet: Sheet, solved: Solved, student: str) -> Content:
    """The same for print."""
    cells: list[Cell] = []
    hints: list[Cell] = []
    for cell in sheet.seen:
        if GIVEN in cell.tags:
            cells.append(code_cell("", cell.id, solved.outputs.get(cell.number, ()), [GIVEN]))
        elif HINT in cell.tags:
            hints.append(prose_cell(fill(cell.text, solved.parameters), cell.id))
        else:
            cells.append(_text(sheet, cell, solved))
    total = points(sum(a.points for a in solved.asked.values()))
    cells.insert(
        1,
        prose_cell(
            f"Sheet `{sheet.id}` for **{literal(student)}**, {total}. Date: \\_\\_\\_\\_\\_\\_\\_\\_\\_\\_", "whose"
        ),
    )
    rows = [[f"`{a.name}`", literal(a.kind.unit), " " * 40] for a in solved.asked.values()]
    table = Table(["answer", "unit", "your value"], rows, "Your answers", ["left", "left", "left"])
    cells.append(prose_cell("## Your answers", "how-to-answer"))
    cells.append(code_cell("", ANSWERS, [_table_output(table)], [GIVEN]))
    if hints:
        cells += [prose_cell("## Hints", "hints"), *hints]
    return notebook(cells, {"contents": False})


def _table_output(table: Table) -> dict[str, Any]:
    return {"output_type": "display_data", "data": table._repr_mimebundle_(), "metadata": {}}


def answers_cell(solved: Solved) -> str:
    """The cell that a student fills in."""
    lines = [f"    {a.name!r}: {a.kind.blank()},".replace("'", '"') for a in solved.asked.values()]
    width = max(map(len, lines))
    told = [f"{line:{width}}  # {a.kind.wants()}" for line, a in zip(lines, solved.asked.values(), strict=True)]
    return "\n".join(["answers = {", *told, "}"])


def _text(sheet: Sheet, cell: SourceCell, solved: Solved) -> Cell:
    text = fill(cell.text, solved.parameters)
    if QUESTION in cell.tags:
        mine = [a for a in solved.asked.values() if sheet.question_of(a.cell) == cell.number]
        text += "\n\n" + "\n\n".join(line for a in mine for line in _asks(a))
    return prose_cell(text, cell.id, cell.tags)


def _asks(asked: Asked) -> Iterator[str]:
    """What a student has to write for one answer."""
    if isinstance(asked.kind, Choice) and asked.kind.reasons:
        yield "\n\n".join(f"{letter}) {reason}" for letter, reason in asked.kind.letters.items())
    says = f" ({asked.says})" if asked.says else ""
    yield f"→ `{asked.name}`{says}: {wanted(asked.kind, asked.points)}"


def _as_prose(cell: SourceCell, solved: Solved) -> list[Cell]:
    """What a given cell shows, in a Markdown cell."""
    texts: list[str] = []
    attachments: dict[str, Any] = {}
    for output in solved.outputs.get(cell.number, ()):
        data = output.get("data", {})
        if "image/svg+xml" in data:
            name = f"{cell.id}-{len(attachments) + 1}.svg"
            attachments[name] = {"image/svg+xml": base64.b64encode(data["image/svg+xml"].encode()).decode()}
            told = data.get(FIGURE_MIME, {"alt": "a figure", "caption": ""})
            texts.append(f"![{_alt(told['alt'])}](attachment:{name})\n\n{told['caption']}".strip())
        elif TABLE_MIME in data:
            texts.append(_pipe_table(data[TABLE_MIME]))
        elif EQUATION_MIME in data:
            texts.append(f"$${data[EQUATION_MIME]['latex']}$$")
        elif "text/markdown" in data:
            texts.append(data["text/markdown"])
        elif "text/latex" in data:
            texts.append(data["text/latex"])
        else:
            texts.append(f"```\n{data.get('text/plain', output.get('text', ''))}\n```")
    return [prose_cell("\n\n".join(texts), cell.id, [], attachments)] if texts else []


def _alt(text: str) -> str:
    return text.replace("[", "(").replace("]", ")").replace("\n", " ")


def _pipe_table(table: dict[str, Any]) -> str:
    def row(cells: Any) -> str:
        return "| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |"

    marks = {"left": ":--", "right": "--:", "center": ":-:"}
    lines = [row(table["columns"]), row(marks[a] for a in table["align"]), *(row(r) for r in table["rows"])]
    caption = f"*{table['caption']}*\n\n" if table["caption"] else ""
    return caption + "\n".join(lines) + "".join(f"\n\n{note}" for note in table["notes"])
