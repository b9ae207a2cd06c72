"""`loopbook diff REF`: what a change does to the ledger, as text for a terminal or for a review."""

import csv
import io
import re
import subprocess
from collections.abc import Sequence

from notebook_reports.ledger import files
from notebook_reports.ledger.row import LedgerRow, from_columns
from notebook_reports.project.project import Project, UsageError

TITLES = {"value": "printed values", "claim": "statements", "misprint": "misprints"}
MARKS = re.compile(r"([\\`*_{}\[\]<>()#+\-.!|~@$&:])")


def rows_at(project: Project, ref: str, table: str) -> list[LedgerRow]:
    """The rows of a table as a commit has them; none where it has no such file.

    Raises UsageError where there is no git or no such commit.
    """
    name = (project.reports / files.FILES[table]).relative_to(project.root).as_posix()
    if not _git(project, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{ref}^{{commit}}"):
        raise UsageError(f"{ref!r} is no commit of {project.root}: a branch, a tag or a hash is expected")
    text = _git(project, "show", "--end-of-options", f"{ref}:./{name}")
    return [from_columns(table, {k: v or "" for k, v in row.items()}) for row in csv.DictReader(io.StringIO(text))]


def _git(project: Project, *words: str) -> str:
    try:
        done = subprocess.run(["git", *words], cwd=project.root, capture_output=True, text=True, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"git is needed to read another state of the ledger: {error}") from None
    return done.stdout if done.returncode == 0 else ""


def difference(project: Project, ref: str) -> list[files.Change]:
    """Every row that appeared, went or changed since a commit, values first."""
    found = []
    for table, name in files.FILES.items():
        found += files.compare(table, rows_at(project, ref, table), files.read(project.reports / name, table))[1]
    return found


def as_text(changes: Sequence[files.Change], ref: str) -> str:
    """One line for each change, under the table it belongs to."""
    lines = [_headline(changes, ref)]
    for table, title in TITLES.items():
        mine = [c for c in changes if c.table == table]
        lines += [title, *(f"  {'! ' if c.moved else '  '}{c.line}" for c in mine)] if mine else []
    return "\n".join(lines)


def as_markdown(changes: Sequence[files.Change], ref: str) -> str:
    """The same for a review: whatever stands in the ledger is text there, never markup or a link."""
    lines = [f"**{as_plain_markdown(_headline(changes, ref))}**", ""]
    for table, title in TITLES.items():
        mine = [c for c in changes if c.table == table]
        if mine:
            lines += [f"| {title} | place | change | |", "|---|---|---|---|"]
            cells = ([c.row.id, f"{c.row.document}, {c.row.place}", c.what, "moved" if c.moved else ""] for c in mine)
            lines += ["| " + " | ".join(map(as_plain_markdown, row)) + " |" for row in cells]
            lines += [""]
    return "\n".join(lines)


def _headline(changes: Sequence[files.Change], ref: str) -> str:
    moved = sum(c.moved for c in changes)
    if not changes:
        return f"The ledger is that of {ref}"
    rows = "1 row of the ledger is" if len(changes) == 1 else f"{len(changes)} rows of the ledger are"
    told = f"{rows} not as in {ref}; {moved} of them moved"
    return told + ": a verdict, a printed digit, a row that went"


def as_plain_markdown(text: str) -> str:
    """Text as Markdown that shows it as it is.

    >>> as_plain_markdown("a|b <b>@all</b>")
    'a\\\\|b \\\\<b\\\\>\\\\@all\\\\</b\\\\>'
    """
    plain = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return MARKS.sub(r"\\\1", plain)
