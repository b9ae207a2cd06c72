"""`make quick` leaves out what builds, and fails where a test builds without saying so."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SAMPLE = """
import subprocess, sys
import pytest, typst

def test_plain():
    assert subprocess.run([sys.executable, "-c", ""]).returncode == 0

@pytest.mark.builds
def test_marked():
    assert False, "left out"

def test_shared_build(outcome):
    assert False, "left out"

def test_page():
    typst.compile(b"= A page")

def test_compiler():
    subprocess.run(["/usr/bin/cc", "-c", "x.c"])

def test_kernel():
    subprocess.run([sys.executable, "-m", "ipykernel_launcher"])
"""


@pytest.mark.long
def test_a_test_that_builds_must_say_so(tmp_path):
    (tmp_path / "test_sample.py").write_text(SAMPLE, encoding="utf-8")
    (tmp_path / "test_whole.py").write_text("import pytest\npytestmark = pytest.mark.builds\n1 / 0\n", encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests"), "PYTEST_ADDOPTS": ""}
    command = [sys.executable, "-m", "pytest", "--quick", "-p", "conftest", "-p", "no:cacheprovider", "-p", "no:xdist"]
    done = subprocess.run([*command, "-rf", tmp_path], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert "3 failed, 1 passed, 2 deselected" in done.stdout, done.stdout + done.stderr
    for started in ("typst.compile", "/usr/bin/cc -c x.c", "-m ipykernel_launcher"):
        assert f"{started}: mark it with @pytest.mark.builds" in done.stdout, done.stdout
