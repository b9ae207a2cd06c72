"""Where students' notebooks are run, and what comes back: plain numbers, texts, lists; or the reason why not.

What is not shut out is said in docs/teaching.md: without root the notebook runs as the user who grades, and where the
system has no namespaces it can reach the network and read what that user can read.
"""

import json
import math
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from derivations.errors import LoopbookError
from loopbook.course.sandbox.limits import NotebookLimits

ENDING = 5.0
"""Seconds that the processes of a notebook may take to end."""
LONGEST = 4 << 20
"""Bytes of one message."""


class NotebookFailed(LoopbookError):
    """A notebook gave no answers; the message says why, in words for its student."""


@dataclass
class Returned:
    """What came back. answers: plain values by name; functions: the names of those that can be called; refused: why an
    answer could not leave, by name. failed: (cell, error) of each code cell that raised. walls: what stood."""

    answers: dict[str, Any] = field(default_factory=dict)
    functions: list[str] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)
    failed: list[tuple[int, str]] = field(default_factory=list)
    walls: list[str] = field(default_factory=list)


class RunningNotebook:
    """One notebook that runs, or whose functions are called."""

    def __init__(self, pid: int, orders: int, replies: int, limits: NotebookLimits):
        self._pid, self._orders, self._replies, self._limits = pid, orders, replies, limits
        self._rest = b""
        self._ends = time.monotonic() + limits.seconds
        os.set_blocking(replies, False)

    def answers(self, cells: Sequence[str]) -> Returned:
        """Run the cells. Raises NotebookFailed."""
        self._say({"cells": list(cells)})
        told = self._line(self._ends - time.monotonic(), "the whole notebook")
        found = Returned()
        with suppress(TypeError, ValueError):
            found.failed = [(int(n), str(text)[:300]) for n, text in told.get("failed", [])]
        found.walls = [str(w) for w in told.get("walls", [])][:10]
        if not isinstance(told.get("answers"), dict):
            first = f"; cell {found.failed[0][0]} raised {found.failed[0][1]}" if found.failed else ""
            raise NotebookFailed(
                f"there is no `answers = {{...}}` after the last cell ({str(told.get('why'))[:200]}){first}"
            )
        for name, one in told["answers"].items():
            if not isinstance(one, dict):
                continue
            if "function" in one:
                found.functions.append(name)
            elif "refused" in one:
                found.refused[name] = str(one["refused"])[:300]
            elif _is_plain(one.get("value")):
                found.answers[name] = one["value"]
            else:
                found.refused[name] = "no plain number, text or list"
        return found

    def call(self, name: str, *arguments: float) -> float:
        """Call one of its functions with plain numbers. Raises NotebookFailed where no finite number comes in time."""
        left = min(self._limits.call, self._ends - time.monotonic())
        self._say({"call": name, "arguments": [float(a) for a in arguments]})
        told = self._line(left, f"{name}(...)")
        value = told.get("value")
        if (
            "refused" in told
            or isinstance(value, bool)
            or not isinstance(value, int | float)
            or not math.isfinite(value)
        ):
            why = str(told.get("refused", f"it gave {value!r}, no finite number"))[:300]
            shown = ", ".join(f"{a:.6g}" for a in arguments)
            raise NotebookFailed(f"{name}({shown}): {why}")
        return float(value)

    def _say(self, told: dict[str, Any]) -> None:
        try:
            data = memoryview((json.dumps(told) + "\n").encode())
            while data:
                data = data[os.write(self._orders, data) :]
        except OSError:
            raise NotebookFailed(
                "the notebook's process ended: it ended Python itself, or used too much memory"
            ) from None

    def _line(self, seconds: float, what: str) -> dict[str, Any]:
        ends = time.monotonic() + seconds
        while b"\n" not in self._rest:
            left = ends - time.monotonic()
            if left <= 0 or not select.select([self._replies], [], [], left)[0]:
                raise NotebookFailed(f"{what} did not finish within {seconds:.0f} s")
            piece = os.read(self._replies, 1 << 16)
            if not piece:
                raise NotebookFailed("the notebook's process ended: it ended Python itself, or used too much memory")
            self._rest += piece
            if len(self._rest) > LONGEST:
                raise NotebookFailed("the notebook gives more than can be read")
        line, _, self._rest = self._rest.partition(b"\n")
        try:
            told = json.loads(line)
        except (ValueError, RecursionError):
            told = None
        if not isinstance(told, dict):
            raise NotebookFailed("the notebook does not answer in the form that is agreed")
        return told

    def close(self) -> None:
        """End it and all that it started."""
        for file in (self._orders, self._replies):
            with suppress(OSError):
                os.close(file)
        with suppress(OSError):
            guard = os.pidfd_open(self._pid)
            try:
                signal.pidfd_send_signal(guard, signal.SIGTERM)
                select.select([guard], [], [], ENDING)
            finally:
                os.close(guard)


def _is_plain(value: Any, depth: int = 0) -> bool:
    """Numbers, texts and lists of them; JSON knows NaN by name, and it is refused."""
    if isinstance(value, list):
        return depth < 4 and all(_is_plain(v, depth + 1) for v in value)
    if isinstance(value, float):
        return math.isfinite(value)
    return value is None or isinstance(value, int | str | bool)


class Jail:
    """Starts notebooks. hide: folders that none of them may see: keys, other submissions. number: of this jail among
    those that run at a time; each notebook runs as a user of its own."""

    def __init__(self, hide: Sequence[Path] = (), limits: NotebookLimits | None = None, number: int = 0):
        if sys.platform != "linux":
            raise NotebookFailed("notebooks are run on Linux only: type the answers into a CSV, or grade on Linux")
        self.limits = limits or NotebookLimits()
        self._hide = [str(h) for p in hide if (h := p.resolve()).is_dir()]
        source = Path(__file__).parents[3]
        self._needed = list(dict.fromkeys([sys.prefix, sys.base_prefix, str(source), os.path.dirname(os.__file__)]))
        self._started, self._number = 0, number
        self._folder = Path(tempfile.mkdtemp(prefix="lb-course-"))
        self._folder.chmod(0o711)
        ours, theirs = socket.socketpair()
        env = {**_environment(), "HOME": str(self._folder)}
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "loopbook.course.sandbox.zygote"],
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=env,
                cwd="/",
                start_new_session=True,
            )
        self._socket = ours
        if self._socket.recv(16) != b"ready":
            raise NotebookFailed("no notebook can be run on this machine: its process does not start")

    def start(self) -> RunningNotebook:
        """A process for one notebook."""
        self._started += 1
        user = self._number * 400 + self._started % 400
        folder = self._folder / f"n{self._started}"
        orders_in, orders_out = os.pipe()
        replies_in, replies_out = os.pipe()
        order = {
            "user": user,
            "folder": str(folder),
            "hide": self._hide,
            "needed": self._needed,
            "limits": self.limits.data(),
        }
        socket.send_fds(self._socket, [json.dumps(order).encode()], [orders_in, replies_out])
        os.close(orders_in)
        os.close(replies_out)
        pid = json.loads(self._socket.recv(1 << 12))["pid"]
        return RunningNotebook(pid, orders_out, replies_in, self.limits)

    def close(self) -> None:
        """End the zygote; remove what notebooks left."""
        self._process.kill()
        self._process.wait()
        self._socket.close()
        shutil.rmtree(self._folder, ignore_errors=True)


def _environment() -> dict[str, str]:
    """Nothing of the one who grades but where Python is."""
    kept = {k: v for k, v in os.environ.items() if k in ("PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "SYSTEMROOT")}
    fixed = {"MPLBACKEND": "agg", "PYTHONNOUSERSITE": "1", "PYTHONUTF8": "1", "LC_ALL": "C.UTF-8", "TZ": "UTC"}
    threads = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
    return {**kept, **fixed, **threads}
