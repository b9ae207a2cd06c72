"""One student's work on one sheet: the job that grading does many times."""

import functools
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Any

from loopbook.course.grade.feedback import feedback
from loopbook.course.grade.judging import judge_all
from loopbook.course.grade.submissions import Submission, changed_texts
from loopbook.course.grade.typed import from_typed
from loopbook.course.grade.verdicts import Given, Judged
from loopbook.course.notebooks import Content, source_of
from loopbook.course.release.one import as_report, runner
from loopbook.course.release.student import screen_sheet
from loopbook.course.running import SheetRunner, Solved
from loopbook.course.sandbox.jail import Jail, JailFailed, NotebookFailed, Returned, RunningNotebook
from loopbook.course.sandbox.limits import NotebookLimits
from notebook_reports.export.read.solutions import QUESTION


@dataclass(frozen=True)
class GradeJob:
    """numbers: the student's. hide: folders that a notebook may not see. formats: of the feedback. keys: show them."""

    content: bytes
    numbers: dict[str, Any]
    submission: Submission
    name: str = ""
    hide: tuple[str, ...] = ()
    limits: NotebookLimits = field(default_factory=NotebookLimits)
    formats: tuple[str, ...] = ("pdf", "html")
    keys: bool = False


@dataclass(frozen=True)
class Graded:
    """What came of it. remarks: for the teacher; walls: what a notebook was shut in by. ended: it came to its end by
    itself; one that did not, for want of time say, is run again when the class is graded again."""

    judged: list[Judged] = field(default_factory=list)
    feedback: dict[str, bytes] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    walls: tuple[str, ...] = ()
    ended: bool = True


@functools.lru_cache(maxsize=1)
def jail(hide: tuple[str, ...], limits: NotebookLimits) -> Jail:
    """The jail of this process."""
    made = Jail([Path(h) for h in hide], limits, os.getpid() % 10)
    Finalize(made, made.close, exitpriority=1)  # also at the end of a worker, where atexit is not called
    return made


def grade_one(job: GradeJob) -> Graded:
    """Run, judge, write the feedback. Raises SheetError for what the sheet's own code raises."""
    ran = runner(job.submission.sheet, job.content)
    if job.submission.answers is not None:
        solved, judged = _typed(ran, job, job.submission.answers)
        remarks, walls, ended = _unknown(job.submission.answers, solved), tuple[str, ...](), True
    else:
        judged, remarks, walls, ended = _run(ran, job)
    content = feedback(ran.sheet, job.submission.student, job.name, judged, remarks, job.keys)
    return Graded(judged, _reports(content, ran, job.formats), remarks, walls, ended)


def _typed(ran: SheetRunner, job: GradeJob, typed: Mapping[str, str]) -> tuple[Solved, list[Judged]]:
    asked = ran.solve(job.numbers, strict=False).asked
    given = {name: Given(from_typed(one.kind, typed[name])) for name, one in asked.items() if name in typed}
    return judge_all(ran, job.numbers, given)


def _unknown(names: Mapping[str, Any], solved: Solved) -> list[str]:
    return [
        f"{name!r} is not asked for; there are {', '.join(solved.asked)}" for name in names if name not in solved.asked
    ]


def _run(ran: SheetRunner, job: GradeJob) -> tuple[list[Judged], list[str], tuple[str, ...], bool]:
    """Run the student's notebook behind its walls, and judge what comes out while its functions can be called."""
    running = _started(job)
    try:
        try:
            returned = running.answers(job.submission.cells)
        except NotebookFailed as failed:
            _, judged = judge_all(ran, job.numbers, {})
            return judged, [str(failed)], (), False
        solved, judged = judge_all(ran, job.numbers, _given(returned, running))
        names = dict.fromkeys((*returned.answers, *returned.functions, *returned.refused))
        remarks = [*(f"cell {n} raised {text}" for n, text in returned.failed), *_unknown(names, solved)]
        return judged, remarks + _edited(ran, job), tuple(returned.walls), True
    finally:
        running.close()


def _started(job: GradeJob) -> RunningNotebook:
    """A process behind walls; once more in a new jail where the old one was ended, for want of memory say."""
    try:
        return jail(job.hide, job.limits).start()
    except JailFailed:
        jail.cache_clear()
        return jail(job.hide, job.limits).start()


def _given(returned: Returned, running: RunningNotebook) -> dict[str, Given]:
    given = {name: Given(value) for name, value in returned.answers.items()}
    given |= {name: Given(functools.partial(running.call, name)) for name in returned.functions}
    return given | {name: Given(refused=why) for name, why in returned.refused.items()}


def _edited(ran: SheetRunner, job: GradeJob) -> list[str]:
    """What of the texts was changed; the judgement goes by the release in any case."""
    released = screen_sheet(ran.sheet, ran.solve(job.numbers, show="texts", strict=False), job.submission.student)
    questions = [(c["id"], source_of(c)) for c in released["cells"] if QUESTION in c["metadata"].get("tags", ())]
    cells = changed_texts(job.submission.texts, questions)
    told = "the numbers of the release hold"
    return [f"the text of {', '.join(cells)} is not the one that was released; {told}"] if cells else []


def _reports(content: Content, ran: SheetRunner, formats: tuple[str, ...]) -> dict[str, bytes]:
    return {format: as_report(content, ran.sheet, format, "Feedback: ", "mend") for format in formats}
