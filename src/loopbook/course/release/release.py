"""`loopbook course release`: everybody's numbers, everybody's files, and for the teacher the keys and the manifest."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from loopbook.course.errors import CourseError, SheetError
from loopbook.course.notebooks import source_of
from loopbook.course.release.draw import Draw
from loopbook.course.release.manifest import FILE, Manifest, OfSheet, read_manifest
from loopbook.course.release.one import ReleaseFiles, ReleaseJob, release_one, runner
from loopbook.course.release.printed import printed_answer
from loopbook.course.release.roster import Student
from loopbook.course.release.student import screen_sheet
from loopbook.course.release.variants import Variants
from loopbook.course.release.zips import zipped
from loopbook.course.running import SheetRunner
from loopbook.jobs import PACKAGES
from notebook_reports.executors.done import FOLDER, DoneJobs
from notebook_reports.executors.executor import Executor
from notebook_reports.project import atomic

STUDENTS, TEACHER, SHEETS, KEYS = "students", "teacher", "sheets", "keys"


@dataclass
class Released:
    """How a release ended. files: how many were written; problems: why some were not; remarks: what a teacher should
    know."""

    students: int = 0
    files: int = 0
    problems: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def why_not(ran: SheetRunner, numbers: dict[str, Any]) -> str:
    """Why these numbers make no exercise, or "": the author's own conditions, and no answer may stand in the texts."""
    solved = ran.solve(numbers, show="texts")
    if solved.redraw:
        return solved.redraw
    texts = [source_of(c) for c in screen_sheet(ran.sheet, solved, "")["cells"] if c["cell_type"] == "markdown"]
    name = printed_answer(solved.asked.values(), texts)
    return f"the answer {name} stands in the text" if name else ""


def read_sheets(paths: Sequence[Path]) -> dict[str, bytes]:
    """The content of each sheet by its id. Raises SheetError for one that is none, and for two of one name."""
    found: dict[str, bytes] = {}
    for path in paths:
        try:
            content = path.read_bytes()
        except OSError as error:
            raise SheetError(f"{path}: {error.strerror}") from None
        if path.stem in found:
            raise SheetError(f"two sheets are named {path.stem}")
        runner(path.stem, content)
        found[path.stem] = content
    return found


def assign_numbers(
    sheets: dict[str, bytes], roster: Sequence[Student], secret: bytes, before: Manifest
) -> tuple[Manifest, list[str]]:
    """The manifest with numbers for everybody, and what the teacher should know: who has numbers keeps them.

    Raises CourseError where there are fewer variants than students.
    """
    manifest = Manifest({**before.students, **{s.id: s.name for s in roster}}, dict(before.sheets))
    remarks = []
    for id, content in sheets.items():
        ran, variants = runner(id, content), Variants(runner(id, content).sheet)
        held = dict(before.sheets[id].numbers) if id in before.sheets else {}
        held, odd = _still_fitting(ran, held)
        remarks += odd
        taken = {i for i in map(variants.index, held.values()) if i is not None}
        draw = Draw(id, variants, secret, lambda numbers, ran=ran: why_not(ran, numbers), taken)  # type: ignore[misc]
        for student in roster:
            if student.id not in held:
                held[student.id] = draw.of(student.id, len({*held, *(s.id for s in roster)}))[1]
        first = ran.solve(next(iter(held.values())), strict=False)
        points = sum(asked.points for asked in first.asked.values())
        manifest.sheets[id] = OfSheet(f"{SHEETS}/{id}.ipynb", ran.sheet.digest, points, held)
    return manifest, remarks


def _still_fitting(ran: SheetRunner, held: dict[str, dict[str, Any]]) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """The numbers of those who were there before, for the sheet of now: a parameter that came gets its own value."""
    names, found, odd = ran.sheet.parameters, {}, []
    for student, numbers in held.items():
        found[student] = {name: numbers.get(name, parameter.default) for name, parameter in names.items()}
        try:
            reason = why_not(ran, found[student])
        except SheetError as error:
            raise CourseError(f"{ran.sheet.id}: the sheet no longer takes the numbers of {student}: {error}") from None
        if reason:
            odd.append(f"{ran.sheet.id}: {student} keeps numbers that would not be drawn now: {reason}")
    return found, odd


def release(
    sheets: dict[str, bytes],
    roster: Sequence[Student],
    secret: bytes,
    out: Path,
    executor: Executor,
    pdf: bool = True,
    zip: bool = False,
    tell: Callable[[int, int], None] = lambda done, of: None,
) -> Released:
    """Write the release into `out`. A file of a student in which a leak was found is not written.

    Raises CourseError and SheetError before anything is written.
    """
    teacher = out / TEACHER
    before = read_manifest(teacher / FILE) if (teacher / FILE).exists() else Manifest()
    manifest, remarks = assign_numbers(sheets, roster, secret, before)
    done = Released(len(roster), remarks=remarks)
    _private(teacher)
    for id, content in sheets.items():
        atomic.write(teacher / SHEETS / f"{id}.ipynb", content)
    manifest.write(teacher / FILE)
    jobs = [
        ReleaseJob(id, content, student.id, dict(manifest.numbers(id, student.id)), secret, pdf)
        for id, content in sheets.items()
        for student in roster
    ]
    kept = DoneJobs(out, teacher / FOLDER, PACKAGES)
    found = {_place(job): kept.find(_place(job), job) for job in jobs}
    done.files += sum(noted["files"] for noted in found.values() if noted is not None)
    todo = [job for job in jobs if found[_place(job)] is None]
    for number, (place, made) in enumerate(executor.run(release_one, todo), len(jobs) - len(todo) + 1):
        job = todo[place]
        if isinstance(made, Exception):
            done.problems.append(f"{job.student}, {job.sheet}: {made}")
        else:
            _write(done, out, kept, job, made)
        tell(number, len(jobs))
    if zip and not done.problems:
        done.files += _zips(out, roster)
    done.problems.sort()
    return done


def _place(job: ReleaseJob) -> str:
    return f"{job.student}/{job.sheet}"


def _write(done: Released, out: Path, kept: DoneJobs, job: ReleaseJob, made: ReleaseFiles) -> None:
    done.problems += [f"{job.student}, {leak}: not released" for leak in made.leaks]
    files = {f"{TEACHER}/{KEYS}/{job.student}/{name}": content for name, content in made.teacher.items()}
    for name, content in made.student.items():
        path = f"{STUDENTS}/{job.student}/{name}"
        if made.leaks:
            atomic.remove(out / path)
        else:
            files[path] = content
    for path, content in files.items():
        atomic.write(out / path, content)
    done.files += len(files)
    if not made.leaks:
        kept.note(_place(job), job, {"files": len(files)}, files)


def _zips(out: Path, roster: Sequence[Student]) -> int:
    for student in roster:
        folder = out / STUDENTS / student.id
        files = {p.name: p.read_bytes() for p in sorted(folder.iterdir()) if p.suffix in (".ipynb", ".pdf")}
        atomic.write(folder / f"{student.id}.zip", zipped(files))
    return len(roster)


def _private(folder: Path) -> None:
    """A folder that nobody else can look into."""
    folder.mkdir(parents=True, exist_ok=True)
    os.chmod(folder, 0o700)
