"""`loopbook course`: sheets for a class, from a roster to grades."""

import os
import secrets
import sys
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from derivations.errors import LoopbookError
from loopbook.jobs import NUMBERS, PACKAGES, PRINTING
from notebook_reports.cli import say
from notebook_reports.project.project import UsageError

if TYPE_CHECKING:
    from notebook_reports.executors.executor import Executor

FORMATS = ("moodle", "gift", "csv", "nbgrader", "otter")


def usable(command: Callable[..., Any]) -> Callable[..., Any]:
    """An error of sheets, rosters and submissions is one line and exit code 2."""

    @wraps(command)
    def run(*args: Any, **options: Any) -> Any:
        try:
            return command(*args, **options)
        except LoopbookError as error:
            raise UsageError(str(error)) from None

    return run


@click.group()
def course() -> None:
    """Exercise sheets for a class: numbers of each student's own, keys, judging, grades.

    docs/teaching.md is a course in an afternoon.
    """


@course.command()
@click.argument("folder", type=click.Path(path_type=Path))
@usable
def new(folder: Path) -> None:
    """A course of your own in a new FOLDER: one sheet to change, a roster, nothing published."""
    from loopbook.course.new import new_course

    for name in new_course(folder):
        say(f"{folder / name}")
    say(f"\ncd {folder} && loopbook course secret ~/{folder.name}.secret")


@course.command()
@click.argument("file", type=click.Path(path_type=Path))
@usable
def secret(file: Path) -> None:
    """Make a secret for a course in a new FILE, readable by you alone. Keep it as long as the course runs."""
    try:
        handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise UsageError(f"{file} is there already; another secret would give everybody other numbers") from None
    except OSError as error:
        raise UsageError(f"{file}: {error.strerror}") from None
    with os.fdopen(handle, "w") as out:
        out.write(secrets.token_hex(32) + "\n")
    say(f"{file}")


@course.command()
@click.argument("sheets", nargs=-1, required=True, metavar="SHEET...")
@click.option("--draws", type=click.IntRange(min=1), default=200, show_default=True, help="Variants to look at.")
@usable
def check(sheets: tuple[str, ...], draws: int) -> None:
    """Look at SHEETs as their author: is each one a sheet, how many variants has it, what do draws fall to?"""
    from loopbook.course.release.check import check as look

    worst = 0
    for path in map(sheet_path, sheets):
        good, lines = look(path, draws)
        for line in lines:
            say(line)
        worst = worst if good else 1
    sys.exit(worst)


@course.command()
@click.argument("sheets", nargs=-1, required=True, metavar="SHEET...")
@click.option("--students", type=click.Path(path_type=Path), required=True, metavar="FILE", help="The roster, a CSV.")
@click.option("--secret", "secret_file", type=click.Path(path_type=Path), required=True, metavar="FILE",
              help="The course's secret, outside of what is published.")  # fmt: skip
@click.option("-o", "--output", type=click.Path(file_okay=False, path_type=Path), required=True, metavar="DIR",
              help="students/ to be handed out, teacher/ to be kept.")  # fmt: skip
@click.option("--no-pdf", is_flag=True, help="Notebooks only.")
@click.option("--zip", "zips", is_flag=True, help="For each student an archive as well.")
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Processes at a time; default: one per core.")
@click.option("--cluster", metavar="N|tcp://HOST:PORT", help="On Dask's workers: N started here, or a scheduler's.")
@usable
def release(
    sheets: tuple[str, ...],
    students: Path,
    secret_file: Path,
    output: Path,
    no_pdf: bool,
    zips: bool,
    jobs: int | None,
    cluster: str | None,
) -> None:
    """Numbers for each student, drawn by the secret; notebooks and PDFs; keys and a manifest for the teacher.

    Released again into the same folder, with more students or a mended SHEET, nobody's numbers move.
    """
    from loopbook.course.release.draw import read_secret
    from loopbook.course.release.release import read_sheets
    from loopbook.course.release.release import release as release_all
    from loopbook.course.release.roster import read_roster

    roster = read_roster(students)
    key = read_secret(secret_file, _repository(output))
    found = read_sheets([sheet_path(name) for name in sheets])
    done = release_all(found, roster, key, output, _executor(jobs, cluster), not no_pdf, zips, _progress("released"))
    for line in (*done.remarks, *done.problems):
        say(line, err=True)
    say(f"{done.students} students, {done.files} files in {output}")
    sys.exit(1 if done.problems else 0)


@course.command()
@click.argument("submissions", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(file_okay=False, path_type=Path), required=True, metavar="DIR",
              help="grades.csv, summary.csv, unread.csv, feedback/ for each student.")  # fmt: skip
@click.option("--release", "released", type=click.Path(file_okay=False, path_type=Path), metavar="DIR",
              help="The release that was handed out; default: the one folder here that holds one.")  # fmt: skip
@click.option("--keys", is_flag=True, help="Show the right values in the feedback.")
@click.option("--format", "formats", default="pdf,html", show_default=True, help="Of the feedback.")
@click.option("--seconds", type=click.FloatRange(min=1), default=60.0, show_default=True, help="For one notebook.")
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Processes at a time; default: one per core.")
@click.option("--cluster", metavar="N|tcp://HOST:PORT", help="On Dask's workers: N started here, or a scheduler's.")
@usable
def grade(
    submissions: Path,
    output: Path,
    released: Path | None,
    keys: bool,
    formats: str,
    seconds: float,
    jobs: int | None,
    cluster: str | None,
) -> None:
    """Judge the notebooks and CSVs in SUBMISSIONS: feedback for each student, grades.csv for the class."""
    from loopbook.course.grade.grading import grade as grade_all
    from loopbook.course.release.manifest import FILE, read_manifest
    from loopbook.course.release.release import TEACHER
    from loopbook.course.sandbox.limits import NotebookLimits

    chosen = tuple(dict.fromkeys(f.strip() for f in formats.split(",") if f.strip()))
    if unknown := set(chosen) - {"pdf", "html"}:
        raise UsageError(f"unknown format {', '.join(sorted(unknown))}; one or more of pdf,html")
    folder = (released or _the_release()) / TEACHER
    manifest = read_manifest(folder / FILE)
    limits = NotebookLimits(seconds=seconds)
    hide = [folder.parent, folder.resolve().parents[1]]
    done = grade_all(
        submissions, output, manifest, folder, _executor(jobs, cluster), hide, chosen, keys, limits, _progress("judged")
    )
    say(f"{len(done.judged)} judged, grades in {output / 'grades.csv'}")
    for file, what in done.unread:
        say(f"{file}: {what}", err=True)
    for stood in sorted(done.walls):
        say(f"notebooks ran behind: {', '.join(stood) or 'no wall'}")
    handed_in = {file for file, _ in done.unread} - set(manifest.students)
    sys.exit(1 if handed_in else 0)


@course.command()
@click.argument("sheet", metavar="SHEET")
@click.option("--format", "form", type=click.Choice(FORMATS), required=True, help="For which system.")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE|DIR")
@click.option("--variants", type=click.IntRange(min=1), default=20, show_default=True, help="How many, with keys.")
@click.option("--secret", "secret_file", type=click.Path(path_type=Path), metavar="FILE",
              help="Which variants; default: the first that will do.")  # fmt: skip
@usable
def export(sheet: str, form: str, output: Path, variants: int, secret_file: Path | None) -> None:
    """A SHEET's questions with keys for another system: a weaker check than `grade`, as the files themselves say."""
    from loopbook.course.exports.export import export_sheet
    from loopbook.course.release.draw import read_secret

    key = read_secret(secret_file) if secret_file else b"loopbook public variants"
    for path in export_sheet(sheet_path(sheet), form, output, variants, key):
        say(f"{path}")


def sheet_path(name: str) -> Path:
    """The file of a sheet that is named by its path or by its id below notebooks/. Raises UsageError."""
    path = Path(name)
    if path.suffix == ".ipynb" and path.is_file():
        return path
    folder = next((p / "notebooks" for p in (Path.cwd(), *Path.cwd().parents) if (p / "notebooks").is_dir()), None)
    for place in (folder, folder / "exercises") if folder else ():
        if (place / f"{name}.ipynb").is_file():
            return place / f"{name}.ipynb"
    known = sorted(p.stem for p in (folder / "exercises").glob("*.ipynb")) if folder else []
    hint = f"; there are {', '.join(known)}" if known else ""
    raise UsageError(f"no sheet {name!r}{hint}")


def _executor(jobs: int | None, cluster: str | None) -> "Executor":
    from notebook_reports.executors.asked import executor_for

    return executor_for(
        jobs, cluster, PACKAGES, (*NUMBERS, "loopbook.course.release.one", "loopbook.course.grade.one", *PRINTING)
    )


def _repository(output: Path) -> Path | None:
    """The repository that holds what is released, if one does."""
    start = output.resolve()
    return next((p for p in (start, *start.parents) if (p / ".git").exists()), None)


def _the_release() -> Path:
    from loopbook.course.release.manifest import FILE
    from loopbook.course.release.release import TEACHER

    found = sorted(p.parents[1] for p in Path.cwd().glob(f"*/{TEACHER}/{FILE}"))
    if len(found) == 1:
        return found[0]
    what = f"there are {', '.join(p.name for p in found)}" if found else "there is none in this folder"
    raise UsageError(f"which release? {what}: name it with --release DIR")


def _progress(what: str) -> Callable[[int, int], None]:
    def tell(done: int, of: int) -> None:
        if sys.stderr.isatty():
            click.echo(f"\r{done} of {of} {what}" + ("\n" if done == of else ""), nl=False, err=True)

    return tell
