"""The tests mirror the sources, and every module is tested."""

import ast
import runpy
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
SOURCE = TESTS.parent / "src"
GRAPH = runpy.run_path(str(Path(__file__).parent / "test_imports.py"))
MODULES: dict[str, Path] = GRAPH["MODULES"]
OF_EVERYTHING = {"house", "notebooks", "packaging", "tools"}  # the rules, the notebooks, the installed package
FILES = [p for p in sorted(TESTS.rglob("test_*.py")) if p.relative_to(TESTS).parts[0] not in OF_EVERYTHING]


@cache
def imported_by(test: Path) -> set[str]:
    """The modules of ours that a test imports, wherever in it."""
    found = set()
    for node in ast.walk(ast.parse(test.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found & set(MODULES)


@cache
def imported_by_all() -> frozenset[str]:
    return frozenset().union(*(imported_by(test) for test in TESTS.rglob("*.py")))


def offered() -> set[str]:
    """What a face offers by name ("module:attribute"); its tests and the examples use each of them."""
    tables = [import_module(m).TABLE for m, path in MODULES.items() if "TABLE = {" in path.read_text(encoding="utf-8")]
    return {target.partition(":")[0] for table in tables for target in table.values()}


def folder_tests(module: str) -> list[Path]:
    """The tests in the folder of a module's folder, or of the nearest folder above that has some."""
    folder = MODULES[module].parent.relative_to(SOURCE)
    for place in (folder, *folder.parents):
        if found := [test for test in FILES if test.parent == TESTS / place]:
            return found
    return []


def test_every_module_is_tested():
    """A test imports it, or what imports it (the module whose part it is), or the tests of its folder reach it."""
    tested, reach = imported_by_all() | offered(), GRAPH["reach"]
    parts = [m for m, path in MODULES.items() if path.name != "__init__.py" and not m.endswith("__main__")]

    def is_tested(module: str) -> bool:
        through = {m for test in folder_tests(module) for m in imported_by(test)}
        users = {other for other in MODULES if module in GRAPH["imported"](other)}
        return module in tested or bool(users & tested) or any(module in reach(m) for m in through)

    assert {m for m in parts if not is_tested(m)} == set()


def test_a_folder_of_tests_is_named_after_a_folder_of_the_sources():
    folders = {test.parent.relative_to(TESTS).as_posix() for test in FILES}
    assert {f for f in folders if not (SOURCE / f).is_dir()} == set()


@pytest.mark.parametrize("package", GRAPH["PACKAGES"])
def test_every_folder_of_the_sources_has_folder_tests_its_own_or_in_the_folder_above(package):
    """A folder of parts of one thing (export/read) may be tested as the whole."""
    folders = {path.parent for path in MODULES.values() if path.name != "__init__.py"}
    places = {test.parent for test in FILES}
    assert {
        f
        for f in folders
        if f.is_relative_to(SOURCE / package) and not places & {TESTS / p.relative_to(SOURCE) for p in (f, f.parent)}
    } <= {SOURCE / package, SOURCE}
