"""The variables that a notebook and its libraries read from ``os.environ``, noted in its kernel."""

import os
import sys

from notebook_reports.run.callers import ABOUT_KERNELS, caller, installed, package

NEUTRAL = {"PATH", "HOME", "TMPDIR", "TEMP", "TMP", "TERM", "PAGER", "GIT_PAGER", "CLICOLOR", "CLICOLOR_FORCE"}
"""Variables that libraries ask for and that change no output, or that outputs are masked for."""
WHOLESALE = {"__iter__", "copy"}
"""Functions that go through all variables: where a library does it, it looks for those with a name of its own."""
read: set[str] = set()
set_here: set[str] = set()


class Noting(os._Environ[str]):
    """`os.environ`, which notes what is read and what is set."""

    def __getitem__(self, key: str) -> str:
        if isinstance(key, str) and key not in set_here and _matters(key, sys._getframe(1).f_code.co_name):
            read.add(key)
        return super().__getitem__(key)

    def __setitem__(self, key: str, value: str) -> None:
        set_here.add(key)
        super().__setitem__(key, value)


def watch() -> None:
    """Let `os.environ` note which variables are read."""
    os.environ.__class__ = Noting


def _matters(name: str, asking: str) -> bool:
    """Does a variable that is read count? What the notebook reads does, and what its libraries ask for by name."""
    by = caller(("os.py",))
    return not installed(by) or not (name in NEUTRAL or asking in WHOLESALE or package(by) in ABOUT_KERNELS)


def take_over(values: dict[str, str]) -> None:
    """Replace all variables by those that a forked kernel is given; none counts as read or set by its notebook."""
    noted = set(read)
    os.environ.clear()
    os.environ.update(values)
    read.clear()
    read.update(noted)
    set_here.clear()
