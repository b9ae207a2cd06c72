"""What a kernel notes of its reading: files read, also outside the project, and folders listed, not what it wrote."""

import json
import os
import subprocess
import sys
from pathlib import Path

from notebook_reports.run import kernel_side

PROGRAM = """
import json, os, sys
from types import SimpleNamespace
from notebook_reports.run import kernel_side, watching
events = SimpleNamespace(register=lambda event, function: None)
shell = SimpleNamespace(
    system=lambda command: None, user_ns={"_exit_code": 3}, var_expand=lambda text, depth: text, events=events
)
kernel_side.load_ipython_extension(shell)
open("data.csv").read()
os.listdir("folder")
open("made.txt", "w").write("x")
open("made.txt").read()
open(sys.argv[1]).read()
said = watching.report()
for name in ("system", "getoutput"):
    try:
        getattr(shell, name)("false")
    except Exception as error:
        said[name] = f"{type(error).__name__} {error.returncode}"
print(json.dumps(said))
"""


def test_what_is_read_is_noted_and_a_failing_shell_command_fails(tmp_path):
    root, other = tmp_path / "project", tmp_path / "other.txt"
    (root / "folder").mkdir(parents=True)
    (root / "data.csv").write_text("1")
    other.write_text("2")
    environment = {**os.environ, "LOOPBOOK_ROOT": str(root), "PYTHONPATH": str(Path(kernel_side.__file__).parents[2])}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(other)],
        cwd=root,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert said["read"] == {
        str(root / "data.csv"): {"kinds": ["file"], "at": 0},
        str(root / "folder"): {"kinds": ["folder"], "at": 0},
        str(other): {"kinds": ["file"], "at": 0},
    }
    assert any(path.endswith("notebook_reports/run/kernel_side.py") for path in said["modules"])
    assert said["system"] == "CalledProcessError 3" and said["getoutput"] == "CalledProcessError 1"
