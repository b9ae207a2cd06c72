"""The process that kernels are forked from: it has imported what they would each import, and nothing else.

Started by `notebook_reports.run.warm` with a socket as file 0; one request is one kernel, answered with its process id.
It ends when the socket closes. It holds no kernel, no IPython, no thread and no random state of a notebook: a forked
kernel is a fresh kernel that found its imports done.
"""

import gc
import importlib.util
import json
import os
import signal
import socket
import sys
import warnings

from notebook_reports.run import variables

PRELOADED = (
    "ipykernel.kernelapp",
    "ipykernel.ipkernel",
    "IPython.core.completer",
    "numpy",
    "scipy.signal",
    "scipy.linalg",
    "scipy.optimize",
    "scipy.interpolate",
    "scipy.integrate",
    "sympy",
    "sympy.codegen.ast",
    "sympy.physics.units.util",
    "sympy.tensor.tensor",
    "matplotlib.pyplot",
    "matplotlib.backends.backend_svg",
)


def preload(ready: str = "") -> list[str]:
    """Import everything that is installed of `PRELOADED`, then call `ready` ("module:function") if it is given.

    Returns what speaks against forking: the warnings that a notebook would have shown, or why `ready` failed.
    """
    variables.watch()
    os.environ["JPY_PARENT_PID"] = str(os.getpid())  # read when ipykernel is imported: kernels end with this process
    with warnings.catch_warnings(record=True) as said:
        for name in PRELOADED:
            if importlib.util.find_spec(name.partition(".")[0]) is not None:
                importlib.import_module(name)
        if ready:
            module, _, function = ready.partition(":")
            try:
                getattr(importlib.import_module(module), function)()
            except Exception as error:
                return [f"{ready}: {error}"]
    return [str(w.message) for w in said]


def serve(requests: socket.socket) -> None:
    """Fork a kernel for each request until the socket closes. Returns only in a kernel, which then runs."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for the kernels here
    while True:
        message, files, _, _ = socket.recv_fds(requests, 1 << 20, 1)
        if not message:
            os._exit(0)
        order = json.loads(message)
        pid = os.fork()
        if pid == 0:
            requests.close()
            _become(order, files[0])
            return
        for file in files:
            os.close(file)
        requests.sendall(json.dumps({"pid": pid}).encode())


def _become(order: dict, errors: int) -> None:
    """Turn the fork into what ``python -m ipykernel_launcher`` would be."""
    os.setsid()
    for number in (signal.SIGCHLD, signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    nothing = os.open(os.devnull, os.O_RDWR)
    for target, file in ((0, nothing), (1, nothing), (2, errors)):
        os.dup2(file, target)
    os.chdir(order["cwd"])
    variables.take_over(order["env"])
    launcher = importlib.util.find_spec("ipykernel_launcher")
    sys.argv = [(launcher and launcher.origin) or order["argv"][0], *order["argv"][1:]]
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        numpy.random.seed()  # each kernel its own, as after a fresh import


def main() -> None:
    requests = socket.socket(fileno=os.dup(0))
    said = preload(*sys.argv[1:2])
    requests.sendall(json.dumps({"warnings": said}).encode())
    gc.collect()
    gc.freeze()
    serve(requests)
    from ipykernel.kernelapp import IPKernelApp

    IPKernelApp.launch_instance(argv=sys.argv[1:])


if __name__ == "__main__":
    main()
