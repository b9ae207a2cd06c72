"""What was handed in: notebooks, and answers typed from paper into a CSV; whose they are, and what cannot be read."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from loopbook.course.errors import CourseError
from loopbook.course.notebooks import COURSE, source_of
from loopbook.course.release.manifest import Manifest
from loopbook.course.release.roster import id_column, plain_name, read_table

LARGEST = 20 << 20
"""Bytes of a notebook."""


@dataclass(frozen=True)
class Submission:
    """The work of one student on one sheet. cells: the code of a notebook; answers: of a CSV, as typed, by name.
    texts: the prose of the notebook by the ids of its cells."""

    student: str
    sheet: str
    file: str
    cells: tuple[str, ...] = ()
    answers: Mapping[str, str] | None = None
    texts: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Collected:
    """All that was handed in. unread: (file, why) of each that could not be read."""

    found: list[Submission] = field(default_factory=list)
    unread: list[tuple[str, str]] = field(default_factory=list)


def collect(folder: Path, manifest: Manifest) -> Collected:
    """Look through a folder. Raises CourseError where there is none."""
    if not folder.is_dir():
        raise CourseError(f"{folder} is no folder of submissions")
    collected = Collected()
    for path in sorted(p for p in folder.rglob("*") if p.is_file() and not _is_hidden(p.relative_to(folder))):
        name = path.relative_to(folder).as_posix()
        try:
            if path.suffix.lower() == ".ipynb":
                collected.found.append(_notebook(path, name, manifest))
            elif path.suffix.lower() in (".csv", ".tsv"):
                collected.found += _table(path, name, manifest)
            elif path.suffix.lower() == ".zip":
                raise CourseError("an archive: unpack it here")
            else:
                raise CourseError("neither a notebook nor a CSV")
        except CourseError as error:
            collected.unread.append((name, str(error)))
    return _each_once(collected)


def _is_hidden(path: Path) -> bool:
    return any(part.startswith(".") or part == "__MACOSX" for part in path.parts)


def _each_once(collected: Collected) -> Collected:
    """Two of one student and sheet: neither is judged, for nobody knows which is meant."""
    by_whom: dict[tuple[str, str], list[Submission]] = {}
    for one in collected.found:
        by_whom.setdefault((one.student, one.sheet), []).append(one)
    single = [many[0] for many in by_whom.values() if len(many) == 1]
    for (student, sheet), many in by_whom.items():
        if len(many) > 1:
            told = f"{student} handed in {sheet} {len(many)} times: {', '.join(m.file for m in many)}; keep one"
            collected.unread.append((many[0].file, told))
    return Collected(single, sorted(collected.unread))


def _notebook(path: Path, name: str, manifest: Manifest) -> Submission:
    if path.stat().st_size > LARGEST:
        raise CourseError(f"larger than {LARGEST >> 20} MB")
    try:
        content = json.loads(path.read_bytes())
        cells = content["cells"]
        kinds = [(c["cell_type"], str(c.get("id", "")), source_of(c)) for c in cells]
        told = content.get("metadata", {}).get("loopbook", {}).get(COURSE, {})
        told = told if isinstance(told, dict) else {}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise CourseError(f"no notebook that can be read ({type(error).__name__})") from None
    student = _whose(name, str(told.get("student", "")), manifest)
    sheet = _of_sheet(name, str(told.get("sheet", "")), manifest)
    manifest.numbers(sheet, student)
    code = tuple(text for kind, _, text in kinds if kind == "code" and text.strip())
    return Submission(student, sheet, name, code, texts={id: t for kind, id, t in kinds if kind == "markdown" and id})


def _whose(name: str, told: str, manifest: Manifest) -> str:
    """The student by the file's path and by the notebook itself, which must not contradict each other."""
    by_path = _named_in(name, manifest.students)
    if told and told not in manifest.students:
        raise CourseError(f"it says that it is of {told!r}, who is not on the roster")
    if told and by_path and told not in by_path:
        raise CourseError(f"it is the notebook of {told}, handed in under {by_path[0]}")
    if not told and len(by_path) != 1:
        raise CourseError("it does not say whose it is; put it into a folder with the student's id")
    return told or by_path[0]


def _of_sheet(name: str, told: str, manifest: Manifest) -> str:
    if told in manifest.sheets:
        return told
    named = _named_in(Path(name).name, manifest.sheets)
    if len(manifest.sheets) == 1:
        return next(iter(manifest.sheets))
    if len(named) != 1:
        raise CourseError("it does not say which sheet it is; name it after the sheet")
    return named[0]


def _named_in(text: str, names: Mapping[str, Any]) -> list[str]:
    """The names that stand in a text as whole words."""
    return [n for n in names if re.search(rf"(?<![A-Za-z0-9]){re.escape(n)}(?![A-Za-z0-9])", text, re.IGNORECASE)]


def _table(path: Path, name: str, manifest: Manifest) -> list[Submission]:
    columns, rows, lines = read_table(path)
    ids = id_column(columns)
    if ids is None:
        raise CourseError(f"no column of ids; there are {', '.join(columns)}")
    of_sheet = next((c for c in columns if plain_name(c) == "sheet"), None)
    found = []
    for row, line in zip(rows, lines, strict=True):
        if row[ids] not in manifest.students:
            raise CourseError(f"line {line}: {row[ids]!r} is not on the roster")
        sheet = row[of_sheet] if of_sheet else _of_sheet(name, path.stem, manifest)
        manifest.numbers(sheet, row[ids])
        answers = {c: row[c] for c in columns if c not in (ids, of_sheet) and row[c]}
        found.append(Submission(row[ids], sheet, f"{name}, line {line}", answers=answers))
    return found


def changed_texts(texts: Mapping[str, str], expected: Sequence[tuple[str, str]]) -> list[str]:
    """The ids of cells of which a student's text is not the one that was released."""
    return [id for id, text in expected if id in texts and " ".join(texts[id].split()) != " ".join(text.split())]
