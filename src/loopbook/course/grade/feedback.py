"""What a student gets back: each answer with its verdict in words and its points; keys only where that is wished."""

from collections.abc import Sequence

from loopbook.course.grade.verdicts import MARKS, Judged
from loopbook.course.notebooks import Cell, Content, code_cell, notebook, prose_cell
from loopbook.course.sheet import Sheet
from loopbook.course.shown import points
from notebook_reports.display import Table, literal
from notebook_reports.export.read.solutions import GIVEN
from notebook_reports.project.printable import printable


def feedback(
    sheet: Sheet, student: str, name: str, judged: Sequence[Judged], remarks: Sequence[str] = (), keys: bool = False
) -> Content:
    """The feedback as a notebook to be exported."""
    total, of = sum(j.points for j in judged), sum(j.of for j in judged)
    who = f"**{literal(student)}**" + (f" ({literal(name)})" if name else "")
    cells: list[Cell] = [
        prose_cell(f"# Feedback: {sheet.title}", "title"),
        prose_cell(f"{who}, sheet `{sheet.id}`: **{total:g} of {points(of)}**.", "sum"),
        code_cell("", "verdicts", [_output(verdicts(judged, keys))], [GIVEN]),
    ]
    if any(j.own for j in judged):
        cells.append(
            prose_cell(
                "What follows from an earlier value of your own is judged from that value: a mistake costs its points "
                "once.",
                "own",
            )
        )
    if remarks:
        cells.append(prose_cell("\n".join(f"- {literal(printable(remark))}" for remark in remarks), "remarks"))
    return notebook(cells, {"contents": False})


def verdicts(judged: Sequence[Judged], keys: bool) -> Table:
    """A line for each answer."""
    columns = ["answer", "you wrote", *(["right is"] if keys else []), "verdict", "points"]
    rows = [
        [f"`{j.name}`", j.given, *([j.key] if keys else []), literal(printable(j.words)), f"{j.points:g} of {j.of:g}"]
        for j in judged
    ]
    align = ["left"] * (len(columns) - 1) + ["right"]
    return Table(columns, rows, "Your answers", align, marks=[MARKS.get(j.verdict, "bad") for j in judged])


def _output(table: Table) -> dict[str, object]:
    return {"output_type": "display_data", "data": table._repr_mimebundle_(), "metadata": {}}
