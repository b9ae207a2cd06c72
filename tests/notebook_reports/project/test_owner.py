"""Another user's folder runs nothing: not its notebooks, not its modules, not what lies in a folder made beforehand."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from loopbook.cli import main
from notebook_reports.project import home
from notebook_reports.project.project import UsageError, find_project, no_project, project_at
from notebook_reports.run.surroundings import environment

pytestmark = pytest.mark.builds


@pytest.fixture
def stranger(monkeypatch):
    """From now on the files of these tests belong to somebody else."""
    monkeypatch.delenv("SUDO_UID", raising=False)
    monkeypatch.setattr(home, "user", lambda: os.geteuid() + 1)


def test_a_project_of_another_user_is_used_where_it_is_named(bench, stranger, monkeypatch):
    bench.write("a/b", "# A", "open('ran', 'w')")
    monkeypatch.chdir(bench.root)
    with pytest.raises(UsageError, match=r"belongs to another user.*loopbook --root "):
        find_project()
    result = CliRunner().invoke(main, ["build"])
    assert result.exit_code == 2 and "belongs to another user" in result.output
    assert not (bench.root / "notebooks/a/ran").exists()
    assert project_at(bench.root).src is None and CliRunner().invoke(main, ["--root", ".", "list"]).exit_code == 0


def test_one_who_became_root_by_sudo_owns_what_was_his(bench, monkeypatch):
    monkeypatch.setattr(home, "user", lambda: 0)
    monkeypatch.setenv("SUDO_UID", str(bench.root.stat().st_uid))
    assert home.owns(bench.root)


def test_make_names_the_project():
    lines = (Path(__file__).parents[3] / "Makefile").read_text(encoding="utf-8").splitlines()
    calls = [line for line in lines if "$(BIN)/loopbook" in line]
    assert len(calls) >= 3 and all("$(BIN)/loopbook --root . " in line for line in calls)


def test_make_passes_no_text_of_its_caller_to_a_shell_as_a_command():
    makefile = (Path(__file__).parents[3] / "Makefile").read_text(encoding="utf-8")
    assert "DATA" not in makefile and "\ndesign:" not in makefile


def test_a_private_cache_is_private(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = home.private_cache()
    assert folder == tmp_path / "loopbook" and folder.stat().st_mode & 0o777 == 0o700
    folder.chmod(0o777)
    other = home.private_cache()
    assert other != folder and other.stat().st_mode & 0o777 == 0o700


def test_a_cache_made_beforehand_by_another_user_is_not_used(tmp_path, monkeypatch, stranger):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (tmp_path / "loopbook" / "ipython" / "profile_default" / "startup").mkdir(parents=True)
    assert home.private_cache() != tmp_path / "loopbook"
    (tmp_path / "other").mkdir()
    (tmp_path / "loopbook").rename(tmp_path / "x")
    (tmp_path / "loopbook").symlink_to(tmp_path / "other")
    assert home.private_cache() != tmp_path / "loopbook"


def test_no_start_up_of_a_profile_in_the_cache_is_run(bench):
    for name in ("ipython", "ipythondir"):
        startup = bench.root / ".cache" / name / "profile_default" / "startup"
        startup.mkdir(parents=True)
        (startup / "00.py").write_text("planted = 1")
    bench.write("a/b", "# A", "'planted' in globals()")
    assert bench.build(formats=("ipynb",)).code == 0
    assert bench.executed("a/b")["cells"][1]["outputs"][0]["data"]["text/plain"] == "False"


def test_a_folder_that_is_no_project_is_not_imported_from(tmp_path):
    (tmp_path / "src").mkdir()
    assert str(tmp_path / "src") not in environment(no_project(tmp_path))["PYTHONPATH"]


PLANTED = "import pathlib\npathlib.Path({!r}).write_text('ran')\n"


def test_a_design_runs_nothing_of_the_folder_it_is_called_in(tmp_path):
    """Modules of every name that is imported on the way, a notebook, a package, and data called like a module."""
    ran = tmp_path / "ran"
    folder = tmp_path / "folder"
    text = PLANTED.format(str(ran))
    names = ("sympy", "json", "socket", "numpy", "ipykernel_launcher", "notebook_reports/__init__", "loopbook/__init__")
    for name in (*names, "src/sympy", "src/loopbook/__init__", "sitecustomize", "matplotlib/__init__"):
        path = folder / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    notebook = folder / "notebooks" / "own_process" / "design.ipynb"
    notebook.parent.mkdir(parents=True)
    notebook.write_text('{"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}')
    (folder / "scipy.toml").write_text("[process]\ngain = 0.0\ntime_constants = [2.0]\ndelay = 0.5\n")
    command = [str(Path(sys.executable).parent / "loopbook"), "design", "scipy.toml", "--format", "json"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1 and "gain = 0.0: a finite number" in done.stdout, done.stdout + done.stderr
    assert not ran.exists()
