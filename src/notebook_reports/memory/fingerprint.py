"""What a report depends on, as named hashes, so that a build can say why it rebuilds.

Two fingerprints: of the run (code cells, parameters, every module and file the kernel used, the environment, the code
that runs notebooks) and of the export (the executed content, the prose, the exporters, their templates). What the
kernel used is known from the last run itself: it cannot use another file without one of these having changed.
"""

import json
import os
import sys
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from notebook_reports.project.project import Project
from notebook_reports.project.source import Source

PRESS = Path(__file__).parents[1]
RUNS = ("run", "project/parameters.py", "project/ranges.py", "project/source.py")
EXPORTS = ("export", "mathematics", "display.py")
PAGES = (*EXPORTS, "pages", "ledger")
Prints = dict[str, str]


def _sha(content: bytes) -> str:
    return sha256(content).hexdigest()[:16]


@cache
def _hash_file(path: str, _changed: int) -> str:
    return _sha(Path(path).read_bytes())


def hash_file(path: Path) -> str:
    """The hash of a file, "" where there is none."""
    try:
        return _hash_file(str(path), path.stat().st_mtime_ns)
    except OSError:
        return ""


def hash_folder(path: Path) -> str:
    """The hash of the names in a folder, "" where there is none."""
    try:
        names = sorted(n for n in os.listdir(path) if not n.startswith((".", "__pycache__")))
    except OSError:
        return ""
    return _sha("\n".join(names).encode())


def _tree(folder: Path) -> list[Path]:
    return sorted(p for p in folder.rglob("*") if p.is_file() and p.suffix != ".pyc")


def environment(project: Project) -> Prints:
    """The interpreter, the locked environment and what is installed."""
    site = next((p for p in sys.path if p.endswith("site-packages") and os.path.isdir(p)), "")
    installed = sorted(n for n in os.listdir(site) if n.endswith(".dist-info")) if site else []
    return {
        "Python": sys.version.split()[0],
        "environment.txt": hash_file(project.root / "environment.txt"),
        "the installed packages": _sha("\n".join(installed).encode()),
    }


def of_run(project: Project, source: Source, used: Iterable[str], since: int | None = None) -> Prints:
    """What the run of a notebook depends on.

    used: the files and folders of the last run, see `used_by`. since: when the run began, in ns; a file that was
    changed later was perhaps read before, so its hash is not taken and the next build runs the notebook again.
    """
    prints = {"its code": source.hash_code(), **environment(project)}
    prints |= _press(RUNS)
    for name in used:
        path = project.root / name  # an absolute name stays absolute
        if name.endswith("/"):
            prints[name] = hash_folder(path)
        elif since is not None and path.exists() and path.stat().st_mtime_ns > since:
            prints[name] = "changed during the run"
        else:
            prints[name] = hash_file(path)
    return prints


def used_by(project: Project, source: Source, depends: dict[str, Any]) -> list[str]:
    """From a kernel's report the files and folders to watch, named relative to the project; without the pipeline
    itself, whose parts `RUNS` and `EXPORTS` name."""
    names = set()
    for text in depends.get("modules", ()):
        path = Path(text)
        first_party = path.is_relative_to(project.root) or path.is_relative_to(PRESS.parent)
        if first_party and not (path.is_relative_to(PRESS) and _named(path, (*RUNS, *EXPORTS))):
            names.add(_name(project, path))
    for text, kind in depends.get("read", {}).items():
        path = Path(text)
        if path == source.path or path.is_relative_to(project.cache) or path.is_relative_to(PRESS):
            continue
        if "__pycache__" not in path.parts:
            names.add(_name(project, path) + ("/" if kind == "folder" else ""))
    return sorted(names)


def of_export(source: Source, ran: str, engine: str, format: str) -> Prints:
    """What an exported report depends on. ran: the hash of the executed content."""
    prints = {"its text": source.hash_all(), "its results": ran}
    if format == "ipynb":
        return prints
    prints["the engine"] = engine
    prints |= _press(EXPORTS)
    for name in _pictures(source):
        prints[name] = hash_file(source.path.parent / name)
    return prints


def of_pages() -> Prints:
    """The code that the pages made of all notebooks depend on."""
    return _press(PAGES)


def _press(parts: Iterable[str]) -> Prints:
    """Parts of the press, files or folders."""
    files = [path for part in parts for path in (_tree(PRESS / part) if (PRESS / part).is_dir() else [PRESS / part])]
    return {path.relative_to(PRESS.parent).as_posix(): hash_file(path) for path in files}


def _named(path: Path, parts: Iterable[str]) -> bool:
    return any(path.is_relative_to(PRESS / part) for part in parts)


def _pictures(source: Source) -> list[str]:
    import re

    found = set()
    for cell in source.cells:
        if cell.kind == "markdown" and "](" in cell.text:
            found |= set(re.findall(r"!\[[^\]]*\]\(([^)\s:]+)", cell.text))
    return sorted(found)


def differences(old: Prints | None, new: Prints) -> list[str]:
    """Why: the names of what changed, appeared or went, the notebook's own first.

    >>> differences({"its code": "a", "src/x.py": "b"}, {"its code": "a", "src/x.py": "c"})
    ['src/x.py']
    """
    if old is None:
        return ["first build"]
    names = [n for n in {**old, **new} if old.get(n) != new.get(n)]
    if "Python" in names and old.get("Python") and new.get("Python"):
        names[names.index("Python")] = f"Python {old['Python']} -> {new['Python']}"
    return sorted(names, key=lambda n: (not n.startswith("its "), n))


def _name(project: Project, path: Path) -> str:
    return path.relative_to(project.root).as_posix() if path.is_relative_to(project.root) else path.as_posix()


def digest(value: Any) -> str:
    """The hash of plain data."""
    return _sha(json.dumps(value, sort_keys=True).encode())
