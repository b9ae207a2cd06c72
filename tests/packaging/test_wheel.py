"""The wheel, unpacked outside the repository, with nothing but what the extra in use declares."""

import importlib.metadata as metadata
import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from email import message_from_bytes
from pathlib import Path

import numpy as np
import pytest
from packaging.requirements import Requirement

from loopbook.process.transfer_function import Process

pytestmark = pytest.mark.builds

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
SOURCES = ("src", "pyproject.toml", "setup.py", "MANIFEST.in", "README.md", "LICENSE", "LICENSE-CONTENT")
NOTEBOOK = Path("notebooks/own_process/design.ipynb")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Built from a copy of the sources, so that nothing of an earlier build gets in."""
    folder = tmp_path_factory.mktemp("wheel")
    copy = folder / "sources"
    (copy / NOTEBOOK.parent).mkdir(parents=True)
    shutil.copy(ROOT / NOTEBOOK, copy / NOTEBOOK)
    for name in SOURCES:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
        else:
            shutil.copy(ROOT / name, copy / name)
    command = [sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "-q"]
    done = subprocess.run([*command, "-w", folder, copy], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (made,) = folder.glob("*.whl")
    return made


def declared(wheel: Path, extra: str) -> set[str]:
    """The distributions that the wheel asks for with an extra, and those that these ask for, by normal names."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [n for n in archive.namelist() if n.endswith(".dist-info/METADATA")]
        message = message_from_bytes(archive.read(name))
    todo = [(Requirement(text), extra) for text in message.get_all("Requires-Dist")]
    found: set[tuple[str, str]] = set()
    while todo:
        requirement, asked = todo.pop()
        if requirement.marker and not requirement.marker.evaluate({"extra": asked}):
            continue
        name = normal(requirement.name)
        for inner in ("", *requirement.extras):
            if (name, inner) in found:
                continue
            found.add((name, inner))
            try:
                todo += [(Requirement(text), inner) for text in metadata.requires(name) or ()]
            except metadata.PackageNotFoundError:
                continue
    return {name for name, _ in found}


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


@pytest.fixture
def unpacked(wheel, tmp_path):
    """Unpacks the wheel for an extra; gives a function that runs a Python with it, elsewhere than in the repository."""

    def unpack(extra: str):
        place = tmp_path / "unpacked"
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(place)
        allowed = declared(wheel, extra) | {"loopbook"}
        belongs = metadata.packages_distributions()
        refused = [top for top, owners in belongs.items() if not {normal(o) for o in owners} & allowed]
        (place / "sitecustomize.py").write_bytes((HERE / "refuse.py").read_bytes())
        (place / "refused.json").write_text(json.dumps(refused), encoding="utf-8")
        work = tmp_path / "work"
        work.mkdir()
        kept = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "COV", "PYTEST"))}
        env = {**kept, "PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": str(tmp_path)}

        def run(*words: str) -> subprocess.CompletedProcess:
            command = [sys.executable, *words]
            return subprocess.run(command, cwd=work, env=env, capture_output=True, text=True, timeout=300)

        return work, run, set(refused)

    return unpack


def record(folder: Path) -> Path:
    t = np.arange(0, 120, 0.5)
    y = Process([2], [40, 14, 1], 3).step(t - 10) + 0.01 * np.random.default_rng(0).standard_normal(len(t))
    rows = "".join(f"{a},{float(a >= 10)},{b:.4f}\n" for a, b in zip(t, y, strict=True))
    path = folder / "record.csv"
    path.write_text("time [s],u,y\n" + rows, encoding="utf-8")
    return path


def test_the_wheel_carries_what_it_needs_byte_for_byte(wheel):
    with zipfile.ZipFile(wheel) as archive:
        held = {name: archive.read(name) for name in archive.namelist()}
    assert held["loopbook/design/design.ipynb"] == (ROOT / NOTEBOOK).read_bytes()
    files = [p for p in (ROOT / "src").rglob("*") if p.is_file() and ".egg-info" not in p.parent.name]
    data = [p for p in files if p.suffix not in (".py", ".pyc")]
    assert len(data) > 40 and {p.suffix for p in data} >= {".toml", ".typ", ".j2", ".css", ".pyi"}
    for path in data:
        name = path.relative_to(ROOT / "src").as_posix()
        assert held.get(name) == path.read_bytes(), f"{name} is not in the wheel as it stands in the sources"
    modules = {p.relative_to(ROOT / "src").as_posix() for p in (ROOT / "src").rglob("*.py")}
    assert modules == {name for name in held if name.endswith(".py")}


def test_the_core_is_four_packages(wheel):
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [n for n in archive.namelist() if n.endswith("METADATA")]
        text = archive.read(name).decode()
    needs = re.findall(r"^Requires-Dist: ([^\s;]+)$", text, re.M)
    assert sorted(needs) == ["matplotlib", "numpy", "scipy", "sympy"]
    extras = set(re.findall(r"^Provides-Extra: (\S+)$", text, re.M))
    assert {"reports", "control", "course", "cluster", "dev"} <= extras


def test_the_core_does_its_work_with_its_four_packages(unpacked):
    work, run, refused = unpacked("")
    assert refused >= {"pandas", "click", "papermill", "nbconvert", "IPython", "pytest"} and "numpy" not in refused
    record(work)
    done = run("-c", CORE)
    assert done.returncode == 0, done.stderr
    where, *numbers = done.stdout.splitlines()
    assert Path(where).is_relative_to(work.parent / "unpacked")
    assert numbers == ["simc-pi", "True", "this needs the package control: pip install 'loopbook[control]'"]


CORE = """
import loopbook as lb
print(lb.__file__)
for name in lb.__all__:
    getattr(lb, name)
found = lb.identify(lb.read_csv("record.csv"))
tuning = lb.tune(found, "simc", "PI")
print(tuning.rule)
loop = lb.Loop(found.process, tuning)
loop.plot(), lb.bode(loop), lb.nyquist(loop), lb.margins(loop), lb.step_info(loop)
placed = lb.place(lb.sample(found.process, 0.5), 0.8)
print(lb.SampledLoop(found.process, placed.regulator).is_stable)
try:
    lb.to_control(lb.tf(1, [1, 1]))
except ModuleNotFoundError as error:
    print(error)
"""


def test_the_command_says_in_one_line_what_to_install(unpacked):
    _, run, _ = unpacked("")
    done = run("-m", "loopbook", "design", "record.csv")
    assert done.returncode == 3 and not done.stdout
    assert done.stderr == "loopbook: the command needs click: pip install 'loopbook[reports]'\n"


def test_a_design_is_made_with_the_reports_alone(unpacked):
    """From a record to the PDF and the numbers; the kernel finds the same hook and refuses as well."""
    work, run, refused = unpacked("reports")
    assert refused >= {"control", "pytest", "hypothesis"} and not refused & {"pandas", "click", "papermill"}
    record(work)
    done = run("-m", "loopbook", "design", "record.csv", "--format", "pdf,json", "-j", "1")
    assert done.returncode == 0, done.stdout + done.stderr
    assert (work / "record-design.pdf").read_bytes().startswith(b"%PDF")
    found = json.loads((work / "record-design.json").read_text(encoding="utf-8"))
    assert found["process"]["gain"] == pytest.approx(2, rel=0.02) and found["settings"]
    hook = work.parent / "unpacked" / "refused.json"
    hook.write_text(json.dumps([*refused, "scipy"]), encoding="utf-8")
    done = run("-m", "loopbook", "design", "record.csv", "--format", "json", "-j", "1")
    assert done.returncode == 1 and "scipy is not declared by the extra in use" in done.stdout + done.stderr


def test_nbconvert_finds_the_exporter_of_the_wheel(unpacked):
    work, run, _ = unpacked("reports")
    shutil.copy(HERE.parent.parent / "notebooks" / "double_tank" / "01_model.ipynb", work / "any.ipynb")
    done = run("-m", "nbconvert", "--to", "loopbook_pdf", "any.ipynb")
    assert done.returncode == 0, done.stderr
    assert (work / "any.pdf").read_bytes().startswith(b"%PDF")
