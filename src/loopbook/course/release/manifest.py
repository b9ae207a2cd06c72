"""What was released to whom: the numbers that hold from then on, whatever becomes of sheet, roster and secret."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from loopbook.course.errors import CourseError
from notebook_reports.project import atomic

FILE = "manifest.json"
VERSION = 1


@dataclass
class OfSheet:
    """One sheet of a release. source: the sheet's file, below the manifest's folder; digest: of the sheet as released.
    numbers: by student."""

    source: str
    digest: str
    points: float
    numbers: dict[str, dict[str, Any]] = field(default_factory=dict)


@dataclass
class Manifest:
    """A release. students: names by id, in the roster's order."""

    students: dict[str, str] = field(default_factory=dict)
    sheets: dict[str, OfSheet] = field(default_factory=dict)

    def write(self, path: Path) -> None:
        """Write it, all or nothing, readable by its owner alone."""
        sheets = {id: vars(sheet) for id, sheet in self.sheets.items()}
        text = json.dumps(
            {"version": VERSION, "students": self.students, "sheets": sheets}, indent=1, ensure_ascii=False
        )
        atomic.write(path, f"{text}\n".encode())
        path.chmod(0o600)

    def numbers(self, sheet: str, student: str) -> Mapping[str, Any]:
        """What one student has. Raises CourseError for one who has nothing."""
        found = self.sheets.get(sheet)
        if found is None:
            raise CourseError(f"no sheet {sheet!r} was released; there are {', '.join(self.sheets)}")
        if student not in found.numbers:
            raise CourseError(f"{student} has no numbers of {sheet}")
        return found.numbers[student]


def read_manifest(path: Path) -> Manifest:
    """Raises CourseError for a file that is no manifest of this version."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        if data["version"] != VERSION:
            raise CourseError(f"{path}: version {data['version']}, {VERSION} is understood")
        sheets = {id: OfSheet(**sheet) for id, sheet in data["sheets"].items()}
        return Manifest(dict(data["students"]), sheets)
    except CourseError:
        raise
    except OSError as error:
        raise CourseError(f"{path}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise CourseError(f"{path} is no manifest of a release ({type(error).__name__}: {error})") from None
