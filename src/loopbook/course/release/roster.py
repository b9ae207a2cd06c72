"""The class: who takes part, from a CSV as an office exports it."""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from loopbook.course.errors import CourseError

IDS = (
    "id",
    "student",
    "student id",
    "studentid",
    "student number",
    "id number",
    "user",
    "username",
    "login",
    "matrikel",
)
NAMES = ("name", "full name", "student name")
FIRST, LAST = ("first name", "firstname", "given name"), ("last name", "lastname", "surname", "family name")
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._@-]{0,63}")


@dataclass(frozen=True)
class Student:
    """One who takes part. id: as files are named; name: for the teacher's eyes, "" where the roster has none."""

    id: str
    name: str = ""


def plain_name(column: str) -> str:
    """A column's name as it is compared.

    >>> plain_name("Student_ID ")
    'student id'
    """
    return " ".join(column.replace("_", " ").split()).casefold()


def read_table(path: Path) -> tuple[list[str], list[dict[str, str]], list[int]]:
    """(columns, rows, their lines) of a CSV with commas, semicolons or tabs.

    Raises CourseError where it cannot be read.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise CourseError(f"{path}: {error.strerror}") from None
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("cp1252", errors="replace")
    first = text.partition("\n")[0]
    sign = max(",;\t", key=first.count)
    reader = csv.reader(io.StringIO(text), delimiter=sign)
    try:
        lines = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        raise CourseError(f"{path}: {error}") from None
    lines = [(number, row) for number, row in lines if any(row)]
    if not lines:
        raise CourseError(f"{path} is empty")
    columns = lines[0][1]
    rows = []
    for number, row in lines[1:]:
        if len(row) > len(columns):
            raise CourseError(f"{path}, line {number}: {len(row)} cells below {len(columns)} columns")
        rows.append(dict(zip(columns, row + [""] * (len(columns) - len(row)), strict=True)))
    return columns, rows, [number for number, _ in lines[1:]]


def read_roster(path: Path) -> list[Student]:
    """The students in the order of the file.

    A column named id, student or the like holds the ids; a name is optional. Raises CourseError for a file without ids,
    an id twice, or one that no file can be named after.
    """
    columns, rows, lines = read_table(path)
    column = id_column(columns)
    if column is None:
        raise CourseError(f"{path}: no column of ids; name one of the columns id (there are: {', '.join(columns)})")
    found: dict[str, Student] = {}
    for row, line in zip(rows, lines, strict=True):
        id = row[column]
        if not _ID.fullmatch(id):
            raise CourseError(f"{path}, line {line}: {id!r} names no file; an id has letters, digits and . _ @ -")
        if id.casefold() in found:
            raise CourseError(f"{path}, line {line}: {id} stands twice")
        found[id.casefold()] = Student(id, _name(row))
    if not found:
        raise CourseError(f"{path} names nobody")
    return list(found.values())


def id_column(columns: Sequence[str]) -> str | None:
    """The column that holds the ids of students, as written."""
    return next((c for name in IDS for c in columns if plain_name(c) == name), None)


def _name(written: Mapping[str, str]) -> str:
    row = {plain_name(column): cell for column, cell in written.items()}
    whole = next((row[n] for n in NAMES if row.get(n)), "")
    return whole or " ".join(p for n in (FIRST, LAST) for p in [next((row[k] for k in n if row.get(k)), "")] if p)
