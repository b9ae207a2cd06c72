"""Forked kernels: the same bytes as fresh ones, nothing from one notebook to the next, and a way back."""

import io
import sys

import pytest

from notebook_reports.build import apply, verify
from notebook_reports.project.console import Console
from notebook_reports.run import warm, warm_side
from notebook_reports.run.surroundings import environment

pytestmark = [
    pytest.mark.builds,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="kernels are forked on Linux only"),
]
CELLS = [
    "# A notebook",
    "import numpy as np, sympy, sys, os\nimport matplotlib.pyplot as plt\nnp.linalg.eigvals(np.eye(2))",
    "plt.plot([1, 2])\nplt.title('a figure');",
    "!echo hello",
    "hash('a'), __name__, sys.argv[0].endswith('launcher.py'), hasattr(np, 'left_behind'), sys.path[0]",
    "np.left_behind = True\nnp.set_printoptions(precision=2)\nos.environ['LEFT'] = 'behind'\nsympy.Rational(1, 3)",
    "np.array([1 / 3]), 'LEFT' in os.environ",
]


@pytest.fixture(autouse=True)
def forking(monkeypatch):
    monkeypatch.delenv(warm.PLAIN)


@pytest.fixture
def forks(monkeypatch):
    """Count the kernels that are forked."""
    made = []
    fork = warm.Warm.fork

    def counted(self, *order):
        made.append(fork(self, *order))
        return made[-1]

    monkeypatch.setattr(warm.Warm, "fork", counted)
    return made


def test_same_bytes_as_fresh_kernels_and_no_state_between(bench, forks, monkeypatch):
    for id in ("a/one", "a/two"):
        bench.write(id, *CELLS)
    assert bench.build(formats=("ipynb",), jobs=1).code == 0, bench.said
    assert len(forks) == 2 and all(forks)
    forked = verify.hashes_of(bench.root / "reports")
    assert len(set(forked.values())) == 1
    assert any("image/svg+xml" in str(c.get("outputs")) for c in bench.executed("a/two")["cells"])
    monkeypatch.setenv(warm.PLAIN, "1")
    assert bench.build(formats=("ipynb",), jobs=2, force=True).code == 0
    assert len(forks) == 2
    assert verify.hashes_of(bench.root / "reports") == forked


def test_a_forked_kernel_that_dies_is_a_failure(bench, forks):
    bench.write("a/dies", "# A", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)")
    bench.write("a/fails", "# B", "!exit 3")
    outcome = bench.build()
    assert len(forks) == 2 and all(forks)
    assert {f.notebook: f.what.partition(" (")[0] for f in outcome.failures} == {
        "a/dies": "the kernel died",
        "a/fails": "CalledProcessError: Command 'exit 3' returned non-zero exit status 3.",
    }


def test_one_notebook_is_not_worth_warming(bench, forks):
    bench.write("a/one", "# A", "1")
    assert bench.build().code == 0 and forks == []


def test_where_nothing_can_be_forked_kernels_are_started(bench, monkeypatch):
    monkeypatch.setattr(warm.Warm, "fork", lambda *_: None)
    bench.write("a/one", "# A", "1")
    bench.write("a/two", "# B", "2")
    assert bench.build().code == 0


def test_a_library_that_warns_at_import_is_noticed(bench, monkeypatch, tmp_path):
    (tmp_path / "noisy_library.py").write_text("import warnings\nwarnings.warn('old')\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(warm_side, "PRELOADED", ("noisy_library", "not_installed"))
    monkeypatch.setenv("JPY_PARENT_PID", "")
    assert warm_side.preload() == ["old"]


def test_what_is_made_ready_is_found_by_every_kernel(bench, forks, monkeypatch, tmp_path):
    bench.module("shared_work.py", "done = []\n\ndef derive():\n    done.append(1)\n\ndef breaks():\n    1 / 0\n")
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_text("")
    notebook = bench.write(
        "own/uses", "# Uses", ('data: str = ""', "parameters"), "import shared_work\nshared_work.done"
    )
    wanted = apply.items([tmp_path / "a.csv", tmp_path / "b.csv"], None, "out", ["ipynb"])
    console = Console(io.StringIO())
    for ready, found, forked in (("shared_work:derive", "[1]", True), ("shared_work:breaks", "[]", False)):
        forks.clear()
        assert apply.apply(bench.project, notebook, wanted, [], console=console, ready=ready).code == 0
        assert len(forks) == 2 and all(forks) == forked
        for item in wanted:
            assert f'"text/plain": "{found}"' in item.outputs["ipynb"].read_text(encoding="utf-8")


def test_it_ends_with_the_build(bench):
    process = warm.Warm(environment(bench.project))
    pid = process._process.pid
    process.close()
    assert warm.Forked(pid).returncode == 1
