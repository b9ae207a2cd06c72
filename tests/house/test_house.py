"""The rules of the house: what is exact, how long a module is, what is called how, what is never run."""

import ast
import builtins
from collections import defaultdict
from collections.abc import Callable
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src"
MODULES = sorted(SOURCE.rglob("*.py"))
LINES = 300
LONG: dict[str, str] = {
    "notebook_reports/ledger/printed_data.py": "one format of data, a class for each kind of entry",
    "notebook_reports/pages/ledger_page.py": "the pages of one ledger, a function each",
    "notebook_reports/ledger/document.py": "the checks of one document, a method each",
    "loopbook/process/transfer_function.py": "one algebra: a process, a sum and a quotient, each made of the others",
    "derivations/programs/pid_code.py": "the programs of one regulator, side by side",
    "notebook_reports/export/model.py": "one model of a report, a class for each node",
    "notebook_reports/export/read/html.py": "one reader, a method for each element",
    "notebook_reports/export/read/notebook.py": "one reader, from cells to the model",
    "notebook_reports/export/write/html.py": "one writer, a method for each node of the model",
    "notebook_reports/export/write/typst.py": "one writer, a method for each node of the model",
    "notebook_reports/mathematics/parser.py": "one grammar",
    "notebook_reports/mathematics/write/typst.py": "one writer, a method for each node of the grammar",
    "notebook_reports/mathematics/write/mathml.py": "one writer, a method for each node of the grammar",
}
RUNS_CODE = {
    "loopbook/course/running.py": "a teacher's own sheet, cell by cell, as a kernel runs it",
    "notebook_reports/run/here.py": "the notebook of an installed package, as a kernel runs it",
    "loopbook/code/running.py": "a controller as Python, printed from the derived program",
    "loopbook/controllers/generated.py": "a controller as Python, printed from the derived program",
    "loopbook/printed/store.py": "a function of numbers, printed from a derivation",
    "loopbook/documents/pid_article/c_program.py": "the statements of the C program, proved equal to the derived",
}


@cache
def syntax(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def shown(path: Path) -> str:
    return path.relative_to(SOURCE).as_posix()


DERIVATIONS = [p for p in MODULES if shown(p).startswith("derivations/")]


def none_in(paths: list[Path], wrong: Callable[[Path], list[str]]) -> None:
    """Fails with everything that is wrong, by module."""
    found = {shown(path): said for path in paths if (said := wrong(path))}
    assert found == {}


def test_derivations_are_exact():
    def floats(path: Path) -> list[str]:
        nodes = list(ast.walk(syntax(path)))
        spelling = {n.value for n in nodes if isinstance(n, ast.keyword) and n.arg == "cutoff"}  # for "did you mean"
        constants = [n for n in nodes if isinstance(n, ast.Constant) and n not in spelling]
        inexact = [n for n in constants if isinstance(n.value, float | complex)]
        return [f"line {n.lineno}: {n.value}: write Rational(...)" for n in inexact]

    none_in(DERIVATIONS, floats)


def test_a_module_holds_one_idea_and_says_which():
    def wrong(path: Path) -> list[str]:
        lines = len(path.read_text(encoding="utf-8").splitlines())
        first = (ast.get_docstring(syntax(path)) or "").partition("\n")[0].strip()
        long = lines > LINES and shown(path) not in LONG
        return [
            *([f"{lines} lines; more than {LINES} need a reason in LONG"] if long else []),
            *(["a name that says nothing"] if path.name in ("utils.py", "helpers.py", "common.py", "misc.py") else []),
            *(["a module opens with a line that says what it holds"] if lines and not first else []),
        ]

    none_in(MODULES, wrong)


def test_no_reason_outlives_its_module():
    assert set(LONG) | set(RUNS_CODE) <= {shown(p) for p in MODULES}


BASES = {"derivations": "LoopbookError", "loopbook": "LoopbookError", "notebook_reports": "PressError"}


def test_every_error_of_ours_is_one_of_ours():
    """An error is a LoopbookError or a PressError, whatever built-in it is besides, or derives from one that is."""
    none_in(MODULES, errors_of_others)


def errors_of_others(path: Path) -> list[str]:
    wrong = []
    for node in ast.walk(syntax(path)):
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_") and not node.name.endswith("Warning"):
            bases = {getattr(base, "id", getattr(base, "attr", "")) for base in node.bases}
            known = [vars(builtins).get(base) for base in bases]
            raised = [b for b in known if isinstance(b, type) and issubclass(b, Exception)]
            base = BASES[shown(path).split("/")[0]]
            if raised and node.name != base and base not in bases:
                wrong.append(node.name)
    return wrong


def test_no_two_public_classes_have_one_name():
    where = defaultdict(list)
    for path in MODULES:
        for node in syntax(path).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                where[node.name].append(shown(path))
    assert {name: places for name, places in where.items() if len(places) > 1} == {}


def test_a_function_that_is_imported_by_its_name_has_that_name_alone():
    """`from m import f` in one module and `from n import f` in another are one f."""
    functions = {
        ".".join(path.relative_to(SOURCE).with_suffix("").parts): {
            node.name for node in syntax(path).body if isinstance(node, ast.FunctionDef)
        }
        for path in MODULES
    }
    where = defaultdict(set)
    for path in MODULES:
        for node in ast.walk(syntax(path)):
            if isinstance(node, ast.ImportFrom) and node.module in functions:
                for name in {alias.name for alias in node.names} & functions[node.module]:
                    where[name].add(node.module)
    assert {name: places for name, places in where.items() if len(places) > 1} == {}


GENERAL = {"run", "exact", "coefficients"}
"""Names that fit so many functions that they say nothing: each has a name of its own for what it runs or computes."""


def test_a_name_says_what_is_run_or_computed():
    for path in MODULES:
        assert path.stem == "run" or path.stem not in GENERAL, path
        found = {node.name for node in syntax(path).body if isinstance(node, ast.FunctionDef)} & GENERAL
        assert not found or shown(path) == "derivations/algebra/delay_polynomials.py", f"{shown(path)}: {found}"


def test_what_comes_as_text_is_never_run():
    """No eval, no SymPy parser; exec only of what a derivation printed. sympify takes no text: strict=True."""
    none_in(MODULES, what_is_run)


def what_is_run(path: Path) -> list[str]:
    wrong = []
    for node in ast.walk(syntax(path)):
        if isinstance(node, ast.Call):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            strict = any(k.arg == "strict" and getattr(k.value, "value", None) is True for k in node.keywords)
            if called in ("parse_expr", "S") or (called == "sympify" and not strict):
                wrong.append(f"line {node.lineno}: {called}")
            if isinstance(node.func, ast.Name) and (
                called == "eval" or (called == "exec" and shown(path) not in RUNS_CODE)
            ):
                wrong.append(f"line {node.lineno}: {called}")
    return wrong
