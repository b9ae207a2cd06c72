"""An installation with uv or pip that says in one line why it cannot be made, and knows when it is not its own."""

import http.server
import os
import shutil
import subprocess
import sys
import threading
import zipfile
from hashlib import sha256
from pathlib import Path
from types import SimpleNamespace

import bootstrap
import doctor
import pip_settings
import pytest

ROOT = Path(__file__).parents[2]
UV = Path(sys.prefix) / "bin" / "uv"


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
        (
            "ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE.\n"
            "    anyio==4.16.0 from https://x/anyio-4.16.0-py3-none-any.whl (from -r environment.txt (line 169)):\n"
            "        Expected sha256 0000",
            "package (anyio==4.16.0) does not match the hash in environment.txt",
        ),
        # uv, each provoked: a changed hash, a full disk, no network, an authority that nobody knows
        (
            "error: Failed to download `anyio==4.16.0`\n  cause: Hash mismatch for `anyio==4.16.0`\n\n"
            "         Expected:\n           sha256:0000\n\n         Computed:\n           sha256:c66a",
            "package (anyio==4.16.0) does not match the hash in environment.txt",
        ),
        (
            "error: Failed to install: jedi-0.20.1-py2.py3-none-any.whl (jedi==0.20.1)\n"
            "  cause: failed to copy file from a to b: No space left on device (os error 28)",
            "disk is full",
        ),
        ("error: Request failed after 3 retries in 4.5s\n  cause: Failed to fetch: `x`\n  cause: dns error", "network"),
    ],
)
def test_a_failed_installation_gives_one_readable_reason(tmp_path, monkeypatch, log, message):
    monkeypatch.setattr(bootstrap.shutil, "disk_usage", lambda folder: SimpleNamespace(free=1e9))
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


def test_a_disk_so_full_that_nobody_can_say_so(tmp_path, monkeypatch):
    monkeypatch.setattr(bootstrap.shutil, "disk_usage", lambda folder: SimpleNamespace(free=0))
    log = tmp_path / "install.log"
    log.write_text("Error: Command ensurepip returned non-zero exit status 1.", encoding="utf-8")
    assert "disk is full" in bootstrap.reason(str(log))


def test_a_python_without_venv_is_told_what_to_install(tmp_path, monkeypatch, capsys):
    python = program(tmp_path / "python", "exit 1")
    monkeypatch.setattr(bootstrap, "interpreter", lambda: python)
    with pytest.raises(SystemExit) as stopped:
        bootstrap.make(str(tmp_path / "venv"))
    assert stopped.value.code == 3 and "apt install python3-venv" in capsys.readouterr().err


def program(path: Path, text: str) -> str:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


def installer(folder: Path, pip: str, uv: str = "") -> bootstrap.Installer:
    """An environment whose python and uv write down what they are told, and then do as the test says."""
    program(folder / "bin" / "python", f'echo "pip $*" >> {folder}/calls\n{pip}')
    if uv:
        program(folder / "bin" / "uv", f'echo "uv $*" >> {folder}/calls\n{uv}')
    return bootstrap.Installer(str(folder), str(folder / "log"))


def installs(folder: Path) -> list[tuple[str, str]]:
    """(installer, lock) of each installation that was tried."""
    calls = (folder / "calls").read_text(encoding="utf-8").splitlines()
    return [(c.split()[0], c.split()[-1]) for c in calls if " install " in c]


LOCKED = ("environment.txt", "--require-hashes", "-r", "environment.txt")


def test_uv_installs_where_it_runs(tmp_path):
    installer(tmp_path, "exit 0", "exit 0").install(*LOCKED)
    assert installs(tmp_path) == [("uv", "environment.txt")]


@pytest.mark.parametrize("uv", ["exit 1", "kill -ILL $$", "echo 'error: invalid peer certificate'; exit 2"])
def test_pip_installs_the_same_where_uv_does_not(tmp_path, capsys, uv):
    made = installer(tmp_path, "exit 0", uv)
    made.install(*LOCKED)
    assert installs(tmp_path)[-1] == ("pip", "environment.txt")
    last = (tmp_path / "calls").read_text(encoding="utf-8").splitlines()[-1]
    assert "--require-hashes" in last and "--no-compile" in last
    assert "pip does" in capsys.readouterr().out


def test_a_uv_of_another_machine_is_none(tmp_path):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "uv").write_bytes(b"\x7fELF")
    (tmp_path / "bin" / "uv").chmod(0o755)
    installer(tmp_path, "exit 0").install(*LOCKED)
    assert installs(tmp_path) == [("pip", "environment.txt")]


def test_a_platform_without_a_wheel_of_uv_gets_pip(tmp_path):
    absent = 'case "$*" in *tools/uv.txt*) echo "ERROR: No matching distribution found for uv==1"; exit 1;; esac'
    installer(tmp_path, absent).install(*LOCKED)
    assert installs(tmp_path) == [("pip", "tools/uv.txt"), ("pip", "environment.txt")]


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ("WARNING: Retrying after connection broken by NewConnectionError", "tools/uv.txt could not be downloaded"),
        ("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES", "does not match the hash in tools/uv.txt"),
        ("ERROR: [Errno 28] No space left on device", "the disk is full"),
    ],
)
def test_what_pip_would_meet_as_well_stops_at_once(tmp_path, capsys, said, message):
    with pytest.raises(SystemExit) as stopped:
        installer(tmp_path, f'case "$*" in *tools/uv.txt*) echo "{said}"; exit 1;; esac')
    assert stopped.value.code == 3 and message in capsys.readouterr().err
    assert installs(tmp_path) == [("pip", "tools/uv.txt")]


def test_a_package_that_was_changed_is_not_tried_with_pip(tmp_path, capsys):
    made = installer(
        tmp_path, "exit 0", 'case "$*" in *install*) echo "cause: Hash mismatch for `a==1`"; exit 1;; esac'
    )
    with pytest.raises(SystemExit):
        made.install(*LOCKED)
    assert "does not match the hash in environment.txt" in capsys.readouterr().err
    assert installs(tmp_path) == [("uv", "environment.txt")]


@pytest.mark.parametrize(
    ("listing", "expected"),
    [
        ("", {}),
        ("global.index-url='a'", {"index-url": ["a"]}),
        ("install.index-url='b'\nglobal.index-url='a'", {"index-url": ["b"]}),
        (":env:.index-url='c'\nglobal.index-url='a'\ninstall.index-url='b'", {"index-url": ["c"]}),
        ("global.extra-index-url='a b\\nc'", {"extra-index-url": ["a", "b", "c"]}),
        ('global.index-url="it\'s"', {"index-url": ["it's"]}),
        ("download.index-url='a'\nglobal.proxy=''", {}),
    ],
)
def test_pips_configuration_is_read_in_its_order(listing, expected):
    assert pip_settings.pip_settings(listing) == expected


def test_what_is_set_for_uv_stays(monkeypatch):
    monkeypatch.setenv("PIP_INDEX_URL", "http:" + "//127.0.0.1/pip")
    monkeypatch.setenv("PIP_EXTRA_INDEX_URL", "a b")
    monkeypatch.delenv("UV_DEFAULT_INDEX", raising=False)
    monkeypatch.setenv("UV_INDEX", "mine")
    env = pip_settings.uv_environment(sys.executable)
    assert env["UV_DEFAULT_INDEX"] == "http:" + "//127.0.0.1/pip" and env["UV_INDEX"] == "mine"


@pytest.mark.skipif(not UV.exists(), reason="this environment was made by pip, uv does not run here")
@pytest.mark.long
def test_uv_asks_the_index_that_pip_is_configured_for(tmp_path, monkeypatch):
    wheel = tmp_path / "simple" / "tiny" / "tiny-1.0-py3-none-any.whl"
    wheel.parent.mkdir(parents=True)
    with zipfile.ZipFile(wheel, "w") as file:
        file.writestr("tiny.py", "")
        file.writestr("tiny-1.0.dist-info/METADATA", "Metadata-Version: 2.1\nName: tiny\nVersion: 1.0\n")
        file.writestr("tiny-1.0.dist-info/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        file.writestr("tiny-1.0.dist-info/RECORD", "")
    (wheel.parent / "index.html").write_text(f'<a href="{wheel.name}">{wheel.name}</a>')
    lock = tmp_path / "lock.txt"
    lock.write_text(f"tiny==1.0 --hash=sha256:{sha256(wheel.read_bytes()).hexdigest()}\n")

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def __init__(self, *a):
            super().__init__(*a, directory=str(tmp_path))

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Quiet)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    for name in [n for n in os.environ if n.startswith(("UV_", "PIP_"))]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("PIP_CONFIG_FILE", str(tmp_path / "pip.conf"))
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    monkeypatch.setenv("UV_CACHE_DIR", str(tmp_path / "cache"))
    index = "http:" + f"//127.0.0.1:{server.server_port}/simple"
    (tmp_path / "pip.conf").write_text(f"[global]\nindex-url = {index}\n")
    env = pip_settings.uv_environment(sys.executable)
    command = [str(UV), "pip", "install", "--python", sys.executable, "--target", str(tmp_path / "out")]
    done = subprocess.run([*command, "--require-hashes", "-r", str(lock)], env=env, capture_output=True, text=True)
    server.shutdown()
    server.server_close()
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "tiny.py").exists()


def planned(folder: Path, *words: str) -> str:
    """What make would run, from a folder with the project's Makefile."""
    command = ["make", "--no-print-directory", "-n", "check", *words]
    clean = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MAKELEVEL", "PYTHON")}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=clean).stdout


def project(folder: Path) -> Path:
    """A folder with the project's Makefile and what looks like its environment."""
    for name in ("Makefile", "environment.txt", "pyproject.toml", "tools"):
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        copy(ROOT / name, folder / name)
    (folder / ".venv" / "bin").mkdir(parents=True)
    (folder / ".venv" / "bin" / "python").symlink_to(sys.executable)
    (folder / ".venv" / "asked-for").write_text("python3\n")
    (folder / ".venv" / "ready").write_text(f"3.11\n{folder.resolve()}\n{(folder / '.venv').resolve()}\n")
    return folder


def test_an_environment_that_belongs_elsewhere_is_made_again(tmp_path, monkeypatch, capsys):
    here = project(tmp_path / "here")
    assert "bootstrap" not in planned(here)
    assert "bootstrap" not in planned(here, "PYTHON=python3")
    assert "bootstrap" in planned(here, "PYTHON=/another/python3")
    shutil.copytree(here, tmp_path / "copied", symlinks=True)
    assert "bootstrap.py .venv" in planned(tmp_path / "copied")
    monkeypatch.chdir(tmp_path / "copied")
    assert doctor.main(".venv") == 3
    assert f".venv belongs to {here.resolve()}: run make" in capsys.readouterr().out
    here.rename(tmp_path / "moved")
    assert "bootstrap.py .venv" in planned(tmp_path / "moved")


def test_an_environment_whose_python_went_is_made_again(tmp_path, monkeypatch, capsys):
    here = project(tmp_path)
    (here / ".venv/bin/python").unlink()
    (here / ".venv/bin/python").symlink_to("/no/such/python")
    assert "bootstrap.py .venv" in planned(here)
    monkeypatch.chdir(here)
    assert doctor.main(".venv") == 3
    assert "does not run any more" in capsys.readouterr().out


def test_the_doctor_comes_also_where_nothing_works(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(project(tmp_path))
    program(
        tmp_path / "broken" / "bin" / "python",
        '[ "$1" = -c ] && echo 3 11 || { echo "ImportError: click" >&2; exit 1; }',
    )
    (tmp_path / "broken/ready").write_text(f"3.11\n{tmp_path.resolve()}\n{(tmp_path / 'broken').resolve()}\n")
    for folder, finding in (("none", "does not exist: run make"), ("broken", "does not start (ImportError: click)")):
        assert doctor.main(folder) == 3
        assert finding in capsys.readouterr().out
    (tmp_path / "broken/ready").unlink()
    assert doctor.main("broken") == 3 and "is not complete" in capsys.readouterr().out


@pytest.mark.parametrize("target", ["doctor", "check"])
def test_no_python_at_all_is_one_line(tmp_path, target):
    command = ["make", "--no-print-directory", f"VENV={tmp_path / 'none'}", "PYTHON=no-such-python", target]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode != 0
    assert "loopbook needs Python 3.11 or newer" in done.stdout + done.stderr
