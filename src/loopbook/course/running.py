"""A sheet run in this process, again and again with other numbers: its author's cells, as a kernel would run them.

For each student a sheet runs once or a few times, for each that draws numbers often: a kernel for each would take the
time of a thousand runs. What a student wrote never runs here, see `loopbook.course.sandbox`.
"""

import ast
import io
import linecache
import traceback
from collections.abc import Callable, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from functools import cache
from types import CodeType
from typing import Any

from loopbook.course.errors import Redraw, SheetError
from loopbook.course.question import Asked
from loopbook.course.session import Session, during
from loopbook.course.sheet import Sheet, is_call, syntax
from loopbook.course.shown import ShownAnswer
from notebook_reports.project.source import SourceCell

Outputs = list[dict[str, Any]]


@dataclass
class Solved:
    """One run. asked: what the sheet asks for, in order, by name. outputs: of each cell that showed something, by its
    number. redraw: why these numbers make no exercise, or ""."""

    parameters: Mapping[str, Any]
    asked: dict[str, Asked] = field(default_factory=dict)
    outputs: dict[int, Outputs] = field(default_factory=dict)
    redraw: str = ""


@dataclass(frozen=True)
class _Compiled:
    """A cell ready to run; the value that it ends with stands under `_LAST` after it."""

    cell: SourceCell
    code: CodeType


_LAST = "__last__"


class SheetRunner:
    """One sheet, compiled once."""

    def __init__(self, sheet: Sheet):
        self.sheet = sheet
        self.cells = [self._compiled(cell) for cell in sheet.programs]

    def _compiled(self, cell: SourceCell) -> _Compiled:
        tree = syntax(cell, self.sheet.id)
        name = f"<{self.sheet.id}, cell {cell.number}>"
        linecache.cache[name] = (len(cell.text), None, cell.text.splitlines(keepends=True), name)
        if tree.body and isinstance(last := tree.body[-1], ast.Expr) and not is_call(last.value, "answer", "require"):
            tree.body[-1] = ast.Assign([ast.Name(_LAST, ast.Store())], last.value)
            ast.fix_missing_locations(tree)
        return _Compiled(cell, compile(tree, name, "exec"))

    def solve(
        self,
        parameters: Mapping[str, Any],
        own: Mapping[str, Any] | None = None,
        show: str = "",
        strict: bool = True,
    ) -> Solved:
        """Run every cell with these numbers.

        own: a student's answers, which later cells go on with. show: what of the cells' outputs is kept: "all", "texts"
        (cells that only draw are not run), or "" for none. Raises SheetError for what the sheet's own code raises.
        """
        space: dict[str, Any] = {"__name__": "__main__"}
        for name, parameter in self.sheet.parameters.items():
            space[name] = parameters.get(name, parameter.default)
        solved = Solved({name: space[name] for name in self.sheet.parameters})
        session = Session(own=own or {}, strict=strict)
        solved.asked = session.asked
        with during(session):
            for compiled in self.cells:
                if show != "all" and compiled.cell.number in self.sheet.only_drawn:
                    continue
                session.cell = compiled.cell.number
                outputs: Outputs = []
                session.show = (lambda asked, to=outputs: to.append(as_output(ShownAnswer(asked)))) if show else None
                try:
                    self._run(compiled, space, outputs if show else None)
                except Redraw as redraw:
                    solved.redraw = redraw.reason
                    return solved
                if outputs:
                    solved.outputs[compiled.cell.number] = outputs
        return solved

    def _run(self, compiled: _Compiled, space: dict[str, Any], outputs: Outputs | None) -> None:
        said = io.StringIO()
        try:
            with redirect_stdout(said):
                exec(compiled.code, space)
                value = space.pop(_LAST, None)
                shown = [as_output(value)] if value is not None and outputs is not None else []
        except Redraw:
            raise
        except Exception as error:
            raise SheetError(self._told(compiled.cell, error)) from error
        if outputs is not None:
            text = said.getvalue()
            outputs += [{"output_type": "stream", "name": "stdout", "text": text}] if text else []
            outputs += shown

    def _told(self, cell: SourceCell, error: Exception) -> str:
        lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename.startswith("<")]
        line = f", line {lines[-1]}" if lines else ""
        name = "" if isinstance(error, SheetError) else f"{type(error).__name__}: "
        return f"{self.sheet.id}, cell {cell.number}{line}: {name}{error}"


def as_output(value: Any) -> dict[str, Any]:
    """What a notebook holds of a value that a cell shows."""
    own = getattr(value, "_repr_mimebundle_", None)
    data, metadata = (own(), {}) if own is not None else _formatter()(value)
    return {"output_type": "display_data", "data": data, "metadata": metadata}


@cache
def _formatter() -> Callable[[Any], tuple[dict[str, Any], dict[str, Any]]]:
    from IPython.core.formatters import DisplayFormatter

    return DisplayFormatter().format
