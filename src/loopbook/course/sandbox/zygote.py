"""The process that the processes of notebooks are forked from: imports done, and nothing of the course in its memory.

Started by `loopbook.course.sandbox.jail` with a socket as file 0. One message is one notebook: its pipes, who it runs
as, what is hidden from it. It answers with the process to be ended when the notebook is done with.
"""

import gc
import importlib.util
import json
import os
import signal
import socket
import sys

from loopbook.course.sandbox import walls
from loopbook.course.sandbox.inside import serve as run_notebook
from loopbook.course.sandbox.limits import impose

PRELOADED = ("IPython.core.interactiveshell", "numpy", "scipy.signal", "scipy.optimize", "sympy", "matplotlib.pyplot")


def preload() -> None:
    """Import what notebooks use, where it is installed."""
    for name in PRELOADED:
        if importlib.util.find_spec(name.partition(".")[0]) is not None:
            importlib.import_module(name)


def serve(requests: socket.socket) -> None:
    """Fork for each request until the socket closes."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    while True:
        message, files, _, _ = socket.recv_fds(requests, 1 << 20, 2)
        if not message:
            os._exit(0)
        pid = os.fork()
        if pid == 0:
            requests.close()
            try:
                _guard(json.loads(message), files)
            finally:
                os._exit(1)
        for file in files:
            os.close(file)
        requests.sendall(json.dumps({"pid": pid}).encode())


def _guard(order: dict, files: list[int]) -> None:
    """Stand between the zygote and the notebook: make the walls, start the notebook behind them, end with it.

    The notebook is the first process of its own space of processes: when it ends, all that it started ends.
    """
    os.setsid()
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    stands = walls.separate()
    pid = os.fork()
    if pid == 0:
        _become(order, files, stands)
        os._exit(0)
    for file in files:
        os.close(file)

    def end(*_: object) -> None:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
        os._exit(1)

    signal.signal(signal.SIGTERM, end)
    os.waitpid(pid, 0)
    os._exit(0)


def _become(order: dict, files: list[int], stands: list[str]) -> None:
    """Turn this process into the notebook's."""
    own = order["folder"]
    if "hidden folders" in stands:
        walls.hide(order["hide"], order["needed"], own, order["limits"]["file"])
    os.makedirs(own, exist_ok=True)
    if walls.become(order["user"], own):
        stands.insert(0, "another user")
    os.chdir(own)
    os.environ.update({"HOME": own, "TMPDIR": own, "MPLCONFIGDIR": own, "IPYTHONDIR": own})
    impose(order["limits"], "own processes" in stands)
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        numpy.random.seed()
    reading, writing = os.fdopen(files[0], "r"), os.fdopen(files[1], "w")
    nothing = os.open(os.devnull, os.O_RDWR)
    for target in (0, 1, 2):
        os.dup2(nothing, target)
    run_notebook(_WithWalls(reading, stands), writing)


class _WithWalls:
    """The orders, the walls that stand added to the first."""

    def __init__(self, orders: object, stands: list[str]):
        self._orders, self._stands = orders, stands

    def readline(self) -> str:
        return json.dumps({**json.loads(self._orders.readline()), "walls": self._stands})  # type: ignore[attr-defined]

    def __iter__(self):  # type: ignore[no-untyped-def]
        return iter(self._orders)  # type: ignore[call-overload]


def main() -> None:
    requests = socket.socket(fileno=os.dup(0))
    preload()
    gc.collect()
    gc.freeze()
    requests.sendall(b"ready")
    serve(requests)


if __name__ == "__main__":
    main()
