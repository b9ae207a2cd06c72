"""Where a project keeps things: its notebooks, its reports, its cache. Light: nothing here imports Jupyter."""

import difflib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from notebook_reports.errors import PressError
from notebook_reports.project.home import owns, private_cache
from notebook_reports.project.toml import TomlError, read_toml, tables

BOOK = "book.toml"
FORMATS = ("pdf", "html", "ipynb")


class UsageError(PressError):
    """What was asked for cannot be done as asked: an unknown notebook, a wrong parameter. Exit code 2."""


class EnvironmentProblem(PressError):
    """The machine does not let us work: an unwritable folder, a full disk, a missing package. Exit code 3."""


@dataclass(frozen=True)
class Notebook:
    """One notebook to build.

    id: how the command line names it, ``double_tank/03_pole_placement``. path: the .ipynb file.
    own: True for a notebook of the project, whose checks go into the ledger.
    """

    id: str
    path: Path
    own: bool = True

    @property
    def root(self) -> Path:
        """The folder of which its reports may show files: the project's, of a notebook from elsewhere its own."""
        return self.path.parents[self.id.count("/") + 1] if self.own else self.path.parent

    @property
    def folder(self) -> str:
        """The part of the id before the name, or "": the document that the notebook belongs to."""
        return self.id.rpartition("/")[0]


@dataclass(frozen=True)
class Project:
    """A folder with ``notebooks/``; everything built goes to ``reports/``, everything remembered to ``cache``.

    src: the folder of the project's own code, first on the path of its notebooks; None where none is to be used.
    beside: may a notebook import what lies beside it?
    """

    root: Path
    cache: Path
    src: Path | None = None
    beside: bool = True

    @property
    def notebooks_folder(self) -> Path:
        return self.root / "notebooks"

    @property
    def reports(self) -> Path:
        return self.root / "reports"

    def book(self) -> dict[str, Any]:
        """What notebooks/book.toml says, {} where there is none. Raises UsageError where it cannot be read."""
        try:
            return read_toml(self.notebooks_folder / BOOK, f"notebooks/{BOOK}")
        except FileNotFoundError:
            return {}
        except TomlError as error:
            raise UsageError(str(error)) from None

    @property
    def documents(self) -> Path:
        """The folder with a folder for each document, as ``documents`` in book.toml names it; may not exist."""
        return self.root / str(self.book().get("documents", "documents"))

    def parts(self) -> list[str]:
        """The folders of notebooks in the order of the book."""
        try:
            return [str(part.get("folder")) for part in tables(self.book(), "part", f"notebooks/{BOOK}")]
        except TomlError as error:
            raise UsageError(str(error)) from None

    def notebooks(self) -> list[Notebook]:
        """Every notebook of the project, sorted by id. Raises UsageError where there is none."""
        folder = self.notebooks_folder
        found = [
            Notebook(path.relative_to(folder).with_suffix("").as_posix(), path)
            for path in folder.rglob("*.ipynb")
            if not any(part.startswith(".") for part in path.relative_to(folder).parts)
        ]
        if not found:
            raise UsageError(f"no notebook in {folder}")
        return sorted(found, key=lambda n: n.id)

    def select(self, names: tuple[str, ...]) -> list[Notebook]:
        """The notebooks named, by id, by id without the number's tail (``double_tank/03``), by folder or by path.

        Raises UsageError for a name that fits none, with the nearest ones.
        """
        if not names:
            return self.notebooks()
        chosen: dict[Path, Notebook] = {}
        for name in names:
            for notebook in self._named(name):
                chosen[notebook.path] = notebook
        return list(chosen.values())

    def _named(self, name: str) -> list[Notebook]:
        path = Path(name)
        if path.suffix == ".ipynb":
            if not path.is_file():
                raise UsageError(f"no such notebook: {name}")
            path = path.resolve()
            if path.is_relative_to(self.notebooks_folder):
                return [Notebook(path.relative_to(self.notebooks_folder).with_suffix("").as_posix(), path)]
            return [Notebook(path.stem, path, own=False)]
        everything = self.notebooks()
        name = name.removeprefix("notebooks/").rstrip("/")
        exact = [n for n in everything if n.id == name]
        if exact:
            return exact
        inside = [n for n in everything if n.id.startswith(name + "/")]
        if inside:
            return inside
        numbered = [n for n in everything if n.id.startswith(name + "_")]
        if len(numbered) == 1:
            return numbered
        ids = [n.id for n in everything]
        near = [n.id for n in numbered] or difflib.get_close_matches(name, ids, n=3, cutoff=0.4)
        hint = f"; did you mean {' or '.join(near)}?" if near else "; `loopbook list` shows them"
        raise UsageError(f"no notebook {name!r}{hint}")


def project_at(root: Path) -> Project:
    """The project in a folder that was named: whoever owns it, it is trusted."""
    root = root.resolve()
    src = root / "src"
    return Project(root, root / ".cache", src if src.is_dir() else None)


def find_project(start: Path | None = None) -> Project:
    """The nearest folder upwards that has ``notebooks/``.

    Where none has, the folder itself, without code of its own and with a private cache: for notebooks that belong
    nowhere. Raises UsageError for a project of another user, whose notebooks and modules would run.
    """
    start = (start or Path.cwd()).resolve()
    for folder in (start, *start.parents):
        notebooks = folder / "notebooks"
        if notebooks.is_dir():
            foreign = [path for path in (folder, notebooks) if not owns(path)]
            if foreign:
                raise UsageError(
                    f"{foreign[0]} belongs to another user, whose code its notebooks would run; "
                    f"if you trust it, name it: loopbook --root {folder} ..."
                )
            return project_at(folder)
    return no_project(start)


def no_project(folder: Path, beside: bool = True) -> Project:
    """A folder that is no project: nothing in it is imported, its cache is private. beside: see `Project`."""
    return Project(folder, private_cache(), None, beside)
