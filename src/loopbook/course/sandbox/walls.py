"""What Linux offers to shut a process in: namespaces, another user; each where the system allows it.

Root becomes another user, one for each notebook. One who is not root gets a user namespace of their own where the
system has these, and stays who they are outside of it: then files that they may read the notebook may read as well, but
for the folders that are hidden.
"""

import ctypes
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

NEW_USER, NEW_MOUNTS, NEW_NETWORK, NEW_PROCESSES, NEW_IPC = 0x10000000, 0x00020000, 0x40000000, 0x20000000, 0x08000000
_PRIVATE, _RECURSIVE, _NO_SUID, _NO_DEVICES, _BIND = 1 << 18, 1 << 14, 2, 4, 1 << 12
_NO_NEW_PRIVILEGES = 38
_MOUNT_SETATTR, _HERE, _ALL_BELOW, _READ_ONLY = 442, -100, 0x8000, 1
FIRST_USER = 61_000
"""The first of the numbers of users that notebooks run as; they are nobody's."""
OTHER_USER, NO_NETWORK, OWN_PROCESSES = "another user", "no network", "own processes"
HIDDEN, UNWRITABLE = "hidden folders", "nothing to write to"
WALLS = (OTHER_USER, NO_NETWORK, HIDDEN, UNWRITABLE, OWN_PROCESSES)
SCRATCH = ("/tmp", "/var/tmp", "/dev/shm")
"""Folders that everybody may write to; a notebook has its own of them, of limited size, and works in the first."""


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _unshare(flags: int) -> bool:
    return sys.platform.startswith("linux") and _libc().unshare(flags) == 0


def separate() -> list[str]:
    """Give this process namespaces of its own, as many as the system allows; what stands. Its children get them too."""
    stands = []
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    if not root and hasattr(os, "getuid"):
        uid, gid = os.getuid(), os.getgid()
        if _unshare(NEW_USER):
            with suppress(OSError):
                Path("/proc/self/setgroups").write_text("deny")
                Path("/proc/self/uid_map").write_text(f"{uid} {uid} 1")
                Path("/proc/self/gid_map").write_text(f"{gid} {gid} 1")
    if _unshare(NEW_NETWORK | NEW_IPC):
        stands.append(NO_NETWORK)
    if _unshare(NEW_MOUNTS) and _mount("none", "/", "", _RECURSIVE | _PRIVATE):
        stands.append(HIDDEN)
    if _unshare(NEW_PROCESSES):
        stands.append(OWN_PROCESSES)
    return stands


def _mount(source: str, target: str, kind: str, flags: int, data: str = "") -> bool:
    found = _libc().mount(source.encode(), target.encode(), kind.encode(), flags, data.encode())
    return bool(found == 0)


def _unwritable() -> bool:
    """Make all that is mounted readable only."""
    attributes = (ctypes.c_uint64 * 4)(_READ_ONLY, 0, 0, 0)
    asked = ctypes.c_long(_MOUNT_SETATTR), _HERE, b"/", _ALL_BELOW, attributes, ctypes.c_size_t(32)
    return bool(_libc().syscall(*asked) == 0)


def hide(folders: Sequence[str], needed: Sequence[str], size: int) -> list[str]:
    """Put an empty file system over each folder, and ones of limited size over those for temporary files.

    needed: folders that stay, wherever they lie: below a hidden one, below /tmp, below one that only its owner may
    enter; they are Python's own. The other way round, what is to be hidden stays hidden below a needed one. Gives what
    stands. Raises OSError where a needed folder cannot be kept.
    """
    stands = [UNWRITABLE] if _unwritable() else []
    closed = [top for path in needed for top in _closed(path)]
    scratch = [os.path.realpath(f) for f in SCRATCH]
    covered = {f for f in (*folders, *closed, *scratch) if os.path.isdir(f) and f != "/"}
    steps = sorted([(f, False) for f in covered] + [(f, True) for f in set(needed)], key=lambda s: (_depth(s[0]), s[1]))
    held = {path: os.open(path, os.O_PATH | os.O_DIRECTORY) for path, keep in steps if keep}
    shut = True
    for path, keep in steps:
        if keep and any(Path(path).is_relative_to(f) for f in covered):
            os.makedirs(path, exist_ok=True)
            if not _mount(f"/proc/self/fd/{held[path]}", path, "", _BIND | _RECURSIVE):
                raise OSError(ctypes.get_errno(), f"{path} cannot be mounted where the notebook runs")
        elif not keep:
            os.makedirs(path, exist_ok=True)
            limits = f"size={size},mode=1777" if path in scratch else "size=64k,mode=0755"
            shut &= _mount("none", path, "tmpfs", _NO_SUID | _NO_DEVICES, limits)
    for file in held.values():
        os.close(file)
    shut &= _mount("none", "/proc", "proc", _NO_SUID | _NO_DEVICES) or _mount("none", "/proc", "tmpfs", 0, "size=64k")
    return [HIDDEN, *stands] if shut else stands


def _depth(path: str) -> int:
    return len(Path(path).parts)


def _closed(path: str) -> list[str]:
    """The topmost folder on the way that others may not enter, if there is one."""
    way = [*reversed(Path(path).parents), Path(path)]
    return [str(f) for f in way if f.is_dir() and not f.stat().st_mode & 0o001][:1]


def enterable(folder: str) -> bool:
    """May every user enter this folder, from the root on?"""
    return os.path.isdir(folder) and not _closed(os.path.realpath(folder))


def become(number: int, own: str) -> bool:
    """Become a user that owns nothing but `own`; False where only root could."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        _no_new_privileges()
        return False
    os.chown(own, FIRST_USER + number, FIRST_USER + number)
    os.setgroups([])
    os.setresgid(*[FIRST_USER + number] * 3)
    os.setresuid(*[FIRST_USER + number] * 3)
    _no_new_privileges()
    return True


def _no_new_privileges() -> None:
    if sys.platform.startswith("linux"):
        _libc().prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0)
