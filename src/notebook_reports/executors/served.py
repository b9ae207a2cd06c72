"""A process that does jobs for another: on a machine of a cluster, in the surroundings of every kernel, within a time.

    python -P -m notebook_reports.executors.served [MODULE...]

imports the modules, reads pickled (function, job) and writes pickled results; who starts it is who it works for.
"""

import atexit
import os
import pickle
import select
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

from notebook_reports.errors import PressError
from notebook_reports.executors.executor import surroundings

LENGTH = struct.Struct(">Q")
READY = b"ready"
STARTING = 120.0
"""Seconds that its imports may take; they are not the job's."""


class Ended(PressError):
    """The process ended before its job was done."""


class Served:
    """One such process, started when it is first needed and again after it was ended. preloaded: what it imports."""

    def __init__(self, preloaded: Sequence[str] = ()) -> None:
        self._preloaded = preloaded
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()
        atexit.register(self.end)

    def do(self, function: Callable[[Any], Any], job: Any, seconds: float) -> Any:
        """What function(job) gives, or raises. Raises TimeoutError after so many seconds, and Ended."""
        with self._lock:
            try:
                process = self._started()
                return self._done(process, pickle.dumps((function, job)), time.monotonic() + seconds)
            except TimeoutError:
                self.end()
                raise TimeoutError(f"not done within {seconds:g} s") from None
            except OSError as error:
                self.end()
                raise Ended(f"the process of a job was ended: {error}") from None

    def _started(self) -> "subprocess.Popen[bytes]":
        if self._process is None or self._process.poll() is not None:
            with surroundings():
                order = [sys.executable, "-P", "-m", "notebook_reports.executors.served", *self._preloaded]
                self._process = subprocess.Popen(order, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
            assert self._process.stdout is not None
            _read(self._process.stdout.fileno(), len(READY), time.monotonic() + STARTING)
        return self._process

    def _done(self, process: "subprocess.Popen[bytes]", order: bytes, ends: float) -> Any:
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write(LENGTH.pack(len(order)) + order)
        process.stdin.flush()
        size = LENGTH.unpack(_read(process.stdout.fileno(), LENGTH.size, ends))[0]
        good, found = pickle.loads(_read(process.stdout.fileno(), size, ends))
        if not good:
            raise found
        return found

    def end(self) -> None:
        """End it; what it started ends with it."""
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                with suppress(OSError):
                    pipe.close()  # type: ignore[union-attr]


def _read(file: int, size: int, ends: float) -> bytes:
    found = bytearray()
    while len(found) < size:
        if not select.select([file], [], [], max(0.0, ends - time.monotonic()))[0]:
            raise TimeoutError
        piece = os.read(file, min(size - len(found), 1 << 20))
        if not piece:
            raise OSError("it gave nothing")
        found += piece
    return bytes(found)


def main() -> None:
    """Do jobs until nobody asks any more. What a job prints goes nowhere."""
    orders, replies = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.dup2(nothing, 1)
    for name in sys.argv[1:]:
        import_module(name)
    replies.write(READY)
    replies.flush()
    while head := orders.read(LENGTH.size):
        order = orders.read(LENGTH.unpack(head)[0])
        try:
            function, job = pickle.loads(order)
            told = (True, function(job))
        except Exception as error:
            told = (False, error)
        content = pickle.dumps(told)
        try:
            replies.write(LENGTH.pack(len(content)) + content)
            replies.flush()
        except BrokenPipeError:  # who asked was ended
            os._exit(0)


if __name__ == "__main__":
    main()
