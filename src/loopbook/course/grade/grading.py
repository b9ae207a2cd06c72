"""`loopbook course grade`: every submission judged, feedback for each student, tables for the class."""

import csv
import io
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from loopbook.course.errors import CourseError
from loopbook.course.grade.one import Graded, GradeJob, grade_one
from loopbook.course.grade.submissions import Collected, Submission, collect
from loopbook.course.grade.verdicts import OWN, RIGHT, Judged
from loopbook.course.release.manifest import Manifest
from loopbook.course.sandbox.jail import JailFailed
from loopbook.course.sandbox.limits import NotebookLimits
from loopbook.jobs import PACKAGES
from notebook_reports.executors.done import FOLDER, DoneJobs
from notebook_reports.executors.executor import Executor
from notebook_reports.project import atomic

FEEDBACK = "feedback"
GRADES, ANSWERS, SUMMARY, UNREAD, REMARKS = "grades.csv", "answers.csv", "summary.csv", "unread.csv", "remarks.csv"
Key = tuple[str, str]


@dataclass
class Grades:
    """A class graded. judged: by (student, sheet); unread, remarks: (file, what). walls: what shut notebooks in."""

    judged: dict[Key, list[Judged]] = field(default_factory=dict)
    unread: list[tuple[str, str]] = field(default_factory=list)
    remarks: list[tuple[str, str]] = field(default_factory=list)
    walls: set[tuple[str, ...]] = field(default_factory=set)


def grade(
    folder: Path,
    out: Path,
    manifest: Manifest,
    release: Path,
    executor: Executor,
    hide: Sequence[Path] = (),
    formats: tuple[str, ...] = ("pdf", "html"),
    keys: bool = False,
    limits: NotebookLimits | None = None,
    tell: Callable[[int, int], None] = lambda done, of: None,
) -> Grades:
    """Judge what lies in `folder` and write grades and feedback into `out`. release: the folder of the manifest.

    Raises CourseError before anything runs, and JailFailed where the machine, not a student, is why a notebook gives
    nothing.
    """
    collected = collect(folder, manifest)
    sheets = {id: _sheet(release / one.source) for id, one in manifest.sheets.items()}
    hidden = tuple(dict.fromkeys(str(p.resolve()) for p in (folder, release, out, *hide)))
    jobs = [_job(one, sheets, manifest, hidden, formats, keys, limits or NotebookLimits()) for one in collected.found]
    done = Grades(unread=list(collected.unread))
    kept = DoneJobs(out, out / FOLDER, PACKAGES)
    todo = [job for job in jobs if not _graded_before(done, kept, job)]
    for number, (place, found) in enumerate(executor.run(grade_one, todo), len(jobs) - len(todo) + 1):
        _note(done, out, kept, todo[place], found)
        tell(number, len(jobs))
    done.unread += _not_handed_in(collected, manifest)
    done.unread.sort()
    done.remarks.sort()
    write(done, out, manifest)
    return done


def _job(
    one: Submission,
    sheets: Mapping[str, bytes],
    manifest: Manifest,
    hide: tuple[str, ...],
    formats: tuple[str, ...],
    keys: bool,
    limits: NotebookLimits,
) -> GradeJob:
    numbers = dict(manifest.numbers(one.sheet, one.student))
    return GradeJob(sheets[one.sheet], numbers, one, manifest.students[one.student], hide, limits, formats, keys)


def _sheet(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise CourseError(f"the released sheet {path} cannot be read: {error.strerror}") from None


def _place(one: Submission) -> str:
    return f"{one.student}/{one.sheet}"


def _same(job: GradeJob) -> GradeJob:
    """The job without what changes nothing of its result."""
    return replace(job, hide=())


def _graded_before(done: Grades, kept: DoneJobs, job: GradeJob) -> bool:
    noted = kept.find(_place(job.submission), _same(job))
    if noted is None:
        return False
    judged = [Judged(**{**one, "own": tuple(one["own"])}) for one in noted["judged"]]
    _add(done, job.submission, Graded(judged, {}, noted["remarks"], tuple(noted["walls"])))
    return True


def _note(done: Grades, out: Path, kept: DoneJobs, job: GradeJob, found: Graded | Exception) -> None:
    one = job.submission
    if isinstance(found, JailFailed):
        raise found
    if isinstance(found, Exception):
        done.unread.append((one.file, f"could not be judged: {found}"))
        return
    _add(done, one, found)
    files = {f"{FEEDBACK}/{_place(one)}.{format}": content for format, content in found.feedback.items()}
    for name, content in files.items():
        atomic.write(out / name, content)
    if found.ended:
        noted = {"judged": [asdict(j) for j in found.judged], "remarks": found.remarks, "walls": found.walls}
        kept.note(_place(one), _same(job), noted, files)


def _add(done: Grades, one: Submission, found: Graded) -> None:
    done.judged[one.student, one.sheet] = found.judged
    done.remarks += [(one.file, remark) for remark in found.remarks]
    done.walls |= {found.walls} if found.walls else set()


def _not_handed_in(collected: Collected, manifest: Manifest) -> list[tuple[str, str]]:
    there = {(one.student, one.sheet) for one in collected.found}
    wanted = [(student, id) for id, sheet in manifest.sheets.items() for student in sheet.numbers]
    return [
        (student, f"{id}: nothing that could be judged was handed in")
        for student, id in wanted
        if (student, id) not in there
    ]


def write(done: Grades, out: Path, manifest: Manifest) -> None:
    """The class's tables."""
    sheets = list(manifest.sheets)
    of = sum(sheet.points for sheet in manifest.sheets.values())
    grades = []
    for student, name in manifest.students.items():
        sums = [sum(j.points for j in done.judged.get((student, sheet), [])) for sheet in sheets]
        grades.append([student, name, *(f"{s:g}" for s in sums), f"{sum(sums):g}", f"{of:g}"])
    answers = [
        [student, sheet, j.name, j.plain_given, j.verdict, j.words, f"{j.points:g}", f"{j.of:g}", j.plain_key]
        for (student, sheet), judged in sorted(done.judged.items())
        for j in judged
    ]
    head = ["student", "sheet", "answer", "given", "verdict", "words", "points", "of", "key"]
    tables = {
        GRADES: [["student", "name", *sheets, "total", "of"], *grades],
        ANSWERS: [head, *answers],
        SUMMARY: [
            ["sheet", "answer", "answers", "right", "from own values", "points", "verdict", "times"],
            *summary(done),
        ],
        UNREAD: [["file", "what"], *map(list, done.unread)],
        REMARKS: [["file", "what"], *map(list, done.remarks)],
    }
    for name, rows in tables.items():
        atomic.write(out / name, as_csv(rows))


def summary(done: Grades) -> list[list[str]]:
    """For each answer how often it was right, right from own values, and what else it was, most often first."""
    by_answer: dict[Key, list[Judged]] = {}
    for (_, sheet), judged in sorted(done.judged.items()):
        for one in judged:
            by_answer.setdefault((sheet, one.name), []).append(one)
    rows = []
    for (sheet, name), judged in by_answer.items():
        right, own = (sum(j.verdict == v for j in judged) for v in (RIGHT, OWN))
        mean = sum(j.points for j in judged) / len(judged)
        start = [sheet, name, str(len(judged)), str(right), str(own), f"{mean:.2f} of {judged[0].of:g}"]
        others = Counter(j.method or j.verdict for j in judged if j.verdict not in (RIGHT, OWN))
        named = sorted(others.items(), key=lambda pair: (-pair[1], pair[0]))
        rows += [[*start, what, str(times)] for what, times in named] or [[*start, "", ""]]
    return rows


def as_csv(rows: Sequence[Sequence[str]]) -> bytes:
    """A table that a spreadsheet reads as text: a cell that would be a formula gets an apostrophe."""
    made = io.StringIO()
    csv.writer(made, lineterminator="\n").writerows([[_harmless(cell) for cell in row] for row in rows])
    return made.getvalue().encode()


def _harmless(cell: str) -> str:
    """
    >>> _harmless("=1+1"), _harmless("-0.5"), _harmless("K")
    ("'=1+1", '-0.5', 'K')
    """
    if cell[:1] not in ("=", "+", "-", "@", "\t"):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"'{cell}"
    return cell
