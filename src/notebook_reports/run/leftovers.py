"""Processes that a notebook started and left running: they are ended, and named. On Linux; elsewhere none is known.

A process is a notebook's where it is of its kernel's session, or carries the name of its kernel's private folder among
its variables.
"""

import os
import signal
from contextlib import suppress
from pathlib import Path

PROC = Path("/proc")


def end(private: Path, kernel: int | None) -> list[str]:
    """End what is left of a kernel's processes, not the kernel itself; their command lines.

    private: the kernel's folder, see `surroundings.of_one_kernel`. kernel: its process id, None where it is not known.
    """
    ended = []
    for number in _of(private, kernel):
        command = _command(number)
        if number == kernel or "ipykernel_launcher" in command:
            continue
        with suppress(OSError):
            os.kill(number, signal.SIGKILL)
            ended.append(command)
    return ended


def _of(private: Path, kernel: int | None) -> list[int]:
    me = os.getpid()
    mark = f"IPYTHONDIR={private}{os.sep}".encode()
    found = []
    for entry in PROC.glob("[0-9]*"):
        number = int(entry.name)
        if number == me:
            continue
        try:
            if (kernel and _session(entry) == kernel) or mark in (entry / "environ").read_bytes():
                found.append(number)
        except OSError:
            continue
    return found


def _session(entry: Path) -> int:
    told = (entry / "stat").read_text().rpartition(")")[2].split()
    return 0 if told[0] == "Z" else int(told[3])


def _command(number: int) -> str:
    try:
        words = (PROC / str(number) / "cmdline").read_bytes().split(b"\0")
    except OSError:
        return "a process"
    text = " ".join(os.fsdecode(w) for w in words if w)
    return (text if len(text) <= 60 else text[:59] + "…") or "a process"
