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
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from derivations.errors import LoopbookError
from loopbook.course.sandbox.limits import NotebookLimits
from loopbook.course.sandbox.walls import SCRATCH, enterable
from notebook_reports.project.project import EnvironmentProblem

ENDING = 5.0
"""Seconds that the processes of a notebook may take to end."""
STARTING = 60.0
"""Seconds that its walls may take."""
LONGEST = 4 << 20
"""Bytes of one message."""
NO_NOTEBOOK = "no student's notebook can be run on this machine"
_TRIAL = (
    "import sympy, numpy as np, scipy.signal\nfrom scipy.optimize import brentq",
    "open('written.txt', 'w').write(str(sympy.Rational(1, 2)))",
    "answers = {'five': float(np.linalg.norm([3, 4])), 'half': float(brentq(lambda x: 2 * x - 1, 0, 2))}",
    "answers['twice'] = lambda x: 2 * x",
)
_EXPECTED = {"five": 5.0, "half": 0.5}


class JailFailed(EnvironmentProblem):
    """This machine cannot run any notebook, or no longer; the message says why. It is no student's fault."""


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
        os.set_blocking(replies, False)
        self.walls = self._shut_in()
        self._ends = time.monotonic() + limits.seconds

    def _shut_in(self) -> list[str]:
        """Wait until its walls stand; which. Raises JailFailed."""
        try:
            told = self._line(STARTING, "its walls")
        except NotebookFailed as failed:
            self.close()
            raise JailFailed(f"{NO_NOTEBOOK}: {failed}") from None
        if "no jail" in told:
            self.close()
            raise JailFailed(f"{NO_NOTEBOOK}: {told['no jail']}")
        return [str(w) for w in told.get("walls", [])]

    def answers(self, cells: Sequence[str]) -> Returned:
        """Run the cells. Raises NotebookFailed."""
        self._say({"cells": list(cells)})
        told = self._line(self._ends - time.monotonic(), "the whole notebook")
        found = Returned(walls=self.walls)
        with suppress(TypeError, ValueError):
            found.failed = [(int(n), str(text)[:300]) for n, text in told.get("failed", [])]
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
    those that run at a time; each notebook runs as a user of its own.

    It first runs a notebook of ours, with functions and packages, so that what fails later is the student's. Raises
    JailFailed where that one does not come out right.
    """

    def __init__(self, hide: Sequence[Path] = (), limits: NotebookLimits | None = None, number: int = 0):
        if sys.platform != "linux":
            raise JailFailed("notebooks are run on Linux only: type the answers into a CSV, or grade on Linux")
        self.limits = limits or NotebookLimits()
        self._hide = [str(h) for p in (*hide, *_home()) if (h := p.resolve()).is_dir() and h != h.parent]
        self._started, self._number = 0, number
        place = next(filter(enterable, dict.fromkeys((tempfile.gettempdir(), *SCRATCH))), None)
        self._folder = Path(tempfile.mkdtemp(prefix="lb-course-", dir=place))
        self._folder.chmod(0o711)
        ours, theirs = socket.socketpair()
        env = {**_environment(), "HOME": str(self._folder), "TMPDIR": str(self._folder)}
        with theirs, (self._folder / "said").open("wb") as said:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "loopbook.course.sandbox.zygote"],
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=said,
                env=env,
                cwd="/",
                start_new_session=True,
            )
        self._socket = ours
        try:
            if self._socket.recv(16) != b"ready":
                lines = (self._folder / "said").read_text(errors="replace").strip().splitlines()
                raise JailFailed(f"{NO_NOTEBOOK}: {lines[-1] if lines else 'its process does not start'}")
            self.walls = self._tried()
        except BaseException:
            self.close()
            raise

    def _tried(self) -> list[str]:
        """Run the notebook of ours; the walls that stand."""
        running = self._begin(replace(self.limits, seconds=STARTING, call=STARTING))
        try:
            found = running.answers(_TRIAL)
            if found.answers != _EXPECTED or running.call("twice", 2) != 4 or found.failed:
                told = "; ".join(text for _, text in found.failed) or f"{found.answers} for {_EXPECTED}"
                raise JailFailed(f"{NO_NOTEBOOK}: a trial gave {told}")
        except NotebookFailed as failed:
            raise JailFailed(f"{NO_NOTEBOOK}: in a trial {failed}") from None
        finally:
            running.close()
        return running.walls

    def start(self) -> RunningNotebook:
        """A process for one notebook, behind the walls of the trial. Raises JailFailed."""
        running = self._begin(self.limits)
        if running.walls != self.walls:
            running.close()
            missing = ", ".join(w for w in self.walls if w not in running.walls)
            raise JailFailed(f"a notebook was not run: {missing or 'a wall'} stood before and does not now")
        return running

    def _begin(self, limits: NotebookLimits) -> RunningNotebook:
        self._started += 1
        user = self._number * 400 + self._started % 400
        folder = self._folder / f"n{self._started}"
        orders_in, orders_out = os.pipe()
        replies_in, replies_out = os.pipe()
        order = {"user": user, "folder": str(folder), "hide": self._hide, "limits": limits.data()}
        try:
            socket.send_fds(self._socket, [json.dumps(order).encode()], [orders_in, replies_out])
            pid = json.loads(self._socket.recv(1 << 12))["pid"]
        except (OSError, ValueError):
            os.close(orders_out)
            os.close(replies_in)
            raise JailFailed("the process that starts students' notebooks was ended; grade again") from None
        finally:
            os.close(orders_in)
            os.close(replies_out)
        return RunningNotebook(pid, orders_out, replies_in, limits)

    def close(self) -> None:
        """End the zygote; remove what notebooks left."""
        self._process.kill()
        self._process.wait()
        self._socket.close()
        shutil.rmtree(self._folder, ignore_errors=True)


def _home() -> list[Path]:
    """The home of the one who grades: by the list of users, as HOME may name any folder."""
    import pwd

    try:
        return [Path(pwd.getpwuid(os.getuid()).pw_dir)]
    except KeyError:
        return []


def _environment() -> dict[str, str]:
    """Nothing of the one who grades but where Python is."""
    kept = {k: v for k, v in os.environ.items() if k in ("PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "SYSTEMROOT")}
    fixed = {"MPLBACKEND": "agg", "PYTHONNOUSERSITE": "1", "PYTHONUTF8": "1", "LC_ALL": "C.UTF-8", "TZ": "UTC"}
    threads = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
    return {**kept, **fixed, **threads}
