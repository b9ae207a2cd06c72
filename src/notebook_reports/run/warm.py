"""Kernels forked from one process that has the imports done: 2 s less for each notebook, the same results.

Only on POSIX and only for several notebooks; wherever it does not work, a kernel is started as always. A library that
warns when it is imported would warn in no notebook: then nothing is forked. Where many runs of one notebook would
each compute the same, a function named `ready` ("module:function") computes it here once; it has to be pure, so that
a kernel that finds it done gives the same bytes.
"""

import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading

PLAIN = "LOOPBOOK_FRESH_KERNELS"


def possible() -> bool:
    """Does this system fork, and does nobody forbid it? (macOS forks, but its libraries do not survive it.)"""
    return sys.platform.startswith("linux") and hasattr(os, "pidfd_open") and not os.environ.get(PLAIN)


class Forked:
    """A kernel that is not our child: what jupyter_client needs of `subprocess.Popen`, through a pidfd."""

    stdin = stdout = stderr = None

    def __init__(self, pid: int):
        self.pid = pid
        self.returncode: int | None = None
        try:
            self._fd = os.pidfd_open(pid)
        except ProcessLookupError:
            self._fd = -1
            self.returncode = 1

    def poll(self) -> int | None:
        return self._look(0)

    def wait(self, timeout: float | None = None) -> int:
        if self._look(timeout) is None:
            raise subprocess.TimeoutExpired("kernel", timeout or 0)
        return self.returncode or 0

    def _look(self, timeout: float | None) -> int | None:
        if self.returncode is None and select.select([self._fd], [], [], timeout)[0]:
            self.returncode = 1
        return self.returncode

    def __del__(self) -> None:
        if self._fd >= 0:
            os.close(self._fd)

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            signal.pidfd_send_signal(self._fd, number)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)


class Warm:
    """The process that forks. Starting it returns at once; the first `fork` waits until its imports are done."""

    def __init__(self, env: dict[str, str], ready: str = ""):
        self._lock = threading.Lock()
        self._ready: bool | None = None
        ours, theirs = socket.socketpair()
        command = [sys.executable, "-P", "-m", "notebook_reports.run.warm_side", *[ready] * bool(ready)]
        with theirs:
            self._process = subprocess.Popen(
                command,
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=env,
                start_new_session=True,
            )
        self._socket = ours

    def fork(self, argv: list[str], env: dict[str, str], cwd: str, errors: int) -> Forked | None:
        """A kernel with this command line, or None where forking does not work: then start one as always."""
        with self._lock:
            try:
                if self._ready is None:
                    self._ready = json.loads(self._socket.recv(1 << 20) or b"{}").get("warnings") == []
                if not self._ready:
                    return None
                order = {"argv": argv, "env": env, "cwd": cwd}
                socket.send_fds(self._socket, [json.dumps(order).encode()], [errors])
                return Forked(json.loads(self._socket.recv(1 << 16))["pid"])
            except (OSError, ValueError, KeyError):
                self._ready = False
                return None

    def alive(self) -> bool:
        """Does it still run?"""
        return self._process.poll() is None

    def kill(self) -> None:
        """End it now; one who waits for a kernel of it waits no more."""
        self._process.kill()

    def close(self) -> None:
        """End it; kernels that still run end with it."""
        self._process.kill()
        self._process.wait()
        self._socket.close()
