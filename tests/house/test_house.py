"""The rules of the house: who may import whom, what is exact, how long a module is."""

import ast
import sys
from functools import cache
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src"
MODULES = sorted(SOURCE.rglob("*.py"))
LINES = 300
LONG: dict[str, str] = {
    "notebook_reports/ledger/document.py": "the checks of one document, a method each",
    "derivations/programs/pid_code.py": "the programs of one regulator, side by side",
    "notebook_reports/export/model.py": "one model of a report, a class for each node",
    "notebook_reports/export/read/html.py": "one reader, a method for each element",
    "notebook_reports/export/read/notebook.py": "one reader, from cells to the model",
    "notebook_reports/export/write/typst.py": "one writer, a method for each node of the model",
    "notebook_reports/mathematics/parser.py": "one grammar",
    "notebook_reports/mathematics/write/typst.py": "one writer, a method for each node of the grammar",
    "notebook_reports/mathematics/write/mathml.py": "one writer, a method for each node of the grammar",
}
NOTEBOOKS = {"nbformat", "nbconvert", "nbclient", "papermill", "IPython", "ipykernel", "jupyter_client", "jupyter_core"}
APART = ("cli", "design", "documents")  # of loopbook: what uses the engine, and may use the press


def name(path: Path) -> str:
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def syntax(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def imported(path: Path) -> list[tuple[int, str]]:
    """(line, module) for each import of a module, wherever it stands; relative ones made whole."""
    found = []
    for node in ast.walk(syntax(path)):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            package = name(path).split(".") if path.name == "__init__.py" else name(path).split(".")[:-1]
            base = ".".join(package[: len(package) - node.level + 1]) if node.level else ""
            whole = ".".join(filter(None, [base, node.module]))
            found += [
                (node.lineno, f"{whole}.{alias.name}" if is_module(whole, alias.name) else whole)
                for alias in node.names
            ]
    return found


def is_module(package: str, child: str) -> bool:
    place = SOURCE.joinpath(*package.split("."), child)
    return place.with_suffix(".py").exists() or (place / "__init__.py").exists()


def within(module: str, package: str) -> bool:
    return module == package or module.startswith(package + ".")


def of(package: str) -> list[Path]:
    return [p for p in MODULES if within(name(p), package)]


def control() -> list[Path]:
    return [p for p in of("loopbook") if not any(within(name(p), f"loopbook.{part}") for part in APART)]


def shown(path: Path) -> str:
    return path.relative_to(SOURCE).as_posix()


def test_there_are_modules_of_each_kind():
    assert of("derivations") and control() and of("notebook_reports")


@pytest.mark.parametrize("path", of("derivations"), ids=shown)
def test_derivations_need_sympy_alone(path):
    allowed = {"sympy", "derivations", *sys.stdlib_module_names}
    wrong = [f"line {line}: {module}" for line, module in imported(path) if module.split(".")[0] not in allowed]
    assert not wrong


@pytest.mark.parametrize("path", of("derivations"), ids=shown)
def test_derivations_are_exact(path):
    nodes = list(ast.walk(syntax(path)))
    spelling = {
        n.value for n in nodes if isinstance(n, ast.keyword) and n.arg == "cutoff"
    }  # of difflib, for "did you mean"
    constants = [n for n in nodes if isinstance(n, ast.Constant) and n not in spelling]
    floats = [f"line {n.lineno}: {n.value}" for n in constants if isinstance(n.value, float | complex)]
    assert not floats, "write Rational(...)"


@pytest.mark.parametrize("path", control(), ids=shown)
def test_the_engine_knows_neither_notebooks_nor_documents(path):
    apart = ("notebook_reports", *(f"loopbook.{part}" for part in APART))
    wrong = [
        f"line {line}: {module}"
        for line, module in imported(path)
        if module.split(".")[0] in NOTEBOOKS or any(within(module, part) for part in apart)
    ]
    assert not wrong


@pytest.mark.parametrize("path", of("notebook_reports"), ids=shown)
def test_the_press_knows_nothing_of_control(path):
    wrong = [
        f"line {line}: {module}"
        for line, module in imported(path)
        if module.split(".")[0] in ("derivations", "control", "loopbook")
    ]
    assert not wrong


@pytest.mark.parametrize("path", MODULES, ids=shown)
def test_a_module_holds_one_idea_and_says_which(path):
    lines = len(path.read_text(encoding="utf-8").splitlines())
    assert lines <= LINES or shown(path) in LONG, f"{lines} lines; more than {LINES} need a reason in LONG"
    assert path.name not in ("utils.py", "helpers.py", "common.py", "misc.py")
    if lines:
        first = ast.get_docstring(syntax(path))
        assert first and first.splitlines()[0].strip(), "a module opens with a line that says what it holds"


def test_no_reason_outlives_its_module():
    assert set(LONG) <= {shown(p) for p in MODULES}
