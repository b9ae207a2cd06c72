"""`loopbook course new`: a course of one's own, with a sheet to change, a roster, and nothing that is published."""

from pathlib import Path

from notebook_reports.project.new import new_project

TEMPLATE = Path(__file__).parent / "new_course"


def new_course(folder: Path) -> list[Path]:
    """Make the folder, all of it or nothing; the files, relative to it.

    Raises UsageError where something is there already, EnvironmentProblem where the folder cannot be written.
    """
    return new_project(folder, TEMPLATE)
