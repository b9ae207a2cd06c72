"""The public surface: light until touched, decided in one table, documented by examples that run."""

import ast
import doctest
import subprocess
import sys
import types
from importlib import import_module
from pathlib import Path

import matplotlib
import pytest

import loopbook as lb

matplotlib.use("Agg")

SOURCE = Path(lb.__file__).parent
FACES = ("loopbook", "loopbook.tuning", "loopbook.experiments", "loopbook.design", "loopbook.documents")
HEAVY = ("numpy", "scipy", "sympy", "matplotlib", "pandas", "control", "IPython", "papermill", "nbconvert", "click")


def said(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


def test_the_import_loads_nothing_heavy():
    loaded = said("import sys, loopbook; print(*sys.modules)").split()
    assert not set(loaded) & set(HEAVY)
    assert {m for m in loaded if m.startswith("loopbook")} == {"loopbook", "loopbook.lazy"}


def test_a_loop_needs_no_algebra_no_drawing_and_no_notebooks():
    loaded = said("import sys, loopbook as lb; lb.Loop, lb.tf, lb.PidStandard; print(*sys.modules)").split()
    assert not set(loaded) & (set(HEAVY) - {"numpy", "scipy"})


def test_the_import_is_fast():
    """Measured inside, without the interpreter's start, in time of the processor; the best of five."""
    code = "import time; t = time.process_time(); import loopbook as lb; {}; print(time.process_time() - t)"
    fastest = {what: min(float(said(code.format(what))) for _ in range(5)) for what in ("None", "lb.Loop")}
    assert fastest["None"] < 0.1 and fastest["lb.Loop"] < 0.5


@pytest.mark.parametrize("package", FACES)
def test_every_name_of_a_face_is_there(package):
    face = import_module(package)
    assert face.__all__ == sorted(face.TABLE) == dir(face)
    for name in face.__all__:
        assert getattr(face, name) is not None
    with pytest.raises(AttributeError, match=f"module '{package}' has no attribute 'nothing_of_the_kind'"):
        _ = face.nothing_of_the_kind


def test_a_misspelt_name_is_told_the_nearest():
    with pytest.raises(AttributeError, match="did you mean PidStandard"):
        _ = lb.PidStandart


def test_the_stub_says_the_same_as_the_table():
    tree = ast.parse((SOURCE / "__init__.pyi").read_text(encoding="utf-8"))
    found = {}
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                assert alias.asname, "a stub exports what is imported as itself"
                whole = node.module == "loopbook"
                found[alias.asname] = f"loopbook.{alias.name}" if whole else f"{node.module}:{alias.name}"
    assert found == lb.TABLE
    (listed,) = [n.value for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "__all__"]
    assert ast.literal_eval(listed) == lb.__all__
    assert (SOURCE / "py.typed").exists()


@pytest.mark.parametrize("name", lb.__all__)
def test_a_public_name_has_a_docstring_with_an_example_that_runs(name):
    thing = getattr(lb, name)
    module = thing if isinstance(thing, types.ModuleType) else import_module(thing.__module__)
    examples = doctest.DocTestParser().get_doctest(thing.__doc__ or "", dict(vars(module)), name, None, None)
    assert examples.examples, "an example: >>>"
    runner = doctest.DocTestRunner(optionflags=doctest.FAIL_FAST)
    assert runner.run(examples, out=print).failed == 0


def test_no_module_of_the_engine_imports_the_face():
    for path in sorted(SOURCE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            wrong = "loopbook" in names or (isinstance(node, ast.ImportFrom) and node.module == "loopbook")
            assert not wrong, f"{path.relative_to(SOURCE)}: import what is needed from its own module"
