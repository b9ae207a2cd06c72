"""A release and a grading that were broken off go on; what was changed or damaged is done again, to the same bytes."""

from dataclasses import replace

import pytest

from loopbook.course.grade import grading
from loopbook.course.grade.grading import grade
from loopbook.course.grade.one import Graded
from loopbook.course.grade.submissions import Collected, Submission
from loopbook.course.grade.verdicts import Judged
from loopbook.course.release.manifest import Manifest, OfSheet
from loopbook.course.release.release import release
from loopbook.course.release.roster import Student

ROSTER = [Student(f"s{n}", f"Student {n}") for n in range(4)]
SECRET = b"a secret of sixteen bytes"


class Counted:
    """Runs jobs here and counts them; after `stop` it breaks off."""

    def __init__(self, stop=99):
        self.ran, self.stop = 0, stop

    def run(self, function, jobs):
        for place, job in enumerate(jobs):
            if self.ran == self.stop:
                raise KeyboardInterrupt
            self.ran += 1
            yield place, function(job)


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_a_release_goes_on_where_it_was_broken_off(sheet_file, tmp_path):
    def to(name, executor):
        released = release(sheets, ROSTER, SECRET, tmp_path / name, executor, pdf=False)
        return released.files, executor.ran

    sheets = {"lag": sheet_file().read_bytes()}
    assert to("whole", Counted()) == (8, 4)
    with pytest.raises(KeyboardInterrupt):
        to("broken", Counted(stop=2))
    assert to("broken", Counted()) == (8, 2)
    assert contents(tmp_path / "broken") == contents(tmp_path / "whole")
    damaged = tmp_path / "broken" / "students" / "s1" / "lag.ipynb"
    damaged.write_bytes(damaged.read_bytes()[:-9])
    (tmp_path / "broken" / "teacher" / "keys" / "s2" / "lag.ipynb").unlink()
    assert to("broken", Counted()) == (8, 2)
    assert contents(tmp_path / "broken") == contents(tmp_path / "whole")
    sheets["lag"] = sheets["lag"].replace(b"half a minute", b"half a minute, to the digit")
    assert to("broken", Counted()) == (8, 4)


def test_a_grading_goes_on_and_runs_again_what_did_not_end(tmp_path, monkeypatch):
    found = [Submission(s.id, "lag", f"{s.id}/lag.ipynb", (f"answers = {{'Kc': {n}}}",)) for n, s in enumerate(ROSTER)]
    manifest = Manifest(
        {s.id: s.name for s in ROSTER}, {"lag": OfSheet("lag.ipynb", "", 2, {s.id: {"K": 1.7} for s in ROSTER})}
    )
    (tmp_path / "lag.ipynb").write_bytes(b"{}")

    def judge(job):
        right = job.submission.student == "s0"
        judged = [Judged("Kc", "right" if right else "wrong", "", 2.0 * right, 2.0, own=("a",))]
        return Graded(judged, {"html": repr(job.submission).encode()}, ["a remark"], ("no network",), not right)

    def to(name, executor):
        grade(tmp_path, tmp_path / name, manifest, tmp_path, executor)
        return executor.ran

    monkeypatch.setattr(grading, "collect", lambda *_: Collected(found, []))
    monkeypatch.setattr(grading, "grade_one", judge)
    assert to("whole", Counted()) == 4
    with pytest.raises(KeyboardInterrupt):
        to("broken", Counted(stop=3))
    assert to("broken", Counted()) == 2  # the one that was not judged, and the one that did not end by itself
    assert contents(tmp_path / "broken") == contents(tmp_path / "whole")
    found[3] = replace(found[3], cells=("answers = {}",))
    assert to("broken", Counted()) == 2
