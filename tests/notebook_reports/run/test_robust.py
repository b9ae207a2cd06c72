"""What the machine does to a build: limits, signals, killed processes, children left, users without a home."""

import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from notebook_reports.build.doctor import examine
from notebook_reports.project import atomic, limits, runtime
from notebook_reports.project.project import EnvironmentProblem
from notebook_reports.run import leftovers, warm
from notebook_reports.run.surroundings import environment

pytestmark = [
    pytest.mark.builds,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="processes and limits of Linux"),
]


@pytest.fixture
def short():
    """A folder for temporary files with a short name, as the usual one has."""
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        yield Path(folder)


def start(bench, *arguments: str, **options) -> subprocess.Popen:
    command = [sys.executable, "-P", "-m", "loopbook.cli", "--root", str(bench.root), "build", "--format", "ipynb"]
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, **options}
    return subprocess.Popen([*command, *arguments], **options)


def limited(bench, *what):
    import resource

    def limit():
        for name, value in what:
            resource.setrlimit(name, (value, value))

    process = start(bench, preexec_fn=limit)
    said, _ = process.communicate(timeout=60)
    return process.returncode, said


def test_too_few_files_or_too_little_memory_are_said_before_work(bench):
    import resource

    bench.write("a/b", "# A", "1")
    code, said = limited(bench, (resource.RLIMIT_NOFILE, 64))
    assert code == 3 and "only 64 files may be open at once" in said and "Traceback" not in said
    code, said = limited(bench, (resource.RLIMIT_AS, 400_000_000))
    assert code == 3 and "only 400 MB of memory are allowed" in said and "Traceback" not in said
    assert bench.reports() == []


def test_a_small_container_is_said(monkeypatch, tmp_path):
    (tmp_path / "memory.max").write_text("400000000\n")
    monkeypatch.setattr(limits, "_CONTAINER", tmp_path / "memory.max")
    with pytest.raises(EnvironmentProblem, match="this container has 400 MB"):
        limits.check(1)
    (tmp_path / "memory.max").write_text("max\n")
    limits.check(1)


def test_a_child_that_a_cell_left_running_is_ended_and_named(bench):
    """One in the kernel's session, one in a session of its own."""
    code = (
        "import subprocess\nfor own in (False, True):\n"
        "    print(subprocess.Popen(['sleep', '1000'], start_new_session=own).pid)"
    )
    bench.write("a/b", "# A", code)
    assert bench.build(formats=("ipynb",)).code == 0
    for number in bench.executed("a/b")["cells"][1]["outputs"][0]["text"].split():
        assert not leftovers._command(int(number)).startswith("sleep")
    assert bench.said.count("left running, and ended: sleep 1000") == 2


def test_a_kernel_without_children_ends_nothing(tmp_path):
    assert leftovers.end(tmp_path / "nothing", None) == []


def test_what_a_killed_process_left_is_removed_by_the_next(short, monkeypatch):
    tmp_path = short
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    code = "from notebook_reports.project import runtime\nimport os, signal\nruntime.make('fonts-')\n"
    code += "os.kill(os.getpid(), signal.SIGKILL)"
    subprocess.run([sys.executable, "-c", code], env={**os.environ, "TMPDIR": str(tmp_path)}, check=False)
    (dead,) = tmp_path.iterdir()
    assert dead.stat().st_mode & 0o777 == 0o700
    mine = runtime.folder()
    assert mine != dead and not dead.exists()
    runtime.sweep(tmp_path)
    assert mine.exists()
    runtime.tidy()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_another_is_not_swept(tmp_path):
    for name, mode in (("lb-open", 0o777), ("lb-empty", 0o700)):
        (tmp_path / name).mkdir()
        (tmp_path / name).chmod(mode)
    runtime.sweep(tmp_path)
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_of_the_warm_up_is_obeyed_at_once(bench, short, number):
    """Warming up takes for ever here; nothing of it computes on and nothing is left."""
    temporary = short
    fifo = bench.root / "warming"
    os.mkfifo(fifo)
    hold = f"import os, threading\nopen({str(fifo)!r}, 'w').write(str(os.getpid()))\nthreading.Event().wait()\n"
    bench.module("sympy/__init__.py", hold)
    for name in ("one", "two"):
        bench.write(f"a/{name}", "# A", "1")
    env = {k: v for k, v in os.environ.items() if k != warm.PLAIN}
    process = start(bench, "-j2", env={**env, "TMPDIR": str(temporary)})
    warming = int(fifo.read_text())
    process.send_signal(number)
    said, _ = process.communicate(timeout=20)
    assert process.returncode == 130 and "interrupted" in said and "Traceback" not in said
    assert not leftovers._command(warming).startswith(sys.executable)
    assert list(temporary.iterdir()) == []


def test_a_kernel_that_died_with_its_parent_before_it_was_ready_is_started_again(bench, monkeypatch):
    monkeypatch.delenv(warm.PLAIN)
    fork = warm.Warm.fork

    def orphaned(self, *order):
        kernel = fork(self, *order)
        if kernel is not None:
            self.kill()
            self._process.wait()
        return kernel

    monkeypatch.setattr(warm.Warm, "fork", orphaned)
    for name in ("one", "two"):
        bench.write(f"a/{name}", "# A", "1")
    assert bench.build(formats=("ipynb",), jobs=2).code == 0, bench.said


def test_notebooks_of_a_warm_process_that_was_killed_run_in_fresh_kernels(bench, monkeypatch):
    monkeypatch.delenv(warm.PLAIN)
    fifo = bench.root / "kernel"
    kill = (
        "import os, signal, pathlib, time\nfirst = not os.path.exists('ran')\nopen('ran', 'a').write('x')\n"
        "if first:\n    os.kill(os.getppid(), signal.SIGKILL)\n    time.sleep(30)\n'done'"
    )
    bench.write("a/kills", "# A", kill)
    bench.write("b/other", "# B", "2")
    outcome = bench.build(formats=("ipynb",), jobs=2)
    assert outcome.code == 0, bench.said
    assert bench.executed("a/kills")["cells"][1]["outputs"][0]["data"]["text/plain"] == "'done'"
    assert (bench.root / "notebooks/a/ran").read_text() == "xx" and not fifo.exists()


def test_the_umask_is_respected(tmp_path):
    for mask, mode in (("022", 0o644), ("077", 0o600), ("002", 0o664)):
        path = tmp_path / mask
        code = "from pathlib import Path\nfrom notebook_reports.project import atomic\n"
        code += f"atomic.write(Path({str(path)!r}), b'')"
        subprocess.run(["sh", "-c", f'umask {mask}; exec "$@"', "-", sys.executable, "-c", code], check=True)
        assert path.stat().st_mode & 0o777 == mode


def test_in_a_project_that_cannot_be_written_the_advice_given_works(bench, monkeypatch):
    bench.write("a/b", "# A", "1")
    writable = atomic.writable

    def refuse(folder):
        if Path(folder).is_relative_to(bench.root):
            raise EnvironmentProblem(f"cannot write {folder}: Read-only file system; choose another folder with -o DIR")
        writable(folder)

    monkeypatch.setattr(atomic, "writable", refuse)
    with pytest.raises(EnvironmentProblem, match="choose another folder with -o DIR"):
        bench.build(formats=("ipynb",))
    out = bench.root.parent / "elsewhere"
    assert bench.build(formats=("ipynb",), output=out).code == 0 and (out / "a/b.ipynb").exists()
    assert not (bench.root / ".cache").exists() and not (bench.root / "reports").exists()


def test_doctor_writes_nothing(bench):
    bench.write("a/b", "# A", "1")
    before = sorted(bench.root.rglob("*"))
    answers = {name: verdict for verdict, name, _ in examine(bench.project)}
    assert answers["kernel"] == "ok" and answers["folders"] == "ok"
    assert sorted(bench.root.rglob("*")) == before


def test_without_a_home_and_without_a_name_in_the_list_of_users(bench, short):
    """The user of a container: a number, no HOME, no entry in /etc/passwd."""
    (short / "sitecustomize.py").write_text(
        "import pwd\n\ndef unknown(*_):\n    raise KeyError\npwd.getpwuid = unknown\n"
    )
    bench.write("a/b", "# A", "1 + 1")
    env = {k: v for k, v in os.environ.items() if k not in ("HOME", "XDG_CACHE_HOME")}
    process = start(bench, env={**env, "PYTHONPATH": str(short)})
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert json.loads((bench.root / "reports/a/b.ipynb").read_text())["cells"][1]["outputs"]


def test_a_kernel_gets_a_home_where_there_is_none(bench, monkeypatch):
    from notebook_reports.run import surroundings

    monkeypatch.setattr(surroundings, "home", lambda: None)
    assert environment(bench.project)["HOME"] == str(bench.project.cache)
