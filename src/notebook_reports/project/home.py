"""The user's folder and the private ones: known to be the user's own, readable by nobody else."""

import atexit
import os
import shutil
import stat
import tempfile
from contextlib import suppress
from pathlib import Path

NAME = "loopbook"


def user() -> int | None:
    """Who runs this, as a number; None where the system has no such numbers."""
    return os.geteuid() if hasattr(os, "geteuid") else None


def owns(path: Path) -> bool:
    """Is the file or folder the user's own? One who became root by sudo owns what was theirs before."""
    me = user()
    if me is None:
        return True
    try:
        owner = path.stat().st_uid
    except OSError:
        return False
    return owner == me or (me == 0 and os.environ.get("SUDO_UID") == str(owner))


def home() -> Path | None:
    """The user's home; None where neither HOME nor the list of users knows one."""
    try:
        found = Path.home()
    except (RuntimeError, KeyError):
        return None
    return found if found.is_absolute() else _of_the_list_of_users()


def _of_the_list_of_users() -> Path | None:
    try:
        import pwd

        found = Path(pwd.getpwuid(os.getuid()).pw_dir)
    except (ImportError, KeyError):
        return None
    return found if found.is_absolute() else None


def private(folder: Path) -> bool:
    """Is it a folder of the user's own, no link, into which nobody else can write?"""
    try:
        found = folder.lstat()
    except OSError:
        return False
    own = user() is None or found.st_uid == user()
    return stat.S_ISDIR(found.st_mode) and own and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def private_cache() -> Path:
    """The folder for what is kept between runs outside of any project: the user's own cache, else a fresh one.

    One that exists and is not private is not used: what lies in it may be another user's.
    """
    base = os.environ.get("XDG_CACHE_HOME") or (h / ".cache" if (h := home()) else "")
    if base and Path(base).is_absolute():
        folder = Path(base) / NAME
        with suppress(OSError):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if private(folder) and os.access(folder, os.W_OK):
                return folder
    folder = Path(tempfile.mkdtemp(prefix=f"{NAME}-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder
