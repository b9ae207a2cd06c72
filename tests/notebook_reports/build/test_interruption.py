"""Ctrl-C, a full disk, a second build: the exit code says it, nothing is half written, nothing is left running."""

import errno
import os
import signal
import subprocess
import sys
import threading

import pytest

from notebook_reports.project import atomic
from notebook_reports.project.project import EnvironmentProblem

pytestmark = [pytest.mark.builds, pytest.mark.skipif(sys.platform == "win32", reason="signals and limits of POSIX")]


def start(bench, *arguments: str, **options) -> subprocess.Popen:
    command = [
        sys.executable,
        "-m",
        "loopbook.cli",
        "--root",
        str(bench.root),
        "build",
        "--format",
        "ipynb",
        *arguments,
    ]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_build(bench, number):
    """The notebook itself says that it runs, through a pipe; then the build is interrupted."""
    fifo = bench.root / "running"
    os.mkfifo(fifo)
    bench.write("a/first", "# A", "1")
    wait = f"import os, threading\nopen({str(fifo)!r}, 'w').write(str(os.getpid()))\nthreading.Event().wait()"
    bench.write("a/endless", "# B", wait)
    assert bench.build("a/first", formats=("ipynb",)).code == 0
    process = start(bench)
    kernel = int(fifo.read_text())
    process.send_signal(number)
    said, _ = process.communicate(timeout=30)
    assert process.returncode == 130, said
    assert "interrupted: what was finished stays" in said and "Traceback" not in said
    with pytest.raises(ProcessLookupError):
        os.kill(kernel, 0)
    assert bench.reports() == ["a/first.ipynb"]
    bench.write("a/endless", "# B", "2")
    assert bench.build(formats=("ipynb",)).code == 0
    assert "ok    a/endless" in bench.said and bench.reports() == ["a/endless.ipynb", "a/first.ipynb"]


def test_a_full_disk(bench):
    """No file may grow over 64 kB, so the executed notebook cannot be written."""
    import resource

    bench.write("a/large", "# A", "'x' * 200_000")
    bench.write("a/small", "# B", "1")
    limit = (65536, 65536)
    process = start(bench, "-j1", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit))
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 3, said
    assert "a/large: cannot write" in said and "File too large" in said and "Traceback" not in said
    assert bench.reports() == ["a/small.ipynb"]
    assert not list(bench.root.rglob("*.part"))


def test_no_space_left_says_what_to_do(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = tmp_path / "a.pdf"
    path.write_text("old")
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(EnvironmentProblem, match=r"cannot write .*a\.pdf: No space left on device; free some space"):
        atomic.write(path, b"new")
    assert path.read_text() == "old" and os.listdir(tmp_path) == ["a.pdf"]


def test_a_second_build_waits_for_the_first(bench):
    bench.write("a/b", "# A", "1")
    said = []
    first = threading.Event()

    def second():
        with atomic.only_builder(bench.project.cache, lambda who: (said.append(who), first.set())):
            said.append("mine")

    with atomic.only_builder(bench.project.cache, said.append):
        thread = threading.Thread(target=second)
        thread.start()
        assert first.wait(10)
        assert said == [f"process {os.getpid()}"]
    thread.join(10)
    assert said[-1] == "mine"


def test_the_lock_dies_with_its_process(bench):
    """A build that was killed leaves nothing that stops the next one."""
    bench.write("a/b", "# A", "import os, signal; os.kill(os.getppid(), signal.SIGKILL)")
    process = start(bench)
    process.communicate(timeout=30)
    assert process.returncode == -signal.SIGKILL
    bench.write("a/b", "# A", "1")
    assert bench.build().code == 0
