"""The reference: one page for each public name, written from `loopbook.TABLE` and the docstrings."""

import inspect
from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from types import ModuleType

from docs_site.docstrings import as_rst

import loopbook

GROUPS = {
    "What is controlled": "loopbook.process",
    "What controls it": "loopbook.controllers",
    "Placing poles": "loopbook.pole_placement",
    "The loop": "loopbook.loop",
    "Responses": "loopbook.response",
    "Tuning": "loopbook.tuning",
    "Experiments": "loopbook.experiments",
    "Records and models": ("loopbook.records", "loopbook.identification"),
    "The rest": "",
}
"""Titles of the reference, with the folders whose names stand under each; the last takes what is left."""


def names() -> dict[str, str]:
    """Every public name and where it is defined: those of ``loopbook`` and of its subject modules."""
    found = dict(loopbook.TABLE)
    for name, place in loopbook.TABLE.items():
        if ":" not in place:
            module = import_module(place)
            found |= {f"{name}.{n}": place for n in sorted(getattr(module, "__all__", ()))}
    return found


def write(folder: Path) -> None:
    """The pages, and reference/index.md that lists them by subject."""
    folder.mkdir(parents=True, exist_ok=True)
    public = names()
    for name in public:
        (folder / f"{name}.rst").write_text(page(name), encoding="utf-8")
    lines = [
        "# Reference",
        "",
        "Every public name, by subject. `import loopbook as lb` gives them all; each has an example that runs.",
        "",
    ]
    left = dict(public)
    for title, folders in GROUPS.items():
        mine = [n for n, place in left.items() if place.startswith(folders)]
        left = {n: p for n, p in left.items() if n not in mine}
        lines += [
            f"## {title}",
            "",
            "| name | |",
            "|---|---|",
            *(f"| [{n}]({n}.rst) | {_first(n)} |" for n in mine),
            "",
        ]
        lines += ["```{toctree}", ":hidden:", "", *mine, "```", ""]
    (folder / "index.md").write_text("\n".join(lines), encoding="utf-8")


def thing(name: str) -> object:
    """What a public name names."""
    found: object = loopbook
    for part in name.split("."):
        found = getattr(found, part)
    return found


def page(name: str) -> str:
    """The page of a public name: how it is called, what it says of itself, what it has."""
    title = f"lb.{name}"
    found = thing(name)
    lines = [title, "=" * len(title), ""]
    if inspect.isclass(found) or callable(found):
        lines += _entry("class" if inspect.isclass(found) else "function", title, found)
    else:
        lines += as_rst((inspect.getdoc(found) or "").splitlines())
    if inspect.isclass(found):
        for kind, member, value in _members(found):
            lines += ["", *_entry(kind, f"{title}.{member}", value)]
    return "\n".join(lines) + "\n"


def _entry(kind: str, title: str, found: object) -> list[str]:
    text = as_rst((inspect.getdoc(found) or "").splitlines())
    called = "" if kind == "property" else _signature(found)
    return [
        f".. py:{kind}:: {title}{called}",
        "",
        *(f"   {line}".rstrip() for line in text),
    ]


def _signature(found: object) -> str:
    try:
        signature = inspect.signature(found)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return "()"
    bare = [
        p.replace(annotation=inspect.Parameter.empty)
        for p in signature.parameters.values()
        if p.name not in ("self", "cls") and not p.name.startswith("_")
    ]
    return str(signature.replace(parameters=bare, return_annotation=inspect.Signature.empty)).replace("\n", " ")


def _members(found: type) -> Iterator[tuple[str, str, object]]:
    """The public methods and properties of a class that say something of themselves, as they are written."""
    seen: Mapping[str, object] = {
        n: v for c in reversed(found.__mro__) if c.__module__.startswith("loopbook") for n, v in vars(c).items()
    }
    for name, value in seen.items():
        if name.startswith("_") or isinstance(value, ModuleType):
            continue
        if isinstance(value, property) or type(value).__name__ == "cached_property":
            kind: str = "property"
        elif callable(getattr(found, name, None)) and not inspect.isclass(value):
            kind, value = "method", getattr(found, name)
        else:
            continue
        if inspect.getdoc(value):
            yield kind, name, value


def _first(name: str) -> str:
    """The first sentence of a docstring, as a table cell."""
    text = (inspect.getdoc(thing(name)) or "").split("\n\n")[0].replace("\n", " ")
    for mark in "\\|*_<>":
        text = text.replace(mark, "\\" + mark)
    return text
