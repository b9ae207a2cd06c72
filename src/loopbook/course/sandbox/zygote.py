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
import tempfile

from loopbook.course.sandbox import walls
from loopbook.course.sandbox.inside import new_shell, tell_line
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
    """Turn this process into the notebook's, or say why that cannot be."""
    reading, writing = os.fdopen(files[0], "r"), os.fdopen(files[1], "w")
    try:
        stands = _shut_in(order, stands)
        shell = new_shell()
    except BaseException as error:
        tell_line(writing, {"no jail": f"{type(error).__name__}: {error}"})
        return
    tell_line(writing, {"walls": stands})
    run_notebook(reading, writing, shell)


def _shut_in(order: dict, stands: list[str]) -> list[str]:
    """Make the walls round this process. Gives what stands; raises OSError where Python cannot be reached inside."""
    own, needed = order["folder"], python_folders()
    if walls.HIDDEN in stands:
        stands = [w for w in stands if w != walls.HIDDEN]
        stands = [*walls.hide(order["hide"], needed, order["limits"]["file"]), *stands]
        own = f"{walls.SCRATCH[0]}/{os.path.basename(own)}"
    os.makedirs(own, exist_ok=True)
    if walls.become(order["user"], own):
        stands = [walls.OTHER_USER, *stands]
    for folder in needed:
        if not os.access(folder, os.R_OK | os.X_OK):
            raise OSError(f"the user that it would run as may not read {folder}; `chmod -R a+rX {folder}` lets it")
    os.chdir(own)
    os.environ.update({"HOME": own, "TMPDIR": own, "MPLCONFIGDIR": own, "IPYTHONDIR": own})
    tempfile.tempdir = None
    impose(order["limits"], walls.OWN_PROCESSES in stands)
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        numpy.random.seed()
    nothing = os.open(os.devnull, os.O_RDWR)
    for target in (0, 1, 2):
        os.dup2(nothing, target)
    return [w for w in walls.WALLS if w in stands]


def python_folders() -> list[str]:
    """The folders that Python and its packages are read from: by the name they are known by, and where they lie."""
    named = [os.path.abspath(p) for p in (sys.prefix, sys.base_prefix, sys.exec_prefix, *sys.path) if p]
    return [p for p in dict.fromkeys([*named, *map(os.path.realpath, named)]) if os.path.isdir(p) and p != "/"]


def main() -> None:
    requests = socket.socket(fileno=os.dup(0))
    preload()
    gc.collect()
    gc.freeze()
    requests.sendall(b"ready")
    serve(requests)


if __name__ == "__main__":
    main()
