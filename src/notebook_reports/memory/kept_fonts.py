"""The list of fonts that matplotlib keeps between runs: it decides what figures look like, so it is not believed.

After every build the content of its folder is noted; a folder that is not as it was noted is made again.
"""

import shutil
from pathlib import Path

from notebook_reports.memory import sealed
from notebook_reports.memory.hashes import hash_now

FOLDER, NOTE = "matplotlib", "matplotlib.json"


def check(cache: Path) -> str:
    """Remove the folder where it is not as it was noted; what is to be said of it, or ""."""
    folder = cache / FOLDER
    if not folder.exists():
        return ""
    try:
        noted = sealed.read(cache / NOTE)
    except sealed.Damaged:
        noted = {}
    if noted == _content(folder):
        return ""
    shutil.rmtree(folder, ignore_errors=True)
    return "" if noted is None else f"{folder} was changed; matplotlib lists the fonts again"


def note(cache: Path) -> None:
    """Write down what is in the folder."""
    folder = cache / FOLDER
    if folder.is_dir():
        sealed.write(cache / NOTE, _content(folder))


def _content(folder: Path) -> dict[str, str]:
    files = sorted(p for p in folder.rglob("*") if p.is_file() and not p.name.endswith(".matplotlib-lock"))
    return {p.relative_to(folder).as_posix(): hash_now(p) for p in files}
