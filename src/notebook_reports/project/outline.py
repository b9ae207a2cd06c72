"""The order of the book: notebooks/book.toml names its parts, the manifest the notebooks in each.

title = "PID control and pole placement, recomputed"
subtitle = "Three documents, and every number in them"

[[part]]
folder = "pid_report"          # of notebooks/
title = "A report on the PID controller"
about = "How it works, how it is programmed, how it is tuned."
order = ["introduction"]       # notebooks that come first; the others follow by their names
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from notebook_reports.project.project import Project, UsageError
from notebook_reports.project.toml import TomlError, read_toml, tables

FILE = "book.toml"
Entry = Mapping[str, Any]


@dataclass(frozen=True)
class Part:
    """One part. entries: of the manifest, in order."""

    folder: str
    title: str
    about: str
    entries: tuple[Entry, ...]


@dataclass(frozen=True)
class Outline:
    """The whole book."""

    title: str
    subtitle: str
    parts: tuple[Part, ...]

    @property
    def entries(self) -> list[Entry]:
        """All notebooks, in the order of the book."""
        return [entry for part in self.parts for entry in part.entries]


def read_outline(project: Project, entries: Sequence[Entry]) -> Outline:
    """Put the manifest's entries into the parts.

    Raises UsageError for a file that cannot be read, a notebook that no part lists and a part without notebooks; each
    by its name.
    """
    path = project.notebooks_folder / FILE
    where = f"notebooks/{FILE}"
    try:
        content = read_toml(path, where)
        named = [(p["folder"], p["title"], p.get("about", "")) for p in tables(content, "part", where)]
        title, subtitle = content["title"], content.get("subtitle", "")
    except TomlError as error:
        raise UsageError(str(error)) from None
    except KeyError as error:
        raise UsageError(f"{where}: {error.args[0]} is missing") from None
    if not named:
        raise UsageError(f"{where}: part is missing")
    if not all(isinstance(word, str) for word in (title, subtitle, *(w for part in named for w in part))):
        raise UsageError(f"{where}: title, subtitle, and of each part folder, title and about are texts in quotes")
    folders = [folder for folder, _, _ in named]
    wrong = [f"notebooks/{e['id']}.ipynb is in no part of {where}" for e in entries if e["folder"] not in folders]
    wrong += [f"{where}: two parts for {folder}" for folder in {f for f in folders if folders.count(f) > 1}]
    held = {e["folder"] for e in entries}
    wrong += [f"{where}: no notebook in notebooks/{folder}" for folder in folders if folder not in held]
    if wrong:
        raise UsageError("; ".join(sorted(wrong)))
    orders = {part["folder"]: part.get("order", []) for part in tables(content, "part", where)}
    parts = [Part(*told, _ordered([e for e in entries if e["folder"] == told[0]], orders[told[0]])) for told in named]
    return Outline(title, subtitle, tuple(parts))


def _ordered(entries: Sequence[Entry], order: Any) -> tuple[Entry, ...]:
    """The entries that are named first, then the others. Raises UsageError for a name that is none of them."""
    names = [str(entry["id"]).rpartition("/")[2] for entry in entries]
    wrong = [name for name in order if name not in names] if isinstance(order, list) else ["which is no list"]
    if wrong:
        raise UsageError(f"notebooks/{FILE}: order names {', '.join(map(str, wrong))}; there are {', '.join(names)}")
    place = {name: i for i, name in enumerate(order)}
    return tuple(sorted(entries, key=lambda e: place.get(str(e["id"]).rpartition("/")[2], len(place))))
