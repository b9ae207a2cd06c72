"""The private folder of this process among the temporary files: 0700, a random name, gone at the end.

The process holds a lock in it. What a killed process left, nobody locks: the next one removes it.
"""

import atexit
import os
import shutil
import tempfile
import threading
from contextlib import suppress
from pathlib import Path
from typing import IO

from notebook_reports.project.home import private

PREFIX, UNLOCKED = "lb-", "lbx-"
LOCK = "lock"
LONGEST = 60
"""Characters of the folder for temporary files; below a longer one a socket's path, of about a hundred, has no room."""

_making = threading.Lock()
_held: tuple[Path, IO[bytes], int] | None = None


def folder() -> Path:
    """The folder; made when it is first asked for, and then also those of killed processes are removed."""
    with _making:
        base = _base()
        if _held and _held[0].parent == base and _held[0].is_dir() and _held[2] == os.getpid():
            return _held[0]
        sweep(base)
        return _make(base)


def _make(base: Path) -> Path:
    global _held
    made = Path(tempfile.mkdtemp(prefix=UNLOCKED, dir=base))
    lock = open(made / LOCK, "wb")  # noqa: SIM115 (it is held as long as the process)
    _lock(lock)
    final = made.with_name(PREFIX + made.name[len(UNLOCKED) :])
    made.rename(final)
    _held = (final, lock, os.getpid())
    atexit.register(_remove, final, os.getpid())
    return final


def make(prefix: str = "") -> Path:
    """A fresh folder in it."""
    return Path(tempfile.mkdtemp(prefix=prefix, dir=folder()))


def tidy() -> None:
    """Remove the folder where nothing is in it any more."""
    global _held
    if _held and _held[2] == os.getpid() and [p.name for p in _entries(_held[0])] in ([], [LOCK]):
        path, lock, _ = _held
        _held = None
        shutil.rmtree(path, ignore_errors=True)
        lock.close()


def sweep(base: Path) -> None:
    """Remove the folders whose processes are gone."""
    for found in base.glob(f"{PREFIX}*"):
        if not private(found):
            continue
        with suppress(OSError), open(found / LOCK, "rb") as lock:
            if _lock(lock):
                shutil.rmtree(found, ignore_errors=True)


def _base() -> Path:
    usual = tempfile.gettempdir()
    return Path(usual if len(usual) < LONGEST else "/tmp")


def _entries(path: Path) -> list[Path]:
    try:
        return sorted(path.iterdir())
    except OSError:
        return []


def _remove(path: Path, owner: int) -> None:
    if os.getpid() == owner:  # a forked child must not remove what its parent still uses
        shutil.rmtree(path, ignore_errors=True)


def _lock(file: IO[bytes]) -> bool:
    """Take the lock; False where another process has it, or where there are no such locks."""
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (ImportError, OSError):
        return False
    return True
