"""The order of the book: notebooks/book.toml names its parts, the manifest the notebooks in each.

title = "PID control and pole placement, recomputed"
subtitle = "Three documents, and every number in them"
code = "inline"                # or "end" (of each chapter), or "none"
picture = { notebook = "pid_report/01_terms", figure = 1 }   # of the front page
pages = ["dial.html"]          # that an installed package offers, see `pages.offered`

[[part]]
folder = "pid_report"          # of notebooks/
title = "A report on the PID controller"
about = "How it works, how it is programmed, how it is tuned."
order = ["introduction"]       # notebooks that come first; the others follow by their names

[[part.find]]                  # what the part found, with the entry of the ledger that shows it
says = "Its tracking gain divides by the wrong time constant."
misprint = "eq-4.4"            # or claim, or value
verdict = "proved"
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from notebook_reports.project.project import Project, UsageError
from notebook_reports.project.toml import TomlError, read_toml, tables

FILE = "book.toml"
CODE = ("inline", "end", "none")
ENTRIES = ("value", "claim", "misprint")
Entry = Mapping[str, Any]


@dataclass(frozen=True)
class Find:
    """One thing found, in words. table, id, verdict: the entry of the ledger that shows it."""

    says: str
    table: str
    id: str
    verdict: str


@dataclass(frozen=True)
class Part:
    """One part. entries: of the manifest, in order. finds: for the front page."""

    folder: str
    title: str
    about: str
    entries: tuple[Entry, ...]
    finds: tuple[Find, ...] = ()


@dataclass(frozen=True)
class Outline:
    """The whole book. code: where that of each chapter stands. picture: (notebook, number of its figure), or none."""

    title: str
    subtitle: str
    parts: tuple[Part, ...]
    code: str = "inline"
    picture: tuple[str, int] | None = None
    pages: tuple[str, ...] = ()

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
        finds = [_finds(p, where) for p in tables(content, "part", where)]
        orders = [p.get("order", []) for p in tables(content, "part", where)]
        title, subtitle, code = content["title"], content.get("subtitle", ""), content.get("code", CODE[0])
    except TomlError as error:
        raise UsageError(str(error)) from None
    except KeyError as error:
        raise UsageError(f"{where}: {error.args[0]} is missing") from None
    if not named:
        raise UsageError(f"{where}: part is missing")
    if not all(isinstance(word, str) for word in (title, subtitle, *(w for part in named for w in part))):
        raise UsageError(f"{where}: title, subtitle, and of each part folder, title and about are texts in quotes")
    if code not in CODE:
        raise UsageError(f"{where}: code is one of {', '.join(CODE)}, got {code!r}")
    folders = [folder for folder, _, _ in named]
    wrong = [f"notebooks/{e['id']}.ipynb is in no part of {where}" for e in entries if e["folder"] not in folders]
    wrong += [f"{where}: two parts for {folder}" for folder in {f for f in folders if folders.count(f) > 1}]
    held = {e["folder"] for e in entries}
    wrong += [f"{where}: no notebook in notebooks/{folder}" for folder in folders if folder not in held]
    if wrong:
        raise UsageError("; ".join(sorted(wrong)))
    parts = [
        Part(*named_part, _ordered([e for e in entries if e["folder"] == named_part[0]], order), found)
        for named_part, found, order in zip(named, finds, orders, strict=True)
    ]
    picture = _picture(content.get("picture"), entries, where)
    return Outline(title, subtitle, tuple(parts), code, picture, pages_of(project))


def _ordered(entries: Sequence[Entry], order: Any) -> tuple[Entry, ...]:
    """The entries that are named first, then the others. Raises UsageError for a name that is none of them."""
    names = [str(entry["id"]).rpartition("/")[2] for entry in entries]
    wrong = [name for name in order if name not in names] if isinstance(order, list) else ["which is no list"]
    if wrong:
        raise UsageError(f"notebooks/{FILE}: order names {', '.join(map(str, wrong))}; there are {', '.join(names)}")
    place = {name: i for i, name in enumerate(order)}
    return tuple(sorted(entries, key=lambda e: place.get(str(e["id"]).rpartition("/")[2], len(place))))


def _finds(part: dict[str, Any], where: str) -> tuple[Find, ...]:
    """What a part found. Raises TomlError."""
    found = []
    for one in tables(part, "find", where):
        named = [table for table in ENTRIES if table in one]
        texts = [one.get("says"), one.get("verdict"), *(one[table] for table in named)]
        if len(named) != 1 or not all(isinstance(text, str) and text for text in texts):
            wanted = f"says, verdict and one of {', '.join(ENTRIES)}, each a text"
            raise TomlError(f"{where}: a find has {wanted}; got {one}")
        found.append(Find(one["says"], named[0], one[named[0]], one["verdict"]))
    return tuple(found)


def _picture(told: Any, entries: Sequence[Entry], where: str) -> tuple[str, int] | None:
    if told is None:
        return None
    name, number = (told.get("notebook"), told.get("figure")) if isinstance(told, Mapping) else (None, None)
    if not isinstance(name, str) or type(number) is not int or number < 1:
        raise UsageError(f'{where}: picture is {{ notebook = "folder/name", figure = 1 }}, got {told!r}')
    if name not in [e["id"] for e in entries]:
        raise UsageError(f"{where}: the picture is of notebooks/{name}.ipynb, which is not there")
    return name, number


def pages_of(project: Project) -> tuple[str, ...]:
    """The names of the pages that the book asks packages for. Raises UsageError for what are no names of HTML files."""
    where = f"notebooks/{FILE}"
    try:
        names = read_toml(project.notebooks_folder / FILE, where).get("pages", [])
    except TomlError as error:
        raise UsageError(str(error)) from None
    plain = isinstance(names, list) and all(isinstance(n, str) and re.fullmatch(r"[\w-]+\.html", n) for n in names)
    if not plain:
        raise UsageError(f'{where}: pages = {names!r}: names of files such as "dial.html" are expected')
    return tuple(names)
