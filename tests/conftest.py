"""What all tests share: the settings, the one build of the project's notebooks, and what `make quick` leaves out."""

import io
import os
import re
import sys
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # many small matrices: threads cost more than they bring

import numpy as np  # noqa: E402
import pytest  # noqa: E402
from hypothesis import settings  # noqa: E402

from notebook_reports.run.quick_imports import import_nbformat  # noqa: E402

import_nbformat()

# The same examples on every run, so that a failure repeats itself; no deadline, so that a slow machine is no failure.
settings.register_profile("loopbook", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("loopbook")

BUILDS = "starts a kernel or a compiler (C, Typst, TeX); left out by --quick"
COMPILERS = ("cc", "gcc", "g++", "clang", "clang++", "xelatex")
MODULES = ("ipykernel", "nbconvert", "notebook_reports")  # of a command `python -m module`
FIXTURES = {"outcome", "refused", "size", "understood"}  # these build


def pytest_addoption(parser):
    parser.addoption("--quick", action="store_true", help="no test that starts a kernel or a compiler or takes long")
    parser.addoption("--whole", action="store_true", help="all of what `make test` takes a seeded share of")


def pytest_configure(config):
    config.addinivalue_line("markers", f"builds: {BUILDS}")
    config.addinivalue_line("markers", "seeds(part, whole): a test for each seed, the first ones alone in `make test`")
    config.addinivalue_line(
        "markers", "whole: one more of a kind that `make test` tries; for `make test WHOLE=1` alone"
    )
    config.addinivalue_line("markers", "long: computes for over 0.4 s (surveys, many seeds); left out by --quick")
    if config.getoption("--quick"):
        _refuse_builders()


def pytest_generate_tests(metafunc):
    for marker in metafunc.definition.iter_markers("seeds"):
        part, whole = marker.args
        metafunc.parametrize("seed", range(whole if metafunc.config.getoption("--whole") else part))


def pytest_ignore_collect(collection_path, config):
    """Modules of which --quick leaves out every test are not even imported."""
    if not config.getoption("--quick") or collection_path.suffix != ".py":
        return None
    marked = re.search(
        r"^pytestmark = (?:\[\s*)?pytest\.mark\.(builds|long)\b",
        collection_path.read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    return True if marked else None


def pytest_collection_modifyitems(config, items):
    for item in items:
        if FIXTURES & set(getattr(item, "fixturenames", ())):
            item.add_marker("builds")
    if not config.getoption("--whole"):
        more = [item for item in items if item.get_closest_marker("whole")]
        config.hook.pytest_deselected(items=more)
        items[:] = [item for item in items if item not in more]
    if config.getoption("--quick"):
        left_out = {item for item in items if item.get_closest_marker("builds") or item.get_closest_marker("long")}
        config.hook.pytest_deselected(items=list(left_out))
        items[:] = [item for item in items if item not in left_out]


def _refuse_builders():
    """A test that is not marked and builds all the same fails and says what it lacks."""
    import typst

    def refuse(what):
        raise RuntimeError(f"this test starts {what}: mark it with @pytest.mark.builds, it {BUILDS}")

    def hook(event, arguments):
        if event == "subprocess.Popen":
            words = [os.fspath(word) for word in arguments[1][:3]] if isinstance(arguments[1], list | tuple) else []
            if words and (os.path.basename(words[0]) in COMPILERS or words[-1].startswith(MODULES)):
                refuse(" ".join(words))

    sys.addaudithook(hook)
    for name in ("Compiler", "compile", "compile_with_warnings", "query"):
        setattr(typst, name, lambda *_, name=name, **__: refuse(f"typst.{name}"))


@pytest.fixture(scope="session")
def share(request):
    """How much of a long survey runs: share(8, 40) is 8 in `make test` and 40 in `make test WHOLE=1`."""
    return lambda part, whole: whole if request.config.getoption("--whole") else part


@pytest.fixture(autouse=True)
def no_figure_is_left_open():
    """What a test draws is closed behind it."""
    yield
    if (pyplot := sys.modules.get("matplotlib.pyplot")) is not None:
        pyplot.close("all")


@pytest.fixture(scope="session")
def outcome():
    """The project's notebooks, run where something changed since the last build; no reports are written.

    All tests that look at what the notebooks say share this build; the workers of one test run wait for each other.
    """
    from notebook_reports.build.build import build
    from notebook_reports.build.work import Wanted
    from notebook_reports.project.console import Console
    from notebook_reports.project.project import project_at
    from notebook_reports.run.warm import PLAIN

    with pytest.MonkeyPatch.context() as patch:
        patch.delenv(PLAIN, raising=False)
        project = project_at(Path(__file__).parents[1])
        return build(project, wanted=Wanted(formats=()), console=Console(io.StringIO()), ledger=False)


@pytest.fixture(scope="session")
def survey_holds():
    """A check of what the branch and bound says of intervals between edges against many points of each."""

    def check(curve, edges) -> None:
        share = np.linspace(0, 1, 101)[1:-1, None]
        for width in (1.0, 1e-2):
            a, b = edges[:-1], edges[:-1] + width * np.diff(edges)
            values, bound = curve.survey(a, b)
            seen = curve.distance(a + share * (b - a))
            assert (seen >= bound - 1e-9 * (1 + abs(bound))).all()
            assert values == pytest.approx(seen[49], rel=1e-9)

    return check


def pytest_terminal_summary(terminalreporter):
    """Tables that tests leave for a reader (``record_property("table", ...)``) end the output, and files left out."""
    for report in terminalreporter.getreports("passed") + terminalreporter.getreports("failed"):
        for name, text in report.user_properties:
            if name == "table":
                terminalreporter.write_line(f"\n{text}")
    for report in terminalreporter.getreports("skipped"):
        if isinstance(report, pytest.CollectReport) and isinstance(report.longrepr, tuple):
            why = report.longrepr[2].removeprefix("Skipped: ")
            terminalreporter.write_line(f"left out: {report.nodeid}: {why}")
