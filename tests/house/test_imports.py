"""Who may import whom, by reach: through every import of ours, also those in functions and under TYPE_CHECKING."""

import ast
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src"
PACKAGES = ("derivations", "loopbook", "notebook_reports")
APART = (
    "__main__",
    "cli",
    "design",
    "code",
    "tuner_page",
    "course",
    "documents",
    "jobs",
)  # of loopbook: what uses the engine
NOTEBOOKS = {"nbformat", "nbconvert", "nbclient", "papermill", "IPython", "ipykernel", "jupyter_client", "jupyter_core"}
HEAVY = NOTEBOOKS | {
    "PIL", "bs4", "control", "dask", "defusedxml", "distributed", "fontTools", "jinja2", "matplotlib", "mistune",
    "mpmath", "numpy", "pandas", "pygments", "pypdfium2", "schemdraw", "scipy", "soupsieve", "sympy", "tinycss2",
    "tqdm", "traitlets", "typst",
}  # fmt: skip
"""Third-party libraries that are worth waiting for only where they are used."""
ONE_SYSTEM = ("fcntl", "msvcrt", "pwd", "resource")
"""Of the standard library, what not every system has."""


def dotted(path: Path) -> str:
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {dotted(path): path for path in sorted(SOURCE.rglob("*.py"))}


@cache
def imports(module: str) -> tuple[tuple[str, int, str], ...]:
    """(imported module, line, the function around it or "") for each import, wherever it stands."""

    def within_node(node: ast.AST, function: str) -> Iterator[tuple[str, int, str]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import):
                yield from ((alias.name, child.lineno, function) for alias in child.names)
            elif isinstance(child, ast.ImportFrom):
                assert not child.level, f"{module}, line {child.lineno}: imports are written in full"
                for alias in child.names:
                    whole = f"{child.module}.{alias.name}"
                    yield (whole if whole in MODULES else str(child.module)), child.lineno, function
            is_function = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
            yield from within_node(child, getattr(child, "name", "lambda") if is_function else function)

    return tuple(within_node(ast.parse(MODULES[module].read_text(encoding="utf-8")), ""))


@cache
def imported(module: str, everywhere: bool = True) -> frozenset[str]:
    """What a module imports; of ours also the packages around it. everywhere: also inside functions."""
    found = {name for name, _, function in imports(module) if everywhere or not function}
    parents = {name.rpartition(".")[0] for name in found | {module} if name in MODULES}
    return frozenset((found | {p for p in parents if p in MODULES}) - {module})


@cache
def reach(module: str, everywhere: bool = True) -> frozenset[str]:
    """Every module that a module reaches; third-party ones by their first name."""
    met, todo = set(), [module]
    while todo:
        for name in imported(todo.pop(), everywhere):
            if name in MODULES and name not in met:
                todo.append(name)
            met.add(name if name in MODULES else name.partition(".")[0])
    return frozenset(met)


def within(module: str, *packages: str) -> bool:
    return any(module == package or module.startswith(f"{package}.") for package in packages)


def engine() -> list[str]:
    return [m for m in MODULES if within(m, "loopbook") and not within(m, *(f"loopbook.{part}" for part in APART))]


def of(package: str) -> list[str]:
    return [m for m in MODULES if within(m, package)]


def test_there_are_modules_of_each_kind():
    assert all(len(of(package)) > 30 for package in PACKAGES) and len(engine()) > 30
    assert "sympy" in reach("loopbook.tuning.migo") and "loopbook.numerics.horner" in reach("loopbook.loop.sampled")


def too_far(modules: list[str], wrong: Callable[[str], bool]) -> dict[str, set[str]]:
    """What each module reaches that it must not."""
    found = {module: {m for m in reach(module) if wrong(m)} for module in modules}
    return {module: names for module, names in found.items() if names}


def test_derivations_reach_sympy_and_the_standard_library_alone():
    allowed = {"sympy", *sys.stdlib_module_names}
    assert too_far(of("derivations"), lambda m: not within(m, "derivations") and m not in allowed) == {}


def test_the_press_reaches_nothing_of_control():
    assert too_far(of("notebook_reports"), lambda m: within(m, "loopbook", "derivations", "control")) == {}


def test_the_engine_reaches_neither_the_press_nor_notebooks_nor_what_uses_it():
    apart = ("notebook_reports", *(f"loopbook.{part}" for part in APART), *NOTEBOOKS)
    assert too_far(engine(), lambda m: within(m, *apart)) == {}


def test_plots_know_no_class_of_ours():
    """They take arrays."""
    face = {"loopbook", "loopbook.extras", *reach("loopbook")}
    ours = lambda m: within(m, *PACKAGES) and not within(m, "loopbook.plots") and m not in face  # noqa: E731
    assert too_far(of("loopbook.plots"), ours) == {}


def test_nothing_imports_the_face():
    written = {m for m in MODULES if m != "loopbook" for name, _, _ in imports(m) if name == "loopbook"}
    assert not written, "import the module that holds it"


def circles(edges: dict[str, set[str]]) -> list[list[str]]:
    """The strongly connected parts of more than one node (Tarjan)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(node: str) -> None:
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(edges.get(node, ())):
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            part = [stack.pop()]
            while part[-1] != node:
                part.append(stack.pop())
            if len(part) > 1:
                found.append(sorted(part))

    for node in sorted(edges):
        if node not in index:
            visit(node)
    return found


def written(module: str) -> set[str]:
    """What the import statements of a module name; the face of a folder counts where it is imported from."""
    return {name for name, _, _ in imports(module) if name in MODULES and name != module}


def test_no_modules_import_each_other_in_a_circle():
    assert not circles({m: written(m) for m in MODULES})


FOLDERS = sorted({dotted(path.parent / "__init__.py") for path in MODULES.values()})


def test_no_parts_of_a_folder_import_each_other_in_a_circle():
    """The modules and folders directly in a folder, each with all that lies in it, as one node."""
    assert {folder: found for folder in FOLDERS if (found := circles(edges_within(folder)))} == {}


def edges_within(folder: str) -> dict[str, set[str]]:
    def part(module: str) -> str:
        return module.removeprefix(f"{folder}.").partition(".")[0] if module != folder else "__init__"

    edges: dict[str, set[str]] = {}
    for module in of(folder):
        others = {part(m) for m in written(module) if within(m, folder)}
        edges.setdefault(part(module), set()).update(others - {part(module)})
    return edges


def test_circles_are_seen():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": set()}) == [["b", "c"]]


def waits_for_something(module: str, name: str) -> bool:
    """Does an import inside a function keep a heavy library from being loaded before it is needed?"""
    if name not in MODULES:
        return name.partition(".")[0] in HEAVY or name in ONE_SYSTEM
    return within(module, "notebook_reports") and bool((reach(name, False) - reach(module, False)) & HEAVY)


@pytest.mark.parametrize("package", PACKAGES)
def test_imports_stand_at_the_top_of_a_module(package):
    """Inside a function only a heavy third-party library is imported, or what only one command needs.

    The press also waits with its own modules that load such a library when they are imported: a build with nothing to
    do loads none of them.
    """
    late = [
        f"{module}, line {line}, {function}: {name}"
        for module in of(package)
        if not module.endswith((".cli", ".__main__"))
        for name, line, function in imports(module)
        if function and not waits_for_something(module, name)
    ]
    assert not late
