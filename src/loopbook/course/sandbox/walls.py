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
_PRIVATE, _RECURSIVE, _NO_SUID, _NO_DEVICES, _BIND, _MOVE = 1 << 18, 1 << 14, 2, 4, 1 << 12, 1 << 13
_NO_NEW_PRIVILEGES = 38
FIRST_USER = 61_000
"""The first of the numbers of users that notebooks run as; they are nobody's."""
WALLS = ("another user", "no network", "own processes", "hidden folders")


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
        stands.append("no network")
    if _unshare(NEW_MOUNTS) and _mount("none", "/", "", _RECURSIVE | _PRIVATE):
        stands.append("hidden folders")
    if _unshare(NEW_PROCESSES):
        stands.append("own processes")
    return stands


def _mount(source: str, target: str, kind: str, flags: int, data: str = "") -> bool:
    found = _libc().mount(source.encode(), target.encode(), kind.encode(), flags, data.encode())
    return bool(found == 0)


def hide(folders: Sequence[str], needed: Sequence[str], own: str, size: int) -> None:
    """Put an empty file system over each folder, and one of limited size over the folder for temporary files.

    needed: folders that stay, where they lie in a hidden one or in one that only its owner may enter: Python's own.
    own: the notebook's folder, made anew.
    """
    closed = {top for path in needed for top in _closed(path)}
    covered = [f for f in dict.fromkeys([*folders, *sorted(closed)]) if os.path.isdir(f)]
    stage = "/tmp"
    _mount("none", stage, "tmpfs", _NO_SUID | _NO_DEVICES, f"size={size},mode=1777")
    kept = [p for p in needed if any(Path(p).is_relative_to(f) for f in covered)]
    for number, path in enumerate(kept):
        os.makedirs(f"{stage}/.kept{number}")
        _mount(path, f"{stage}/.kept{number}", "", _BIND | _RECURSIVE)
    for folder in covered:
        _mount("none", folder, "tmpfs", _NO_SUID | _NO_DEVICES, "size=64k,mode=0755")
    for number, path in enumerate(kept):
        os.makedirs(path, exist_ok=True)
        _mount(f"{stage}/.kept{number}", path, "", _MOVE)
        os.rmdir(f"{stage}/.kept{number}")
    os.makedirs(own, exist_ok=True)
    _mount("none", "/proc", "proc", _NO_SUID | _NO_DEVICES)


def _closed(path: str) -> list[str]:
    """The topmost folder on the way that others may not enter, if there is one."""
    way = [*reversed(Path(path).parents), Path(path)]
    return [str(f) for f in way if f.is_dir() and not f.stat().st_mode & 0o001][:1]


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
