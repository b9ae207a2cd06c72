"""What a notebook reads, noted in its kernel.

Seen: files opened through Python, also by ``sqlite3.connect`` and ``ctypes``; folders listed; files asked for by
``os.stat``, ``os.path.exists`` and all that goes through them; variables read from ``os.environ``; modules. Of other
programs and of the network it is seen that they were asked, not what they answered. Not seen: what code in C opens by
itself and did not ask for before, and variables that it reads.

Bare: the standard library only, and of that little; the process that kernels are forked from imports it too.
"""

import os
import stat
import sys
import tempfile
from collections.abc import Callable
from types import FrameType
from typing import Any

from notebook_reports.run import variables
from notebook_reports.run.callers import ABOUT_KERNELS, caller, installed, package

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
FILE, FOLDER, EXISTS, STAT = "file", "folder", "exists", "stat"
SYSTEM = ("/usr", "/lib", "/lib64", "/bin", "/sbin", "/etc", "/proc", "/sys", "/dev", "/run", "/var/cache")
ASKING = ("genericpath.py", "posixpath.py", "ntpath.py", "pathlib.py", "os.py", "glob.py", "shutil.py", "fnmatch.py")
WHETHER = {"exists", "lexists", "isfile", "isdir", "islink", "is_file", "is_dir", "is_symlink", "realpath", "resolve"}
ABOUT_CODE = ("linecache.py", "inspect.py", "tokenize.py", "traceback.py", "pdb.py", "bdb.py")

read: dict[str, dict] = {}
"""By path, what was asked of it and in which of the cells that ran: {"kinds": {...}, "at": number}."""
written: set[str] = set()
programs: dict[str, int] = {}
network: dict[str, int] = {}
_cells = 0
"""How many cells were begun."""
_root = ""
_own: tuple[str, ...] = ()
_elsewhere: tuple[str, ...] = ()
"""Folders of no interest, below the project and outside of it."""


def begin(shell: Any, root: str) -> None:
    """From now on note what is read."""
    global _root, _own, _elsewhere
    _root = os.path.join(root, "")
    shell.events.register("pre_run_cell", _next_cell)
    kept = [os.environ[n] for n in ("LOOPBOOK_CACHE", "MPLCONFIGDIR") if os.environ.get(n)]
    private = os.path.dirname(os.environ.get("IPYTHONDIR", ""))
    _own = tuple(os.path.join(p, "") for p in (*kept, *(_root + name for name in (".cache", ".venv", ".git"))))
    places = [*kept, private, sys.prefix, sys.base_prefix, *SYSTEM]
    _elsewhere = tuple(os.path.join(p, "") for p in places if p and os.path.dirname(p) != p)
    sys.addaudithook(_hook)
    _ask_through("stat", "lstat", "access")
    variables.watch()


def _next_cell(*_: object) -> None:
    global _cells
    _cells += 1


def _count() -> int:
    return _cells


def _hook(event: str, args: tuple) -> None:
    note = _EVENTS.get(event)
    if note is not None:
        note(args)


def _path(value: Any) -> str:
    """The absolute path, "" for what is none or is of no interest."""
    try:
        path = os.fspath(value)
    except TypeError:
        return ""
    path = os.path.abspath(os.fsdecode(path))
    of_no_interest = path.startswith(_own if path.startswith(_root) else _elsewhere)
    return "" if of_no_interest or installed(path) else path


def _note(path: str, kind: str) -> None:
    read.setdefault(path, {"kinds": set(), "at": _count()})["kinds"].add(kind)


def _is_own(path: str) -> bool:
    """Did the notebook make it, or a folder above it?"""
    while path not in written:
        above = os.path.dirname(path)
        if above == path:
            return False
        path = above
    return True


def _opened(args: tuple) -> None:
    path = _path(args[0])
    if not path or _importing():
        return
    mode, flags = args[1] or "", args[2] or 0
    writes = bool(set(mode) & set("wax+")) or (not mode and bool(flags & WRITING))
    reads = not writes or ("+" in mode and "w" not in mode and "x" not in mode)
    if reads and not _is_own(path):
        _note(path, FILE)
    if writes and path not in read:
        written.add(path)


def _listed(args: tuple) -> None:
    path = _path(args[0] if args[0] is not None else ".")
    if path and not _importing() and not _is_own(path) and f"{os.sep}importlib{os.sep}" not in caller(ASKING):
        _note(path, FOLDER)


def _connected(args: tuple) -> None:
    """A database: its file, read if it was there before; writing it later shows, as the file then changes."""
    name = os.fsdecode(args[0]) if isinstance(args[0], str | bytes | os.PathLike) else ""
    if name.startswith("file:"):
        name = name[5:].partition("?")[0]
    path = _path(name) if name and name != ":memory:" else ""
    if path and not _is_own(path):
        if _status(path) is not None:
            _note(path, FILE)
        else:
            written.add(path)


def _made_folder(args: tuple) -> None:
    if path := _path(args[0]):
        written.add(path)


def _ran(args: tuple) -> None:
    """A program, where the notebook or its own modules run it; what libraries run about the machine is theirs."""
    if installed(caller(("subprocess.py", "os.py"))):
        return
    command = args[1] if len(args) > 1 and args[1] else args[0]
    words = command if isinstance(command, list | tuple) else [command]
    program(" ".join(os.fsdecode(w) if isinstance(w, str | bytes | os.PathLike) else str(w) for w in words))


def program(command: str) -> None:
    """Note a command of a shell or a program run."""
    told = " ".join(command.split())
    programs.setdefault(told if len(told) <= 60 else told[:59] + "…", _count())


def _reached(args: tuple) -> None:
    address = args[1] if len(args) > 1 else None
    if isinstance(address, tuple) and address and address[0] not in ("127.0.0.1", "::1", "localhost"):
        network.setdefault(str(address[0]), _count())


def _asked_for(args: tuple) -> None:
    host = args[0]
    if isinstance(host, str) and host not in ("", "localhost"):
        network.setdefault(host, _count())


_EVENTS = {
    "open": _opened,
    "os.listdir": _listed,
    "os.scandir": _listed,
    "os.mkdir": _made_folder,
    "sqlite3.connect": _connected,
    "ctypes.dlopen": lambda args: _opened((args[0] or os.devnull, "r", 0)),
    "subprocess.Popen": _ran,
    "os.system": _ran,
    "os.posix_spawn": _ran,
    "os.exec": _ran,
    "os.fork": lambda args: program("a process of its own"),
    "socket.connect": _reached,
    "socket.getaddrinfo": _asked_for,
}


def _importing() -> bool:
    """Is the import system at work? What is imported is known from sys.modules."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and frame.f_code.co_filename == __file__:
        frame = frame.f_back
    return frame is not None and frame.f_code.co_filename.startswith("<frozen importlib")


_real: dict = {}


def _ask_through(*names: str) -> None:
    """Let every question for a file be noted before it is answered."""
    for name in names:
        original = _real[name] = getattr(os, name)
        noting = _noting(name, original)
        setattr(os, name, noting)
        for able in (os.supports_fd, os.supports_dir_fd, os.supports_follow_symlinks, os.supports_effective_ids):
            if original in able:
                able.add(noting)


def _noting(name: str, original: Callable[..., Any]) -> Callable[..., Any]:
    def ask(path: Any, *args: Any, **kwargs: Any) -> Any:
        if isinstance(path, str | os.PathLike) and not kwargs.get("dir_fd"):
            _asked(path, name)
        return original(path, *args, **kwargs)

    ask.__name__, ask.__doc__ = name, original.__doc__
    return ask


def _asked(value: Any, name: str) -> None:
    path = _path(value)
    if not path or _is_own(path) or _root.startswith(os.path.join(path, "")) or os.path.join(path, "") in _own:
        return
    by = caller(ASKING)
    if os.path.basename(by) in ABOUT_CODE or by.startswith("<frozen importlib"):
        return
    if installed(by):
        if package(by) not in ABOUT_KERNELS and not by.startswith(os.path.dirname(os.__file__)):
            _note(path, EXISTS)
            found = _status(path)
            if found is not None and stat.S_ISREG(found.st_mode):
                _note(path, FILE)  # a library in C asks and then reads by itself
        return
    _note(path, EXISTS if name == "access" or _asks_whether() else STAT)


def _asks_whether() -> bool:
    """Does the question come from one that is answered by yes or no, or by a path?"""
    frame: FrameType | None = sys._getframe(3)
    while frame is not None and ("pathlib" in frame.f_code.co_filename or frame.f_code.co_filename[:7] == "<frozen"):
        if frame.f_code.co_name in WHETHER:
            return True
        frame = frame.f_back
    return False


def _status(path: str) -> os.stat_result | None:
    try:
        return _real["stat"](path)
    except OSError:
        return None


def report() -> dict[str, object]:
    """Modules by file; what was read, by path; variables, programs and hosts, each without what the notebook itself
    set or made before."""
    files = {getattr(m, "__file__", None) for m in list(sys.modules.values())}
    return {
        "modules": sorted(f for f in files if isinstance(f, str) and os.path.isabs(f) and not _is_foreign(f)),
        "read": {path: {"kinds": sorted(told["kinds"]), "at": told["at"]} for path, told in read.items()},
        "variables": sorted(variables.read),
        "programs": sorted(programs.items()),
        "network": sorted(network.items()),
    }


def _is_foreign(filename: str) -> bool:
    """Is a module's file no source of the project: installed, or made by the notebook for itself?"""
    return installed(filename) or filename.startswith(tempfile.gettempdir() + os.sep + "ipykernel_")
