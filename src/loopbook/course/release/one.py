"""One student's files of one sheet: the job that a release does many times."""

import functools
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from loopbook.course.errors import SheetError
from loopbook.course.notebooks import Content, as_bytes
from loopbook.course.release.keys import key_notebook, key_row
from loopbook.course.release.leaks import LeakScanner
from loopbook.course.release.student import paper_sheet, screen_sheet
from loopbook.course.running import SheetRunner
from loopbook.course.sheet import Sheet, read_sheet
from notebook_reports.export.exporters.choose import ExportError, export


@dataclass(frozen=True)
class ReleaseJob:
    """sheet: its id; content: the bytes of its notebook. numbers: the student's. pdf: for paper too."""

    sheet: str
    content: bytes
    student: str
    numbers: dict[str, Any]
    secret: bytes
    pdf: bool = True


@dataclass(frozen=True)
class ReleaseFiles:
    """What came of it: the files for the student and those for the teacher, by name; the leaks that were found."""

    student: dict[str, bytes] = field(default_factory=dict)
    teacher: dict[str, bytes] = field(default_factory=dict)
    keys: dict[str, Any] = field(default_factory=dict)
    leaks: list[str] = field(default_factory=list)


@functools.lru_cache(maxsize=32)
def runner(id: str, content: bytes) -> SheetRunner:
    """A sheet from the bytes of its notebook, compiled once in each process."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{id}.ipynb"
        path.write_bytes(content)
        return SheetRunner(read_sheet(path))


def release_one(job: ReleaseJob) -> ReleaseFiles:
    """Solve, write for the student and for the teacher, look for leaks. Raises SheetError."""
    ran = runner(job.sheet, job.content)
    solved = ran.solve(job.numbers, show="all", strict=False)
    screen = screen_sheet(ran.sheet, solved, job.student)
    student = {f"{job.sheet}.ipynb": as_bytes(screen)}
    key = key_notebook(ran.sheet, solved, job.student)
    teacher = {f"{job.sheet}.ipynb": as_bytes(key)}
    if job.pdf:
        student[f"{job.sheet}.pdf"] = as_report(paper_sheet(ran.sheet, solved, job.student), ran.sheet, "pdf")
        teacher[f"{job.sheet}.pdf"] = as_report(key, ran.sheet, "pdf", "Key: ")
    leaks = [str(leak) for leak in LeakScanner(ran.sheet, solved, job.secret, job.student).scan(student)]
    return ReleaseFiles(student, teacher, key_row(ran.sheet, solved), leaks)


def as_report(content: Content, sheet: Sheet, format: str, before: str = "", mode: str = "strict") -> bytes:
    """A notebook as PDF or HTML. before: the sheet's title. mode: see `export`.

    Raises SheetError for what a page cannot show, by cell.
    """
    import nbformat

    try:
        return export(nbformat.from_dict(content), format, name=sheet.id, title=f"{before}{sheet.title}", mode=mode)
    except ExportError as error:
        raise SheetError(f"{sheet.id}: the {format.upper()}: {error}") from None
