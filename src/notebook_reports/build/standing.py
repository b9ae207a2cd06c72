"""Where a notebook stands in the book: its part, its neighbours, the page that lists all."""

import os
import posixpath
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path

from notebook_reports.export.around import Around, Door
from notebook_reports.memory.hashes import digest
from notebook_reports.project.project import BOOK, FORMATS, Notebook, Project, UsageError
from notebook_reports.project.source import read_source
from notebook_reports.project.toml import tables

INDEX = "index.html"
FILES = {"pdf": "PDF", "ipynb": "notebook"}


@dataclass(frozen=True)
class Standing:
    """part: the title of its part, "" where there is none. around: for the screen; None where no page is beside it."""

    part: str = ""
    around: Around | None = None

    def print(self, format: str) -> str:
        """Changes with anything that a report shows of it."""
        return digest([self.part, asdict(self.around) if self.around and format == "html" else None])


NOWHERE = Standing()


def standing(project: Project, notebook: Notebook, beside: bool, formats: tuple[str, ...] = FORMATS) -> Standing:
    """beside: do the reports lie where those of the others do? formats: those that are written."""
    if not notebook.own:
        return NOWHERE
    try:
        book = project.book()
        parts = {str(p.get("folder")): str(p.get("title", "")) for p in tables(book, "part", f"notebooks/{BOOK}")}
        notebooks = project.notebooks()
    except (UsageError, ValueError):
        return NOWHERE  # what is wrong with the book is said where the book is made
    part = parts.get(notebook.folder, "")
    if not beside:
        return Standing(part)
    order = list(parts)
    ordered = sorted(notebooks, key=lambda n: (order.index(n.folder) if n.folder in order else len(order), n.id))
    at = next((i for i, n in enumerate(ordered) if n.id == notebook.id), None)
    if at is None:
        return Standing(part)
    before, after = (ordered[i] if 0 <= i < len(ordered) else None for i in (at - 1, at + 1))
    title = str(book.get("title", ""))
    home = Door(_relative(INDEX, notebook), title) if title else None
    name = posixpath.basename(notebook.id)
    files = tuple(Door(f"{name}.{format}", words) for format, words in FILES.items() if format in formats)
    around = Around(home, _door(before, notebook), _door(after, notebook), files)
    return Standing(part, around)


def _door(other: Notebook | None, notebook: Notebook) -> Door | None:
    if other is None:
        return None
    return Door(_relative(f"{other.id}.html", notebook), _title(other.path, os.stat(other.path).st_mtime_ns))


def _relative(path: str, notebook: Notebook) -> str:
    return posixpath.relpath(path, notebook.folder or ".")


@lru_cache(maxsize=4096)
def _title(path: Path, _: int) -> str:
    """The title of a notebook, read once as long as its file is the same."""
    try:
        return read_source(path).title
    except UsageError:
        return path.stem.replace("_", " ")
