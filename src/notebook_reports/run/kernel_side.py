"""What the kernel loads before the first cell: failing shell commands fail, and what the notebook reads is noted.

An IPython extension. It imports nothing that a notebook does not have anyway, and adds no name to the notebook.
"""

import os
import subprocess
import sys

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
WRITTEN: set[str] = set()
READ: dict[str, str] = {}
"""Files opened for reading and folders listed below the project's root, by path: "file" or "folder"."""


def load_ipython_extension(shell) -> None:
    """Called by IPython at kernel start."""
    shell.system = _failing_system(shell, shell.system)
    shell.getoutput = _failing_getoutput(shell)
    root = os.environ.get("LOOPBOOK_ROOT", "")
    if root:
        sys.addaudithook(_noting(root))


def _failing_system(shell, original):
    def system(command):
        original(command)
        code = shell.user_ns.get("_exit_code", 0)
        if code:
            raise subprocess.CalledProcessError(code, command)

    return system


def _failing_getoutput(shell):
    from IPython.utils.text import LSString, SList

    def getoutput(command, split=True, depth=0):
        command = shell.var_expand(command, depth=depth + 1)
        done = subprocess.run(command, shell=True, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            raise subprocess.CalledProcessError(done.returncode, command, done.stdout)
        return SList(done.stdout.splitlines()) if split else LSString(done.stdout)

    return getoutput


def _noting(root):
    skipped = tuple(os.path.join(root, name) + os.sep for name in (".cache", ".venv", ".git"))
    skipped = (*skipped, sys.prefix + os.sep)
    listing = ("os.listdir", "os.scandir")

    def hook(event, args):
        if event != "open" and event not in listing:
            return
        try:
            path = os.fspath(args[0])
        except TypeError:
            return
        if not isinstance(path, str):
            return
        path = os.path.abspath(path)
        if not path.startswith(root + os.sep) or path.startswith(skipped):
            return
        if sys._getframe(1).f_code.co_filename.startswith("<frozen importlib"):
            return  # what is imported is known from sys.modules
        if event in listing:
            READ[path] = "folder"
        elif set(args[1] or "") & set("wax+") or (args[2] or 0) & WRITING:
            WRITTEN.add(path)
        else:
            READ.setdefault(path, "file")

    return hook


def report() -> dict[str, object]:
    """What this kernel depended on: modules by file, and what `READ` holds without the files that it wrote itself."""
    files = {getattr(m, "__file__", None) for m in list(sys.modules.values())}
    installed = (sys.prefix + os.sep, sys.base_prefix + os.sep, os.path.dirname(os.__file__) + os.sep)
    modules = sorted(f for f in files if isinstance(f, str) and f.endswith(".py") and not f.startswith(installed))
    return {"modules": modules, "read": {k: v for k, v in READ.items() if k not in WRITTEN}}
