"""`loopbook new`: a project of one's own, with one printed table, one notebook and the order of a book."""

import os
import shutil
import tempfile
from pathlib import Path

from notebook_reports.project.project import EnvironmentProblem, UsageError

TEMPLATE = Path(__file__).parent / "new_project"


def new_project(folder: Path, template: Path = TEMPLATE) -> list[Path]:
    """Make the folder, all of it or nothing; the files, relative to it. template: what it begins with.

    Raises UsageError where something is there already, EnvironmentProblem where the folder cannot be written.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UsageError(f"{folder} is there already and not empty; name a new folder")
    names = [p.relative_to(template) for p in sorted(template.rglob("*")) if p.is_file()]
    target = folder.resolve()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".loopbook-new-", dir=target.parent) as beside:
            made = Path(beside) / target.name
            for name in names:
                (made / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(template / name, made / name)
            (made / "gitignore").rename(made / ".gitignore")
            os.replace(made, target)
    except OSError as error:
        raise EnvironmentProblem(f"{folder} cannot be made: {error.strerror or error}") from None
    return sorted(p.relative_to(target) for p in target.rglob("*") if p.is_file())
