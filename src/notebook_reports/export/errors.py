"""The error of an export: it names the notebook, the cell, what is wrong and how to mend it."""

from dataclasses import dataclass

from notebook_reports.errors import PressError


@dataclass(frozen=True)
class Problem:
    """One thing a report cannot show. cell: 1-based position in the notebook, None where no cell is at fault."""

    cell: int | None
    text: str


class ExportError(PressError, RuntimeError):
    """A notebook cannot be exported without losing something.

    notebook: its name. cell: 1-based position of the first cell at fault, or None. problem: what is wrong there and
    how to mend it. problems: everything found, in the order of the cells.

    >>> str(ExportError("double_tank/03", [Problem(7, "no image a.png; put it beside the notebook")]))
    'double_tank/03, cell 7: no image a.png; put it beside the notebook'
    """

    def __init__(self, notebook: str, problems: list[Problem]):
        self.notebook = notebook
        self.problems = sorted(problems, key=lambda p: p.cell or 0)
        self.cell = self.problems[0].cell
        self.problem = self.problems[0].text
        lines = []
        for problem in self.problems:
            where = f"{notebook}, cell {problem.cell}" if problem.cell else notebook
            lines.append(f"{where}: {problem.text}")
        super().__init__("\n".join(lines))


class CannotShow(PressError, ValueError):
    """One piece of a cell has no form a report can show; the reader of the notebook adds the cell.

    The message says what is wrong and how to mend it, to the writer of the notebook. kind, reason, text, address: for
    the reader of a page where a `model.Mend` stands instead; the reason is the message where none is given.
    """

    def __init__(self, message: str, kind: str = "output", reason: str = "", text: str = "", address: str = ""):
        super().__init__(message)
        self.kind = kind
        self.reason = reason or message
        self.text = text
        self.address = address
