"""The walls stand wherever the project lies and whoever grades; where they cannot, the run fails, no student."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from loopbook.course.grade import grading, one
from loopbook.course.grade.grading import grade
from loopbook.course.grade.one import GradeJob, grade_one
from loopbook.course.grade.submissions import Submission
from loopbook.course.release.manifest import Manifest, OfSheet
from loopbook.course.sandbox import jail as jails
from loopbook.course.sandbox.jail import JailFailed
from loopbook.course.sandbox.walls import HIDDEN, UNWRITABLE, WALLS, enterable

pytestmark = [
    pytest.mark.builds,
    pytest.mark.long,
    pytest.mark.skipif(sys.platform != "linux", reason="the walls are Linux's"),
]
SOURCE = Path(jails.__file__).parents[3]
NOBODY = 65534

JUDGE = """
import json, sys
from pathlib import Path
from loopbook.course.sandbox.jail import Jail

jail = Jail([Path(p) for p in sys.argv[1:]])
running = jail.start()
lines = ["import loopbook as lb, scipy.stats, os\\npi = lb.tune(lb.StepData(2.0, 40.0, 8.0), 'simc-pi')"]
lines.append("answers = {'K': pi.K, 'place': lb.__file__}")
for name in sys.argv[1:]:
    lines.append(f"answers[{name!r}] = os.listdir({name!r})")
lines.append("open(os.path.dirname(lb.__file__) + '/planted.py', 'w')")
found = running.answers(lines)
running.close()
jail.close()
print(json.dumps({"answers": found.answers, "failed": found.failed, "walls": found.walls}))
"""


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project with an environment of its own, in a folder with blanks that only its owner may enter."""
    folder = tmp_path_factory.mktemp("below") / "a folder, with blanks"
    shutil.copytree(SOURCE, folder / "src", ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder / ".venv"], check=True)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(folder / ".venv")}))
    (packages / "here.pth").write_text(f"{folder / 'src'}\n{sysconfig.get_path('purelib')}\n")
    (folder / "keys").mkdir()
    (folder / "keys" / "key.txt").write_text("0.3333")
    folder.chmod(0o700)
    return folder


def judged(project, user=None, **environment):
    program = [project / ".venv" / "bin" / "python", "-c", JUDGE, project / "keys"]
    kept = {"PATH": os.environ["PATH"], **{k: str(v) for k, v in environment.items()}}
    who = {"user": user, "group": user, "extra_groups": []} if user else {}
    done = subprocess.run(program, env=kept, cwd="/", capture_output=True, text=True, timeout=120, **who)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_project_below_tmp_with_blanks_that_only_its_owner_may_enter(project):
    (project / "tmp").mkdir()
    found = judged(project, HOME="/", TMPDIR=project / "tmp")
    keys = str(project / "keys")
    place = str(project / "src" / "loopbook" / "__init__.py")
    assert found["answers"]["K"] == 1.25 and found["answers"]["place"] == place
    if HIDDEN in found["walls"]:
        assert found["answers"][keys] == []
    if UNWRITABLE in found["walls"]:
        assert "Error" in found["failed"][-1][1]
    assert not (project / "src" / "loopbook" / "planted.py").exists()
    assert not list((project / "tmp").iterdir())


@pytest.mark.skipif(os.geteuid() != 0, reason="to become an ordinary user needs root")
@pytest.mark.skipif(not enterable(sys.base_prefix), reason="an ordinary user may not read this Python")
def test_an_ordinary_user_grades(project):
    for path in (project.parent, *project.parent.parents):
        if not path.stat().st_mode & 1 and path.is_relative_to(project.parents[2]):
            path.chmod(path.stat().st_mode | 1)
    os.chown(project, NOBODY, NOBODY)
    found = judged(project, NOBODY, HOME=project)
    assert found["answers"]["K"] == 1.25
    assert set(found["walls"]) <= set(WALLS[1:])
    os.chown(project, 0, 0)


@pytest.mark.skipif(os.geteuid() != 0, reason="root's notebooks run as another user")
def test_a_python_that_the_other_user_may_not_read_is_told_in_a_sentence(project, capfd):
    (project / "src").chmod(0o700)
    try:
        with pytest.raises(
            AssertionError, match=r"no student's notebook can be run .* may not read .*src; `chmod -R a"
        ):
            judged(project)
    finally:
        (project / "src").chmod(0o755)


@pytest.fixture
def work(sheet_file):
    """A class of one that handed in what is right."""
    content = sheet_file().read_bytes()
    submission = Submission("s1", "lag", "s1/lag.ipynb", ("answers = {'Kc': 1/3, 'rise': 65.917, 'half': 32.958}",))
    return GradeJob(content, {"K": 1.7, "T": 17.0}, submission, formats=())


@pytest.fixture(scope="module")
def jail():
    """The jail of this process, started anew."""
    one.jail.cache_clear()
    return one.jail((), GradeJob.__dataclass_fields__["limits"].default_factory())


@pytest.mark.parametrize(
    ("cell", "told"),
    [
        ("raise OSError('a disk that is gone')", "a trial gave OSError: a disk that is gone"),
        ("import os; os._exit(3)", "in a trial the notebook's process ended"),
        ("answers = {'five': 4.0, 'half': 0.5, 'twice': len}", "a trial gave"),
    ],
)
def test_where_our_own_notebook_fails_no_student_is_judged(cell, told, jail, monkeypatch):
    monkeypatch.setattr(jails, "_TRIAL", (*jails._TRIAL, cell))
    with pytest.raises(JailFailed, match=f"no student's notebook can be run on this machine: .*{told}"):
        jail._tried()


def test_a_wall_that_fell_stops_the_run(jail, monkeypatch):
    monkeypatch.setattr(jail, "walls", [*jail.walls, "a moat"])
    with pytest.raises(JailFailed, match="a moat stood before and does not now"):
        jail.start()


def test_a_process_that_was_ended_is_started_again(work, jail, monkeypatch):
    jail._process.kill()
    jail._process.wait()
    assert sum(j.points for j in grade_one(work).judged) == 4
    assert one.jail(work.hide, work.limits) is not jail
    one.jail(work.hide, work.limits)._process.kill()
    monkeypatch.setattr(one, "Jail", lambda *_: jail)
    with pytest.raises(JailFailed, match="was ended; grade again"):
        grade_one(work)
    one.jail.cache_clear()


def test_a_run_that_the_machine_fails_writes_no_grades(work, tmp_path, monkeypatch):
    class Failing:
        def run(self, function, jobs):
            yield 0, JailFailed("no memory")

    (tmp_path / "in").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "lag.ipynb").write_bytes(work.content)
    manifest = Manifest({"s1": ""}, {"lag": OfSheet("lag.ipynb", "", 4, {"s1": work.numbers})})
    monkeypatch.setattr(grading, "collect", lambda folder, manifest: grading.Collected([work.submission], []))
    with pytest.raises(JailFailed, match="no memory"):
        grade(tmp_path / "in", tmp_path / "out", manifest, tmp_path, Failing())
    assert not list((tmp_path / "out").iterdir())
