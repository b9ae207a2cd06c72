"""What a report depends on, as named hashes, so that a build can say why it rebuilds.

Two fingerprints: of the run (code cells, parameters, every module and file the kernel used, the environment, the code
that runs notebooks) and of the export (the executed content, the prose, the exporters, their templates). What the
kernel used is known from the last run itself: it cannot use another file without one of these having changed.
"""

import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from notebook_reports.display import EQUATION_MIME, FIGURE_MIME, TABLE_MIME
from notebook_reports.export import scripts
from notebook_reports.ledger.verdicts import CHECKS_MIME
from notebook_reports.memory.hashes import hash_file, of_bytes
from notebook_reports.memory.inputs import Input
from notebook_reports.project.project import Project
from notebook_reports.project.source import Source
from notebook_reports.run.masks import home_shown

if TYPE_CHECKING:
    from notebook_reports.memory.stamps import Stamp

PRESS = Path(__file__).parents[1]
RUNS = ("run", "project/parameters.py", "project/ranges.py", "project/source.py")
WRITES = ("export", "mathematics")
"""Of these a kernel may load a module, for a message's words; what it computes is not theirs."""
EXPORTS = (*WRITES, "display.py")
PAGES = (*EXPORTS, "pages", "ledger")
OWN = {TABLE_MIME, FIGURE_MIME, EQUATION_MIME, CHECKS_MIME, "application/json"}
MARKUP = ("text/html", "text/markdown")
Prints = dict[str, str]
_SHOWN = re.compile(r"""\]\(\s*<?([^)\s>]+)|\bsrc\s*=\s*["']?([^"'\s>]+)""")


def _tree(folder: Path) -> list[Path]:
    return sorted(p for p in folder.rglob("*") if p.is_file() and p.suffix != ".pyc")


def environment(project: Project) -> Prints:
    """The interpreter, the locked environment, what is installed, and a home that outputs show as it is."""
    site = next((p for p in sys.path if p.endswith("site-packages") and os.path.isdir(p)), "")
    installed = sorted(n for n in os.listdir(site) if n.endswith(".dist-info")) if site else []
    return {
        "Python": sys.version.split()[0],
        "environment.txt": hash_file(project.root / "environment.txt"),
        "the installed packages": of_bytes("\n".join(installed).encode()),
        "the home folder": home_shown(),
    }


def of_run(project: Project, source: Source, used: Iterable[Input], since: int | None = None) -> Prints:
    """What the run of a notebook depends on.

    used: what the last run read, and what the notebook declares. since: when the run began, in ns; a file that was
    changed later was perhaps read before, so its hash is not taken and the next build runs the notebook again.
    """
    prints = {"its code": source.hash_code(), **environment(project), **_press(RUNS)}
    return {**prints, **{one.label: one.print(project, since) for one in used}}


def of_export(source: Source, stamp: "Stamp", format: str, place: str) -> Prints:
    """What an exported report depends on. stamp: of the run whose results it shows. place: in the book, as a print."""
    prints = {"its text": source.hash_all(), "its results": stamp.results}
    if format == "ipynb":
        return prints
    prints |= {"its place in the book": place, **_press(EXPORTS)}
    if stamp.mimes:
        prints["its scripts"] = scripts.print_of(stamp.mimes)
    return {**prints, **{name: hash_file(source.path.parent / unquote(name)) for name in stamp.pictures}}


def of_pages() -> Prints:
    """The code that the pages made of all notebooks depend on."""
    return _press(PAGES)


def _press(parts: Iterable[str]) -> Prints:
    """Parts of the press, files or folders."""
    files = [path for part in parts for path in (_tree(PRESS / part) if (PRESS / part).is_dir() else [PRESS / part])]
    return {path.relative_to(PRESS.parent).as_posix(): hash_file(path) for path in files}


def pictures(content: dict[str, Any]) -> list[str]:
    """The files that an executed notebook's text and outputs show, as they name them."""
    found: set[str] = set()
    for cell in content["cells"]:
        texts = [cell["source"]] if cell["cell_type"] != "code" else []
        for output in cell.get("outputs", ()):
            texts += [t for mime in MARKUP if isinstance(t := output.get("data", {}).get(mime), str)]
        found |= {name for text in texts for pair in _SHOWN.findall(text) for name in pair if name}
    return sorted(name for name in found if not re.match(r"[A-Za-z][A-Za-z0-9+.-]+:|//|#", name))


def mimes(content: dict[str, Any]) -> list[str]:
    """The forms of an executed notebook's outputs that are neither text, nor pictures, nor the press's own."""
    found = {m for cell in content["cells"] for output in cell.get("outputs", ()) for m in output.get("data", ())}
    return sorted(m for m in found - OWN if not m.startswith(("text/", "image/")))


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
