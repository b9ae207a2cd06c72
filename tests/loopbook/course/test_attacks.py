"""What a notebook may try: each attempt scores nothing or has a name, and the next notebook is judged as ever."""

import json
import os
import sys

import pytest

from loopbook.course.grade.one import GradeJob, grade_one
from loopbook.course.grade.submissions import Submission, collect
from loopbook.course.grade.verdicts import MISSING, RIGHT, UNREADABLE
from loopbook.course.notebooks import as_bytes
from loopbook.course.release.manifest import Manifest, OfSheet
from loopbook.course.release.one import runner
from loopbook.course.release.student import screen_sheet
from loopbook.course.sandbox.jail import Jail, NotebookFailed
from loopbook.course.sandbox.limits import MB, NotebookLimits
from loopbook.course.sandbox.walls import WALLS

pytestmark = [pytest.mark.builds, pytest.mark.skipif(sys.platform != "linux", reason="the walls are Linux's")]

NUMBERS = {"K": 1.7, "T": 17.0}
RIGHT_ONES = "answers = {'Kc': 1/3, 'rise': 65.917, 'half': 32.958}"
LIMITS = NotebookLimits(seconds=3, call=1, memory=700 * MB)


@pytest.fixture(scope="module")
def secrets(tmp_path_factory):
    """The teacher's folder with a key, and a neighbour's notebook beside."""
    folder = tmp_path_factory.mktemp("course")
    for name in ("teacher", "submissions"):
        (folder / name).mkdir()
        (folder / name / "key.txt").write_text("0.3333")
    return folder


@pytest.fixture
def submit(sheet_file, secrets):
    """Grade cells as one student's notebook; ({answer: verdict}, points, remarks)."""
    content = sheet_file().read_bytes()
    hide = tuple(str(secrets / name) for name in ("teacher", "submissions"))

    def run(*cells, texts=None):
        one = Submission("s1", "lag", "s1/lag.ipynb", cells, texts=texts or {})
        graded = grade_one(GradeJob(content, NUMBERS, one, hide=hide, limits=LIMITS, formats=()))
        return {j.name: j for j in graded.judged}, sum(j.points for j in graded.judged), graded.remarks

    return run


ATTACKS = {
    "redefined abs": ("import builtins\nbuiltins.abs = lambda x: 0\nabs = builtins.abs", "answers = {'Kc': 9.0}"),
    "a subclass of float": (
        "class F(float):\n    def __sub__(self, o): return 0.0\n    __rsub__ = __sub__",
        "answers = {'Kc': F(9)}",
    ),
    "equal to everything": (
        "class E:\n    def __eq__(self, o): return True\n    def __float__(self): return 1/3",
        "answers = {'Kc': E()}",
    ),
    "a dictionary of its own kind": ("class D(dict):\n    def __getitem__(self, k): return 1/3", "answers = D()"),
    "the end of Python": ("import os\nos._exit(0)", RIGHT_ONES),
    "an exit": ("import sys\nsys.exit()", "raise SystemExit", "answers = {}"),
    "an endless loop": ("while True: pass", RIGHT_ONES),
    "two gigabytes": ("x = bytearray(2 << 30)", "answers = {'Kc': len(x)}"),
    "a large file": ("open('x', 'wb').write(b'x' * (64 << 20))", "answers = {'Kc': 9}"),
    "many processes": ("import os\nwhile True: os.fork()", "answers = {'Kc': 9}"),
    "NaN": ("answers = {'Kc': float('nan'), 'rise': float('inf'), 'half': -float('inf')}",),
    "a decimal comma": ("answers = {'Kc': '0,333', 'rise': (65, 917)}",),
    "a traceback": (
        "raise ValueError('x' * 10**6)",
        "import IPython\nIPython.core.ultratb = None\n1/0",
        "answers = {'Kc': 9.0}",
    ),
    "a value that raises": (
        "class R:\n    __class__ = property(lambda s: 1/0)\n    def __repr__(self): raise MemoryError",
        "answers = {'Kc': R(), 'rise': [R()]}",
    ),
    "a huge value": ("answers = {'Kc': 10**5000, 'rise': [1.0] * 10**6, 'half': 'x' * 10**7}",),
    "a deep value": ("x = []\nfor _ in range(10**5): x = [x]\nanswers = {'Kc': x}",),
    "a forged reply": (
        'import os\nline = b\'{"answers": {"Kc": {"value": NaN}}}\'\n'
        "for n in range(3, 40):\n    try: os.write(n, line + bytes([10]))\n    except OSError: pass",
        "answers = {}",
    ),
    "no answers": ("x = 1",),
    "a syntax error": ("answers = {'Kc': 1/3,,}",),
    "json turned": ("import json\njson.dumps = lambda *a, **k: '{}'", RIGHT_ONES),
    "the sheet imported": (
        "from loopbook.course.session import current",
        "answers = {'Kc': current().asked['Kc'].key}",
    ),
}


@pytest.mark.parametrize("name", ATTACKS)
def test_an_attack_scores_nothing_or_has_a_name(name, submit):
    judged, points, remarks = submit(*ATTACKS[name])
    assert points == 0, (name, judged)
    assert remarks or any(j.verdict == UNREADABLE or j.words == "this is not the value" for j in judged.values()), name
    assert {j.verdict for j in submit(RIGHT_ONES)[0].values()} == {RIGHT}


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="another user needs root")
@pytest.mark.parametrize("where", ["teacher", "submissions"])
def test_neither_key_nor_neighbour_can_be_read(where, submit, secrets):
    read = f"answers = {{'Kc': float(open('{secrets / where / 'key.txt'}').read())}}"
    judged, points, remarks = submit(read)
    assert points == 0 and "FileNotFoundError" in remarks[0] and judged["Kc"].verdict == MISSING
    assert submit("import os, signal\nos.kill(os.getppid(), 9)", RIGHT_ONES)[1] == 4


def test_there_is_no_network_and_nothing_stays(submit, secrets):
    _, points, remarks = submit("import socket\nsocket.create_connection(('1.1.1.1', 80), 1)", "answers = {}")
    assert points == 0 and "Network is unreachable" in remarks[0]
    left = "import subprocess, time\nsubprocess.Popen(['sleep', '4711'])"
    assert submit(left, RIGHT_ONES)[1] == 4
    assert not any(b"4711" in p.read_bytes() for p in _command_lines())


def _command_lines():
    from pathlib import Path

    for path in Path("/proc").glob("[0-9]*/cmdline"):
        if path.exists():
            yield path


def test_edited_texts_are_told_and_change_nothing(submit, sheet_file):
    ran = runner("lag", sheet_file().read_bytes())
    released = screen_sheet(ran.sheet, ran.solve(NUMBERS, show="texts"), "s1")
    texts = {c["id"]: c["source"] for c in released["cells"]}
    edited = {**texts, "c4": texts["c4"].replace("half a minute", "a minute")}
    judged, _, remarks = submit("answers = {'Kc': 1/6, 'rise': 1.0, 'half': 0.5}", texts=edited)
    assert judged["Kc"].points == 0 and judged["half"].points == 1
    assert remarks == ["the text of c4 is not the one that was released; the numbers of the release hold"]
    assert submit(RIGHT_ONES, texts=texts)[2] == []


def test_whose_a_notebook_is(tmp_path, sheet_file):
    ran = runner("lag", sheet_file().read_bytes())
    held = {"s1": NUMBERS, "s2": {"K": 2.3, "T": 11.0}}
    manifest = Manifest({"s1": "", "s2": ""}, {"lag": OfSheet("", "", 4, held)})
    mine = as_bytes(screen_sheet(ran.sheet, ran.solve(NUMBERS, show="texts"), "s1"))
    bare = json.loads(mine)
    del bare["metadata"]["loopbook"]
    folder = tmp_path / "in"
    files = {
        "s1/lag.ipynb": mine,
        "s2/lag.ipynb": mine,  # the neighbour's
        "again/lag-s2-final.ipynb": as_bytes(bare),
        "lag.ipynb": as_bytes(bare),  # nobody's
        "torn.ipynb": b'{"cells": [',
        "other.ipynb": mine.replace(b'"student": "s1"', b'"student": "s9"'),
        "notes.docx": b"x",
        ".DS_Store": b"x",
    }
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    found = collect(folder, manifest)
    assert [(o.student, o.file) for o in found.found] == [("s2", "again/lag-s2-final.ipynb"), ("s1", "s1/lag.ipynb")]
    assert dict(found.unread) == {
        "s2/lag.ipynb": "it is the notebook of s1, handed in under s2",
        "lag.ipynb": "it does not say whose it is; put it into a folder with the student's id",
        "torn.ipynb": "no notebook that can be read (JSONDecodeError)",
        "other.ipynb": "it says that it is of 's9', who is not on the roster",
        "notes.docx": "neither a notebook nor a CSV",
    }
    (folder / "s1" / "copy.ipynb").write_bytes(mine)
    again = collect(folder, manifest)
    assert [o.student for o in again.found] == ["s2"] and "handed in lag 2 times" in dict(again.unread)["s1/copy.ipynb"]


@pytest.fixture(scope="module")
def jail():
    made = Jail(limits=NotebookLimits(seconds=20, call=0.5))
    yield made
    made.close()


def test_functions_are_called_with_numbers_and_within_limits(jail):
    running = jail.start()
    try:
        told = running.answers(
            [
                "import time, math\nstate = []",
                "def f(x, y):\n    state.append(x)\n    return x + y + len(state)",
                "answers = {'f': f, 'g': lambda: time.sleep(9), 'h': lambda x: 'no', 'r': lambda x: 1 / x, 'v': 1}",
            ]
        )
        assert told.functions == ["f", "g", "h", "r"] and told.answers == {"v": 1}
        assert [running.call("f", 1, 2), running.call("f", 1, 2)] == [4.0, 5.0]
        with pytest.raises(NotebookFailed, match=r"h\(1\): it gave 'no', no finite number"):
            running.call("h", 1)
        with pytest.raises(NotebookFailed, match=r"r\(0\): ZeroDivisionError"):
            running.call("r", 0)
        with pytest.raises(NotebookFailed, match=r"g\(\.\.\.\) did not finish within 0 s"):
            running.call("g")
    finally:
        running.close()


def test_numbers_of_numpy_and_sympy_are_numbers(jail):
    running = jail.start()
    try:
        told = running.answers(
            [
                "import numpy as np, sympy as sp\nx = sp.Symbol('x')",
                "answers = {'a': np.float64(2), 'b': np.arange(3), 'c': sp.Rational(1, 2)}",
                "answers |= {'d': x**2 + 1, 'e': (1, 2.5)}",
            ]
        )
        assert told.answers == {"a": 2.0, "b": [0, 1, 2], "c": 0.5, "d": "x**2 + 1", "e": [1, 2.5]}
        assert told.walls == list(WALLS) or os.geteuid() != 0
    finally:
        running.close()
