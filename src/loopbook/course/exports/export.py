"""`loopbook course export`: one sheet, some variants, one format."""

from pathlib import Path

from loopbook.course.errors import CourseError
from loopbook.course.exports.gift import gift
from loopbook.course.exports.moodle import moodle
from loopbook.course.exports.nbgrader import nbgrader
from loopbook.course.exports.otter import otter
from loopbook.course.exports.plain_table import plain_table
from loopbook.course.exports.variants import variants_of
from loopbook.course.notebooks import as_bytes
from notebook_reports.project import atomic

FILES = {"moodle": (moodle, "xml"), "gift": (gift, "gift"), "csv": (plain_table, "csv")}
NOTEBOOKS = {"nbgrader": nbgrader, "otter": otter}


def export_sheet(path: Path, form: str, output: Path, count: int, secret: bytes) -> list[Path]:
    """Write the files; their paths. output: a folder, or for one file its name.

    nbgrader and otter take one notebook for everybody: of them each variant gets a folder. Raises SheetError.
    """
    sheet = path.stem
    variants = variants_of(path, count, secret)
    if form in FILES:
        make, ending = FILES[form]
        file = output if output.suffix else output / f"{sheet}.{ending}"
        atomic.write(file, make(sheet, variants))
        return [file]
    if form not in NOTEBOOKS:
        raise CourseError(f"the format is one of {', '.join((*FILES, *NOTEBOOKS))}, got {form!r}")
    found = []
    for variant in variants:
        name = sheet if count == 1 else f"{sheet}-{variant.number}"
        file = output / name / f"{sheet}.ipynb"
        atomic.write(file, as_bytes(NOTEBOOKS[form](sheet, variant)))
        found.append(file)
    return found
