"""Pages that installed packages offer beside the reports, where ``notebooks/book.toml`` asks for them by name.

    pages = ["dial.html"]                                   # in book.toml

    [project.entry-points."notebook_reports.pages"]         # of the package
    "dial.html" = "example.dial:complete"

``complete()`` returns (title, what it is, text): one complete HTML file, which is written below ``reports/`` as it is
and shown on the map. Like a script, a page comes from an installed package, never from the folder one happens to be in.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import EntryPoint, distributions
from importlib.util import find_spec
from pathlib import Path

from notebook_reports.export.scripts import installed_places
from notebook_reports.memory.hashes import hash_file
from notebook_reports.project.project import UsageError

GROUP = "notebook_reports.pages"


@dataclass(frozen=True)
class OfferedPage:
    """A page as it is written. name: of the file below ``reports/``."""

    name: str
    title: str
    about: str
    text: str


def _points(names: Iterable[str]) -> dict[str, tuple[EntryPoint, list[str]]]:
    """The entry point of each name, and the packages that its distribution brings.

    Raises UsageError for one that no package offers.
    """
    found: dict[str, tuple[EntryPoint, list[str]]] = {}
    for distribution in distributions(path=installed_places()):
        for point in distribution.entry_points:
            if point.group == GROUP:
                found[point.name] = (point, (distribution.read_text("top_level.txt") or "").split())
    missing = [name for name in names if name not in found]
    if missing:
        known = f"offered: {', '.join(sorted(found))}" if found else "no package offers one"
        raise UsageError(f"notebooks/book.toml: pages: {', '.join(missing)}: no installed package has it; {known}")
    return {name: found[name] for name in names}


def made(names: Iterable[str], taken: Iterable[str] = ()) -> list[OfferedPage]:
    """The pages. Raises UsageError where a package does not give its page, and for the name of a file that is taken."""
    pages = []
    if twice := sorted({*names} & {*taken}):
        raise UsageError(f"notebooks/book.toml: pages: {', '.join(twice)}: the name of a page of the book itself")
    for name, (point, _) in _points(names).items():
        try:
            pages.append(OfferedPage(name, *point.load()()))
        except Exception as error:
            raise UsageError(f"{name}: {point.value} does not give it ({type(error).__name__}: {error})") from None
    return pages


def print_of(names: Iterable[str]) -> dict[str, str]:
    """What the pages depend on: the files of all the packages that each one's distribution brings; none is imported."""
    prints = {}
    for name, (point, packages) in _points(names).items():
        told = [point.value]
        for package in packages or [point.module.split(".")[0]]:
            spec = find_spec(package)
            folder = Path(spec.origin).parent if spec and spec.origin else None
            files = sorted(p for p in folder.rglob("*") if p.suffix in READ and p.is_file()) if folder else []
            told += [hash_file(path) for path in files]
        prints[name] = sha256("\n".join(told).encode()).hexdigest()[:16]
    return prints


READ = frozenset((".py", ".js", ".css", ".json", ".toml"))
"""Files of a package that its page may be made of."""
