"""The locked environment, the two commands, and an installation that says in one line why it cannot be made."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LOCK = (ROOT / "environment.txt").read_text(encoding="utf-8")

spec = importlib.util.spec_from_file_location("bootstrap", ROOT / "tools" / "bootstrap.py")
bootstrap = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bootstrap)


def test_every_package_is_pinned_with_hashes():
    entries = re.split(r"\n(?=\S)", LOCK.strip())
    assert len(entries) > 100
    for entry in entries:
        assert re.match(r"[A-Za-z0-9._-]+(\[[^]]*\])?==\S+", entry), entry.splitlines()[0]
        assert "--hash=sha256:" in entry, entry.splitlines()[0]


def test_every_direct_dependency_is_locked():
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [*project["dependencies"], *project["optional-dependencies"]["dev"]]
    locked = set(re.findall(r"^([A-Za-z0-9._-]+)==", LOCK, re.M))
    assert {re.match(r"[\w-]+", name).group() for name in wanted} <= locked


def test_no_package_index_is_named():
    assert (ROOT / "requirements.txt").read_text(encoding="utf-8").strip() == "-r environment.txt"
    for name in ("environment.txt", "pyproject.toml", "Makefile", "tools/bootstrap.py"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert not re.search(r"index-url|find-links|://", text), name


def test_help_lists_every_target_with_a_line():
    shown = subprocess.run(["make", "help"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    listed = set(re.findall(r"^  make (\w+)", shown, re.M))
    assert {"all", "test", "doctor", "clean", "notebooks", "lock", "bench", "verify", "check"} <= listed


@pytest.mark.parametrize(
    ("log", "message"),
    [
        (
            "ERROR: Could not find a version\nWARNING: NewConnectionError: Failed to establish a new connection",
            "network",
        ),
        ("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES\nhashes do not match", "does not match the hash"),
        ("OSError: [Errno 28] No space left on device", "disk is full"),
        ("ERROR: No matching distribution found for anyio==4.16.0", "is there a network"),
        ("ERROR: Failed building wheel for x", "ERROR: Failed building wheel for x"),
        ("", "no output"),
    ],
)
def test_a_failed_installation_gives_one_readable_reason(tmp_path, log, message):
    file = tmp_path / "install.log"
    file.write_text(log, encoding="utf-8")
    reason = bootstrap.reason(str(file))
    assert message in reason and "\n" not in reason


def test_a_python_that_is_too_old_is_named(monkeypatch, capsys):
    monkeypatch.setattr(bootstrap.sys, "version_info", (3, 9, 2))
    monkeypatch.setattr(bootstrap.shutil, "which", lambda name: None)
    with pytest.raises(SystemExit) as stopped:
        bootstrap.interpreter()
    assert stopped.value.code == 3
    assert "needs Python 3.11 or newer" in capsys.readouterr().err


def test_a_failing_step_stops_and_names_its_log(tmp_path, capsys):
    log = tmp_path / "install.log"
    with pytest.raises(SystemExit) as stopped:
        bootstrap.run("trying", [sys.executable, "-c", "raise SystemExit('error: broken')"], str(log))
    assert stopped.value.code == 3
    assert f"trying failed: error: broken. The whole log: {log}" in capsys.readouterr().err


def test_no_python_at_all_is_one_line(tmp_path):
    done = subprocess.run(
        [
            "make",
            "--no-print-directory",
            "-C",
            str(ROOT),
            "VENV=" + str(tmp_path / "none"),
            "PYTHON=no-such-python",
            "doctor",
        ],
        capture_output=True,
        text=True,
    )
    assert done.returncode != 0
    assert "loopbook needs Python 3.11 or newer" in done.stdout + done.stderr


def test_the_readme_example_runs(capsys):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", readme, re.S)
    exec(compile(example, "README.md", "exec"), {})
    Ms, iae = map(float, capsys.readouterr().out.split())
    assert 1.3 < Ms < 1.6 and iae > 0
