"""The process in which a student's notebook runs: its cells, then its answers as plain JSON; functions stay.

Nothing here is trusted by what reads it: whatever the notebook changes in this process, what comes out is a line of
JSON with numbers and texts in it.
"""

import io
import json
import math
import traceback
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from typing import Any

MOST_ITEMS, MOST_TEXT, DEEPEST = 50_000, 20_000, 3
MOST_FUNCTIONS = 20
_NUMPY_KINDS = {
    "bool",
    "float64",
    "float32",
    "float16",
    "int64",
    "int32",
    "int16",
    "int8",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
}


class _Refused(Exception):
    """A value that cannot leave."""


def new_shell() -> Any:
    """What runs the cells."""
    from IPython.core.interactiveshell import InteractiveShell
    from traitlets.config import Config

    class Shell(InteractiveShell):
        """One that takes ``%matplotlib inline`` without a screen."""

        def enable_gui(self, gui: Any = None) -> None:
            return None

    return Shell.instance(colors="NoColor", config=Config({"HistoryManager": {"enabled": False}}))


def run_cells(shell: Any, cells: list[str]) -> tuple[dict[str, Any], dict[str, Callable[..., Any]]]:
    """Run the code cells as a kernel would. Gives what is to be said first, and the functions among the answers.

    A cell that fails does not stop the next; its error is told.
    """
    failed = []
    sink = io.StringIO()
    for number, source in enumerate(cells, 1):
        with redirect_stdout(sink), redirect_stderr(sink):
            try:
                result = shell.run_cell(source, store_history=False, silent=True)
                error = result.error_before_exec or result.error_in_exec
            except BaseException as raised:
                error = raised
        sink.seek(0)
        sink.truncate()
        if error is not None:
            failed.append([number, f"{type(error).__name__}: {str(error)[:200]}"])
    return _answers(shell.user_ns.get("answers"), failed)


def _answers(found: Any, failed: list[list[Any]]) -> tuple[dict[str, Any], dict[str, Callable[..., Any]]]:
    functions: dict[str, Callable[..., Any]] = {}
    if type(found) is not dict:
        what = "missing" if found is None else f"a {type(found).__name__}"
        return {"answers": None, "why": what, "failed": failed}, functions
    plain: dict[str, Any] = {}
    for name in list(found)[:200]:
        if type(name) is not str or len(name) > 100:
            continue
        value = found[name]
        if callable(value) and not hasattr(value, "free_symbols") and len(functions) < MOST_FUNCTIONS:
            functions[name] = value
            plain[name] = {"function": name}
            continue
        try:
            plain[name] = {"value": _plain(value, 0)}
        except _Refused as refused:
            plain[name] = {"refused": str(refused)}
        except BaseException as error:
            plain[name] = {"refused": f"{type(error).__name__}: {str(error)[:100]}"}
    return {"answers": plain, "failed": failed}, functions


def _plain(value: Any, depth: int) -> Any:
    """A value as JSON holds it: only plain numbers, texts, and lists of them; numbers of NumPy and SymPy as floats."""
    kind = type(value)
    if value is None or kind in (bool, str):
        if kind is str and len(value) > MOST_TEXT:
            raise _Refused("a text that is too long")
        return value
    if kind is int:
        if abs(value) > 1 << 62:
            raise _Refused("a number that is too large")
        return value
    if kind is float:
        if not math.isfinite(value):
            raise _Refused(f"{value} is no number that can be compared")
        return value
    module = kind.__module__.split(".")[0]
    if module == "numpy" and kind.__name__ in _NUMPY_KINDS:
        return _plain(value.item(), depth)
    if kind in (list, tuple) or (module == "numpy" and kind.__name__ == "ndarray"):
        if depth >= DEEPEST or len(value) > MOST_ITEMS:
            raise _Refused("a list that is too long or too deep")
        return [_plain(v, depth + 1) for v in (value.tolist() if module == "numpy" else value)]
    if module == "sympy":
        return _plain(float(value), depth) if value.is_number else str(value)[:MOST_TEXT]
    raise _Refused(f"a value of the kind {kind.__name__}, which is no number, text or list")


def _reply(functions: dict[str, Callable[..., Any]], order: dict[str, Any]) -> dict[str, Any]:
    try:
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            found = functions[order["call"]](*order["arguments"])
        return {"value": _plain(found, 0)}
    except _Refused as refused:
        return {"refused": str(refused)}
    except BaseException as error:
        return {"refused": f"{type(error).__name__}: {str(error)[:200]}"}


def serve(orders: Any, replies: Any, shell: Any) -> None:
    """Read the cells, run them, tell the answers; then call functions until nobody asks any more."""
    first = json.loads(orders.readline())
    try:
        told, functions = run_cells(shell, first["cells"])
    except BaseException:
        told, functions = {"answers": None, "why": traceback.format_exc(limit=1)[-300:], "failed": []}, {}
    tell_line(replies, told)
    for line in orders:
        tell_line(replies, _reply(functions, json.loads(line)))


def tell_line(replies: Any, told: dict[str, Any]) -> None:
    """Write one line of JSON."""
    replies.write(json.dumps(told, allow_nan=False) + "\n")
    replies.flush()
