"""What the kernel loads before the first cell: failing shell commands fail, warnings and tracebacks do not depend on
the machine, and what the notebook reads is noted, see `watching`.

An IPython extension. It imports nothing that a notebook does not have anyway, and adds no name to the notebook.
"""

import os
import subprocess
import warnings
from collections.abc import Callable
from typing import Any

from notebook_reports.run import watching
from notebook_reports.run.callers import installed


def load_ipython_extension(shell: Any) -> None:
    """Called by IPython at kernel start."""
    shell.system = _failing_system(shell, shell.system)
    shell.getoutput = _failing_getoutput(shell)
    _show_the_same_everywhere()
    root = os.environ.get("LOOPBOOK_ROOT", "")
    if root:
        watching.begin(shell, root)


def _failing_system(shell: Any, original: Callable[[str], object]) -> Callable[[str], None]:
    def system(command: str) -> None:
        watching.program(command)
        original(command)
        code = shell.user_ns.get("_exit_code", 0)
        if code:
            raise subprocess.CalledProcessError(code, command)

    return system


def _failing_getoutput(shell: Any) -> Callable[..., Any]:
    from IPython.utils.text import LSString, SList

    def getoutput(command: str, split: bool = True, depth: int = 0) -> Any:
        command = shell.var_expand(command, depth=depth + 1)
        watching.program(command)
        done = subprocess.run(command, shell=True, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            raise subprocess.CalledProcessError(done.returncode, command, done.stdout)
        return SList(done.stdout.splitlines()) if split else LSString(done.stdout)

    return getoutput


def _show_the_same_everywhere() -> None:
    """A warning of a library names the library, not its file and line; a traceback names files whole, so that the
    canonical form knows them: IPython writes ``~`` for a home, whatever that is."""
    from IPython.utils import path

    path.compress_user = lambda path: path
    told = warnings.formatwarning

    def formatwarning(
        message: Warning | str, category: type[Warning], filename: str, lineno: int, line: str | None = None
    ) -> str:
        if not installed(filename):
            return told(message, category, filename, lineno, line)
        parts = filename.replace("\\", "/").rpartition("site-packages/")[2].split("/")
        library = parts[0] if len(parts) > 1 and parts[0] else os.path.splitext(parts[-1])[0]
        return f"{category.__name__}: {message} (from {library})\n"

    warnings.formatwarning = formatwarning
