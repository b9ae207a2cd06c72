"""Strict parameters: what a notebook may be given is known, typed and checked before a kernel starts.

A notebook has at most one cell tagged ``parameters``; each of its statements is one annotated literal with a unit
comment, which may hold the range::

    q: float = 0.5  # pole of the observer, [0, 1)
    h: float = 1.0  # s, > 0
    method: str = "PI"  # {"P", "PI", "PID"}

Types: bool, int, float, str, list[...] and tuple[..., ...] of these, ``| None``. A value is passed on as the value it
is, never as text to be run.
"""

import ast
import difflib
import io
import keyword
import math
import re
import tokenize
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from notebook_reports.project.project import UsageError
from notebook_reports.project.ranges import Range, read_range
from notebook_reports.project.source import Source, SourceCell

SIMPLE = {"bool": bool, "int": int, "float": float, "str": str}


_NUMBER = {
    "int": re.compile(r"[+-]?(?:0|[1-9][0-9]*)"),
    "float": re.compile(r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|inf|nan)", re.ASCII),
}
"""A number on the command line: as one writes it, without underscores; an integer without zeros before it."""


class ParameterError(UsageError):
    """A parameter of a notebook, or a value given for one, is not usable. name: the parameter, where known."""

    def __init__(self, message: str, name: str = ""):
        super().__init__(message)
        self.name = name


@dataclass(frozen=True)
class NotebookParameter:
    """One parameter. type: as annotated, ``float``, ``list[float]``, ``str | None``. comment: unit and range."""

    name: str
    type: str
    default: Any
    comment: str
    range: Range

    def from_text(self, text: str) -> Any:
        """The typed value of a command-line word. Raises ParameterError."""
        return self.check(_parse(text, self.type, self.name))

    def check(self, value: Any) -> Any:
        """The value as its type, an int made a float where a float is due. Raises ParameterError."""
        value = _typed(value, self.type, self.name)
        if not self.range.holds(value):
            what = f"{self.name} = {value!r} is out of range: {self.range.text}"
            raise ParameterError(f"{what} (the notebook says: {self.comment})", self.name)
        return value


def read_parameters(source: Source) -> dict[str, NotebookParameter]:
    """The parameters of a notebook by name; none where no cell is tagged.

    Raises ParameterError where two cells are tagged or a statement is not a literal of its annotated type.
    """
    cells = source.tagged("parameters")
    if not cells:
        return {}
    if len(cells) > 1:
        numbers = " and ".join(str(c.number) for c in cells)
        raise ParameterError(f"cells {numbers} are both tagged `parameters`; keep one")
    return {p.name: p for p in _statements(cells[0])}


def assign(source: Source, given: Mapping[str, Any] | Sequence[tuple[str, str]]) -> dict[str, Any]:
    """Typed values for the parameters named, ready for the kernel.

    given: a mapping to Python values, or (name, text) pairs as the command line has them. Raises ParameterError for
    a name that the notebook does not have (with the nearest), given twice, or a value of the wrong type or range.
    """
    pairs = list(given.items()) if isinstance(given, Mapping) else list(given)
    if not pairs:
        return {}
    known = read_parameters(source)
    if not source.tagged("parameters"):
        raise ParameterError(
            f"{source.path.name} takes no parameters: it has no cell tagged `parameters`; "
            "tag the cell that assigns them (JupyterLab: property inspector, cell tags)"
        )
    values: dict[str, Any] = {}
    for name, value in pairs:
        if not name.isidentifier() or keyword.iskeyword(name):
            raise ParameterError(f"parameter {name!r} is not a name", name)
        if name not in known:
            near = [k for k in known if k.casefold() == name.casefold()]
            near = near or difflib.get_close_matches(name, known, n=2, cutoff=0.5)
            hint = f"did you mean {' or '.join(near)}?" if near else f"it has {', '.join(known) or 'none'}"
            raise ParameterError(f"{source.path.name} has no parameter {name!r}; {hint}", name)
        if name in values:
            raise ParameterError(f"parameter {name} is given twice", name)
        as_text = not isinstance(given, Mapping)
        values[name] = known[name].from_text(value) if as_text else known[name].check(value)
    return values


def _statements(cell: SourceCell) -> list[NotebookParameter]:
    where = f"cell {cell.number} (parameters)"
    try:
        tree = ast.parse(cell.text)
    except SyntaxError as error:
        raise ParameterError(f"{where}, line {error.lineno}: {error.msg}") from None
    except (RecursionError, MemoryError, ValueError) as error:
        raise ParameterError(f"{where}: cannot be read ({str(error) or 'nested too deeply'})") from None
    comments = _comments(cell.text)
    found: dict[str, NotebookParameter] = {}
    for node in tree.body:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        target, value = _assigned(node)
        line = f"{where}, line {node.lineno}"
        if not isinstance(target, ast.Name) or value is None:
            raise ParameterError(
                f"{line}: `{ast.unparse(node)}` is not of the form `name: type = value  # unit, range`"
            )
        name = target.id
        try:
            default = ast.literal_eval(value)
        except ValueError:
            raise ParameterError(
                f"{line}: {name} = {ast.unparse(value)} is derived; another value for what it derives from would "
                "not reach it: move it to the next cell",
                name,
            ) from None
        if name in found:
            raise ParameterError(f"{line}: {name} is assigned twice", name)
        kind = ast.unparse(node.annotation) if isinstance(node, ast.AnnAssign) else _infer(default, line, name)
        comment = comments.get(node.end_lineno or node.lineno) or comments.get(node.lineno, "")
        try:
            parameter = NotebookParameter(name, kind.strip("'\""), default, comment, read_range(comment))
            found[name] = NotebookParameter(name, parameter.type, parameter.check(default), comment, parameter.range)
        except ParameterError as error:
            raise ParameterError(f"{line}: {error}", name) from None
    return list(found.values())


def _comments(text: str) -> dict[int, str]:
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return {t.start[0]: t.string.lstrip("# ").strip() for t in tokens if t.type == tokenize.COMMENT}


def _infer(default: Any, line: str, name: str) -> str:
    for kind, cls in SIMPLE.items():
        if type(default) is cls:
            return kind
    if isinstance(default, list | tuple) and default:
        inner = _infer(default[0], line, name)
        return f"list[{inner}]" if isinstance(default, list) else f"tuple[{inner}, ...]"
    raise ParameterError(f"{line}: annotate {name} with its type, {name}: float = ...", name)


def _item_type(kind: str) -> str:
    return kind[kind.index("[") + 1 : -1].removesuffix("...").strip().rstrip(",").strip()


def _wrong(name: str, value: Any, kind: str, why: str = "") -> ParameterError:
    return ParameterError(f"{name} = {value!r} is not {_article(kind)}{why}", name)


def _article(kind: str) -> str:
    return ("an " if kind[0] in "aeiou" else "a ") + kind


def _parse(text: str, kind: str, name: str) -> Any:
    if kind.endswith("| None"):
        return None if text.strip().lower() == "none" else _parse(text, kind.removesuffix("| None").strip(), name)
    if kind == "str":
        return text
    if kind == "bool":
        if text.strip().lower() not in ("true", "false"):
            raise _wrong(name, text, kind, ": write true or false")
        return text.strip().lower() == "true"
    if kind in ("int", "float"):
        if not _NUMBER[kind].fullmatch(text.strip()):
            raise _wrong(name, text, kind)
        try:
            return SIMPLE[kind](text)
        except ValueError:
            raise _wrong(name, text, kind, ": it has too many digits") from None
    if kind.startswith(("list[", "tuple[")):
        try:
            value = ast.literal_eval(text if text.strip()[:1] in ("[", "(") else f"[{text}]")
        except (ValueError, SyntaxError, RecursionError, MemoryError, TypeError):
            raise _wrong(name, text, kind, ": write values with commas between them") from None
        return tuple(value) if kind.startswith("tuple") else list(value)
    raise ParameterError(f"{name} has the type {kind}; known are {', '.join(SIMPLE)}, lists and tuples of them", name)


def _typed(value: Any, kind: str, name: str) -> Any:
    if kind.endswith("| None"):
        return None if value is None else _typed(value, kind.removesuffix("| None").strip(), name)
    if kind.startswith(("list[", "tuple[")):
        shape = list if kind.startswith("list[") else tuple
        if not isinstance(value, list | tuple):
            raise _wrong(name, value, kind)
        return shape(_typed(v, _item_type(kind), name) for v in value)
    if kind not in SIMPLE:
        raise ParameterError(
            f"{name} has the type {kind}; known are {', '.join(SIMPLE)}, lists and tuples of them", name
        )
    if kind == "float" and type(value) is int:
        value = float(value)
    if type(value) is not SIMPLE[kind]:
        raise _wrong(name, value, kind, f" but {_article(type(value).__name__)}")
    if isinstance(value, float) and not math.isfinite(value):
        raise _wrong(name, value, kind, " that can be computed with")
    return value


def _assigned(node: ast.stmt) -> tuple[ast.expr | None, ast.expr | None]:
    """(target, value) of an assignment to one target, (None, None) of anything else."""
    if isinstance(node, ast.AnnAssign):
        return node.target, node.value
    if isinstance(node, ast.Assign) and len(node.targets) == 1:
        return node.targets[0], node.value
    return None, None
