"""An exercise sheet: a notebook of which some cells are questions, some are given, and some the solution."""

import ast
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path

from loopbook.course.errors import SheetError
from notebook_reports.export.read.solutions import GIVEN, QUESTION, SOLUTION
from notebook_reports.project.parameters import NotebookParameter, ParameterError, read_parameters
from notebook_reports.project.project import UsageError
from notebook_reports.project.source import Source, SourceCell, read_source
from notebook_reports.run.filled import names_shown

PARAMETERS = "parameters"


@dataclass(frozen=True)
class Sheet:
    """One sheet. id: the name of its file."""

    id: str
    source: Source

    @cached_property
    def parameters(self) -> dict[str, NotebookParameter]:
        return read_parameters(self.source)

    @property
    def title(self) -> str:
        return self.source.title

    @property
    def cells(self) -> tuple[SourceCell, ...]:
        return self.source.cells

    @cached_property
    def seen(self) -> tuple[SourceCell, ...]:
        """The cells of which a student sees something: prose and what is given, hints too."""
        return tuple(c for c in self.cells if SOLUTION not in c.tags and (c.kind == "markdown" or GIVEN in c.tags))

    @cached_property
    def hidden(self) -> tuple[SourceCell, ...]:
        """The cells of which a student sees nothing."""
        return tuple(c for c in self.cells if c not in self.seen and PARAMETERS not in c.tags)

    @cached_property
    def programs(self) -> tuple[SourceCell, ...]:
        """The code cells in order, without the parameters."""
        return tuple(c for c in self.cells if c.runs and PARAMETERS not in c.tags)

    @cached_property
    def only_drawn(self) -> frozenset[int]:
        """The numbers of given cells that draw a figure and leave nothing for a later cell: not run for a draw."""
        needed: set[str] = set()
        found = set()
        for cell in reversed(self.programs):
            names = list(ast.walk(syntax(cell, self.id)))
            stored = {name for node in names for name in _bound(node)}
            drawn = any(is_call(n, "figure") for n in names)
            if GIVEN in cell.tags and drawn and not stored & needed:
                found.add(cell.number)
            else:
                imports = {name for n in names if isinstance(n, ast.Import | ast.ImportFrom) for name in _bound(n)}
                needed |= {n.id for n in names if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)} - imports
        return frozenset(found)

    @property
    def shown_parameters(self) -> list[str]:
        """The parameters that stand in what a student reads, in their order."""
        shown = {name for cell in self.seen if cell.kind == "markdown" for name in names_shown(cell.text)}
        return [name for name in self.parameters if name in shown]

    @property
    def digest(self) -> str:
        """Changes with anything in the sheet."""
        return sha256((self.source.hash_all() + self.source.hash_code()).encode()).hexdigest()[:16]

    def question_of(self, number: int) -> int:
        """The number of the question's cell that a solution cell belongs to; 0 for none."""
        before = [c.number for c in self.cells if QUESTION in c.tags and c.number < number]
        return before[-1] if before else 0


def read_sheet(path: Path) -> Sheet:
    """Read a sheet and see that it is one. Raises SheetError by cell for what it must not have, or lacks."""
    try:
        sheet = Sheet(path.stem, read_source(path))
        _ = sheet.parameters
    except (UsageError, ParameterError) as error:
        raise SheetError(f"{path.name}: {error}" if path.name not in str(error) else str(error)) from None
    for problem in problems(sheet):
        raise SheetError(f"{path.name}: {problem}")
    return sheet


def syntax(cell: SourceCell, name: str) -> ast.Module:
    """The syntax of a cell. Raises SheetError: a sheet's code is plain Python."""
    try:
        return ast.parse(cell.text)
    except SyntaxError as error:
        told = f"{name}, cell {cell.number}, line {error.lineno}: {error.msg}; a sheet's code is plain Python"
        raise SheetError(told) from None


def problems(sheet: Sheet) -> list[str]:
    """What keeps a notebook from being a sheet."""
    found = []
    if not any(QUESTION in c.tags for c in sheet.cells):
        found.append("no cell is tagged `question`")
    asks = [cell for cell in sheet.programs if any(is_call(n, "answer") for n in ast.walk(syntax(cell, sheet.id)))]
    if not asks:
        found.append("nothing is asked for: no cell calls answer(...)")
    for cell in asks:
        if SOLUTION not in cell.tags:
            found.append(f"cell {cell.number} calls answer(...) and is not tagged `solution`: a student would see it")
        elif not sheet.question_of(cell.number):
            found.append(f"cell {cell.number} answers before the first cell tagged `question`")
    for cell in sheet.cells:
        if cell.kind == "code" and QUESTION in cell.tags:
            found.append(f"cell {cell.number} is code and tagged `question`: a question is text")
        if cell.kind == "raw":
            found.append(f"cell {cell.number} is a raw cell")
        unknown = names_shown(cell.text) - set(sheet.parameters) if cell.kind == "markdown" else set()
        if unknown and cell in sheet.seen:
            found.append(f"cell {cell.number} shows {{{{{min(unknown)}}}}}, which is no parameter")
    return found


def _bound(node: ast.AST) -> list[str]:
    """The names that a statement binds."""
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
        return [node.id]
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return [node.name]
    if isinstance(node, ast.Import | ast.ImportFrom):
        return [(alias.asname or alias.name).partition(".")[0] for alias in node.names]
    return []


def is_call(node: ast.AST, *functions: str) -> bool:
    """Is this a call of one of these functions?"""
    return isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) in functions
