"""Files that are whole or not there: written aside, then renamed; and one builder at a time."""

import errno
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from notebook_reports.project.project import EnvironmentProblem

_UMASK = os.umask(0o077)
os.umask(_UMASK)


def write(path: Path, content: bytes) -> None:
    """Put the content at the path in one step: a reader sees the old file or the new one, never a part.

    Raises EnvironmentProblem, naming the file, where the folder cannot be written or the disk is full; the old
    file, if any, then still stands.
    """
    aside = ""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, aside = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.chmod(aside, 0o666 & ~_UMASK)
        os.replace(aside, path)
    except OSError as error:
        raise EnvironmentProblem(f"cannot write {path}: {error.strerror or error}{_cure(error)}") from None
    finally:
        if aside:
            with suppress(OSError):
                os.unlink(aside)


def _cure(error: OSError) -> str:
    if error.errno == errno.ENOSPC:
        return "; free some space and build again"
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return "; choose another folder with -o DIR"
    return ""


def writable(folder: Path) -> None:
    """Raise EnvironmentProblem where nothing can be written into the folder (made if need be)."""
    probe = folder / ".loopbook-probe"
    write(probe, b"")
    probe.unlink()


def remove(path: Path) -> None:
    """Remove a file; not being there is fine. Raises EnvironmentProblem where it cannot be removed."""
    try:
        path.unlink()
    except (FileNotFoundError, NotADirectoryError):
        return
    except OSError as error:
        raise EnvironmentProblem(f"cannot remove {path}: {error.strerror or error}") from None


def clear(path: Path, also_files: bool = False) -> None:
    """In a cache: remove a folder or a link that stands where a file is to be written; where asked, the file too.

    Raises EnvironmentProblem where that cannot be done.
    """
    try:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        elif path.is_symlink() or (also_files and path.exists()):
            path.unlink()
    except NotADirectoryError:
        pass
    except OSError as error:
        raise EnvironmentProblem(f"cannot remove {path}: {error.strerror or error}") from None


@contextmanager
def only_builder(folder: Path, waiting: Callable[[str], None]) -> Iterator[None]:
    """Hold the folder's build lock; where another build holds it, say so through ``waiting`` and wait for its end.

    The lock belongs to the process and dies with it: there is no stale lock to remove.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        clear(folder / "build.lock")
        file = open(folder / "build.lock", "a+", encoding="utf-8")  # noqa: SIM115
    except OSError as error:
        raise EnvironmentProblem(f"cannot write {folder / 'build.lock'}: {error.strerror or error}") from None
    with file:
        if not _lock(file, wait=False):
            file.seek(0)
            waiting(file.read().strip() or "another build")
            _lock(file, wait=True)
        file.seek(0)
        file.truncate()
        file.write(f"process {os.getpid()}")
        file.flush()
        yield


def _lock(file: IO[str], wait: bool) -> bool:
    if sys.platform == "win32":
        import msvcrt

        try:
            file.seek(0)
            msvcrt.locking(file.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
        except OSError:
            return _lock(file, wait) if wait else False
        return True
    import fcntl

    try:
        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        return False
    return True
